// EtherCAT frames of the bus cycle: datagrams behind an Ethernet header (ETG.1000.4).
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "ethercat/wire.hpp"

namespace pmg::ethercat {

enum class Command : std::uint8_t {
  kBroadcastRead = 7,
  kBroadcastWrite = 8,
  kLogicalRead = 10,
  kLogicalWrite = 11,
  kReadOneWriteOthers = 14,  ///< by station address
};

inline constexpr std::uint16_t kAlControl = 0x120, kAlStatus = 0x130, kSystemTime = 0x910,
                               kTimeDifference = 0x92C;  ///< registers of a slave
inline constexpr std::uint8_t kOperational = 0x08, kAcknowledge = 0x10;

/// One frame, made datagram by datagram. No heap.
class FrameWriter {
 public:
  static constexpr std::size_t kHeader = 16;    ///< Ethernet's 14 bytes and EtherCAT's length
  static constexpr std::size_t kOverhead = 12;  ///< of a datagram: header and working counter

  explicit FrameWriter(std::uint8_t index) noexcept;
  /// False: no room.
  bool add(Command command, std::uint32_t address, std::span<const std::uint8_t> data) noexcept;
  std::span<const std::uint8_t> bytes() const noexcept { return std::span(frame_).first(size_); }

 private:
  std::array<std::uint8_t, kMostFrame> frame_{};
  std::size_t size_ = kHeader, last_ = 0;
  std::uint8_t index_;
};

struct Datagram {
  std::span<const std::uint8_t> data;
  int working_counter = 0;
};

/// Reads a frame that came back.
class FrameReader {
 public:
  /// sent: the frame as it went out. Bytes that aren't its answer (other length, commands or index) give no datagram.
  FrameReader(std::span<const std::uint8_t> frame, std::span<const std::uint8_t> sent) noexcept;
  bool valid() const noexcept { return valid_; }
  /// False: no more.
  bool next(Datagram& datagram) noexcept;

 private:
  std::span<const std::uint8_t> frame_;
  std::size_t at_ = FrameWriter::kHeader;
  bool valid_ = false;
};

}  // namespace pmg::ethercat
