// Writes LCM event logs that lcm-logplayer, lcm-spy and io::LogReader read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace pmg::io {

/// Events carry the stamp that they are given (simulation time in SIL), never the time of writing: the same run gives
/// the same bytes. The file holds whole events only, also after a refused write: what flush() could not bring to the
/// disk is taken back. Not LCM's own writer, which leaves half an event on a full disk and doesn't tell what is lost.
/// Not for a real-time thread.
class LogWriter {
 public:
  explicit LogWriter(const std::filesystem::path& path);  ///< throws std::runtime_error if the file can't be made
  ~LogWriter();                                           ///< flushes; what fails then is lost silently
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;

  /// Appends one message; to the disk when a megabyte has gathered. Throws std::runtime_error when the disk refuses it.
  template <typename Message>
  void write(std::string_view channel, std::int64_t stamp_ns, const Message& message) {
    const int size = message.getEncodedSize();
    std::uint8_t* data = append(channel, stamp_ns, size);
    if (message.encode(data, 0, size) != size)
      throw std::runtime_error(std::string(channel) + ": message can't be encoded");
    flush_when_large();
  }

  /// Everything written so far survives the end of this process. Throws std::runtime_error; everything since the last
  /// flush is lost then, and the writer is good for another try.
  void flush();
  void sync();  ///< flush(), and it survives a power cut too

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
