// Writes LCM event logs that lcm-logplayer, lcm-spy and io::LogReader read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <lcm/lcm-cpp.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace pmg::io {

/// Events carry the stamp that they are given (simulation time in SIL), never the time of writing: the same run gives
/// the same bytes. Not for a real-time thread.
class LogWriter {
 public:
  explicit LogWriter(const std::filesystem::path& path);  ///< throws std::runtime_error if the file can't be made

  /// Appends one message. Throws std::runtime_error when the disk refuses it.
  template <typename Message>
  void write(const std::string& channel, std::int64_t stamp_ns, const Message& message) {
    const int size = message.getEncodedSize();
    if (static_cast<int>(buffer_.size()) < size) buffer_.resize(static_cast<std::size_t>(size));
    if (message.encode(buffer_.data(), 0, size) != size)
      throw std::runtime_error(channel + ": message can't be encoded");
    append(channel, stamp_ns, size);
  }

  void flush();  ///< throws std::runtime_error

 private:
  void append(const std::string& channel, std::int64_t stamp_ns, int size);

  std::string path_;
  std::vector<char> file_buffer_;  // used by the file until it is closed: declared first
  lcm::LogFile file_;
  lcm::LogEvent event_;
  std::vector<std::uint8_t> buffer_;
};

}  // namespace pmg::io
