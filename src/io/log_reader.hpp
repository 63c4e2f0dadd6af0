// Reads LCM event logs, one event after the other.
#pragma once

#include <cstdint>
#include <filesystem>
#include <lcm/lcm-cpp.hpp>
#include <optional>
#include <string>

namespace pmg::io {

class LogReader {
 public:
  explicit LogReader(const std::filesystem::path& path);  ///< throws std::runtime_error if the file can't be opened

  bool next();  ///< to the next event; false at the end
  const std::string& channel() const { return event_->channel; }
  std::int64_t stamp_ns() const { return event_->timestamp * 1000; }  ///< LCM logs keep microseconds

  /// The current event's message; nothing when it is of another type or cut short.
  template <typename Message>
  std::optional<Message> decode() const {
    Message message;
    if (message.decode(event_->data, 0, event_->datalen) < 0) return std::nullopt;
    return message;
  }

 private:
  lcm::LogFile file_;
  const lcm::LogEvent* event_ = nullptr;
};

}  // namespace pmg::io
