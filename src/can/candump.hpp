// Recordings of a bus in candump's log format (can-utils, `candump -L`).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "can/frame.hpp"

namespace pmg::can {

struct RecordedFrame {
  std::int64_t stamp_ns = 0;  ///< since 1970
  std::string interface;
  Frame frame;
};

/// "(1436509052.249713) can0 044#2A366C2B" without a newline; CAN FD: "can0 044##12A36", the digit after ## being the
/// flags.
std::string to_line(const RecordedFrame& recorded);
/// Nullopt: not such a line. Remote and error frames are none.
std::optional<RecordedFrame> from_line(std::string_view line);

}  // namespace pmg::can
