// Recordings of a bus in candump's log format (can-utils, `candump -L`).
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "drives/message.hpp"

namespace pmg::can {

struct RecordedFrame {
  enum class Kind : std::uint8_t {
    kData,
    kRemote,  ///< a request for a frame of `length` bytes
    kError,   ///< what the CAN controller reports: id has the classes of <linux/can/error.h>, data its eight bytes
  };
  std::int64_t stamp_ns = 0;  ///< since 1970
  std::string interface {};
  drives::Message frame{};
  Kind kind = Kind::kData;
};

/// "(1436509052.249713) can0 044#2A366C2B" without a newline; CAN FD: "can0 044##12A36", the digit after ## being the
/// flags; a remote frame: "can0 044#R4"; an error: "can0 20000004#0004000000000000".
std::string to_line(const RecordedFrame& recorded);
/// Takes lines of candump and of python-can, which ends them with " R" or " T". Nullopt: not such a line.
std::optional<RecordedFrame> from_line(std::string_view line);

/// Puts frames of several buses in the order of their stamps; equal ones stay in the order in which they were put.
class FrameOrder {
 public:
  void put(RecordedFrame frame);
  /// The earliest frame, if its stamp is below before_ns.
  bool take(std::int64_t before_ns, RecordedFrame& frame);

 private:
  std::multimap<std::int64_t, RecordedFrame> waiting_;
};

}  // namespace pmg::can
