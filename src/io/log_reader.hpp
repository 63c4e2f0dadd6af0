// Reads LCM event logs event by event, damaged ones too.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/message_prefix.hpp"

namespace pmg::io {

/// Skips and counts damaged stretches. An incomplete last event (power lost, file still being written) ends the log.
/// LCM's own reader isn't used: it prints to stdout and trusts every length.
class LogReader {
 public:
  explicit LogReader(const std::filesystem::path& path);  ///< throws std::runtime_error if the file can't be opened

  bool next();  ///< to the next event; false at the end
  const std::string& channel() const { return channel_; }
  std::int64_t stamp_ns() const { return stamp_us_ * 1000; }  ///< LCM logs keep microseconds
  const std::vector<std::uint8_t>& data() const { return data_; }

  /// The current event's message; nothing if it is of another type or cut short.
  template <typename Message>
  std::optional<Message> decode() const {
    Message message{};
    if (!decode_into(message)) return std::nullopt;
    return message;
  }
  /// The same, into a message whose memory is reused.
  template <typename Message>
  bool decode_into(Message& message) const {
    return decode_prefix(data_, message);
  }

  /// Bytes so far that belong to no event, including an incomplete last event.
  std::int64_t skipped_bytes() const { return skipped_bytes_; }
  bool cut_short() const { return cut_short_; }  ///< at the end: the last event is incomplete

 private:
  enum class Outcome { kEvent, kNoEvent, kEnd };
  Outcome parse();
  bool available(std::size_t bytes);

  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  std::vector<std::uint8_t> window_;  // a part of the file; bytes before at_ are done
  std::size_t at_ = 0;
  std::string channel_;
  std::int64_t stamp_us_ = 0;
  std::vector<std::uint8_t> data_;
  std::int64_t skipped_bytes_ = 0;
  bool cut_short_ = false;
};

}  // namespace pmg::io
