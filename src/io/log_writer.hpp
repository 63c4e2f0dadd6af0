// Writes LCM event logs that lcm-logplayer, lcm-spy and io::LogReader read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace pmg::io {

/// An event has the caller's stamp (simulation time in SIL), not the time of writing, so the same run gives the same
/// bytes. The file holds whole events only: after a failed write, flush() removes the part of an event from the file.
/// LCM's own writer isn't used: on a full disk it leaves half an event without an error. Not for a real-time thread.
class LogWriter {
 public:
  explicit LogWriter(const std::filesystem::path& path);  ///< throws std::runtime_error if the file can't be made
  ~LogWriter();                                           ///< flushes; an error here is lost
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;

  /// Appends one message. Writes to the disk after each megabyte. Throws std::runtime_error if the disk refuses it.
  template <typename Message>
  void write(std::string_view channel, std::int64_t stamp_ns, const Message& message) {
    const int size = message.getEncodedSize();
    std::uint8_t* data = append(channel, stamp_ns, size);
    if (message.encode(data, 0, size) != size)
      throw std::runtime_error(std::string(channel) + ": message can't be encoded");
    flush_when_large();
  }

  /// All events so far survive the end of this process. Throws std::runtime_error; then all events since the last flush
  /// are lost, and the writer can go on.
  void flush();
  void sync();  ///< flush(); the events survive a power cut too

  /// The path still names the file that is written: nobody deleted, moved or replaced it.
  bool in_place() const noexcept;

  std::int64_t bytes() const { return flushed_bytes_ + static_cast<std::int64_t>(buffer_.size()); }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::uint8_t* append(std::string_view channel, std::int64_t stamp_ns, int size);
  void flush_when_large();

  std::filesystem::path path_;
  int file_ = -1;
  std::vector<std::uint8_t> buffer_;  // whole events
  std::int64_t flushed_bytes_ = 0;
  std::int64_t events_ = 0;
};

}  // namespace pmg::io
