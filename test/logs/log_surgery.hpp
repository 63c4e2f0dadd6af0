// Copies logs event by event, with events left out, changed or added.
#pragma once

#include <cstring>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "io/log_reader.hpp"
#include "io/log_writer.hpp"

namespace pmg::test {

/// A walk with a fault and a reset, by the controller of its day.
inline constexpr const char* kCommittedLog = "test/data/logs/walk_fault_reset.lcm";

struct LogEvent {
  std::string channel;
  std::int64_t stamp_ns = 0;
  std::vector<std::uint8_t> data;

  // The interface that io::LogWriter needs of a message.
  int getEncodedSize() const { return static_cast<int>(data.size()); }
  int encode(void* to, int offset, int size) const {
    std::memcpy(static_cast<char*>(to) + offset, data.data(), data.size());
    return size;
  }

  template <typename Message>
  Message as() const {
    Message message;
    message.decode(data.data(), 0, static_cast<int>(data.size()));
    return message;
  }
  template <typename Message>
  void set(const Message& message) {
    data.resize(static_cast<std::size_t>(message.getEncodedSize()));
    message.encode(data.data(), 0, static_cast<int>(data.size()));
  }
};

inline std::vector<LogEvent> read_events(const std::filesystem::path& file) {
  io::LogReader reader(file);
  std::vector<LogEvent> events;
  while (reader.next()) events.push_back({reader.channel(), reader.stamp_ns(), reader.data()});
  return events;
}

/// keep may change the event; if it returns false, the event is left out.
inline void copy_log(const std::filesystem::path& from, const std::filesystem::path& to,
                     const std::function<bool(LogEvent&)>& keep) {
  io::LogWriter writer(to);
  for (LogEvent& event : read_events(from)) {
    if (keep(event)) writer.write(event.channel, event.stamp_ns, event);
  }
}

}  // namespace pmg::test
