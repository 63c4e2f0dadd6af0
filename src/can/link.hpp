// The way to one CAN bus.
#pragma once

#include <cstdint>
#include <span>

#include "drives/message.hpp"

namespace pmg::can {

/// What the CAN controller of this computer says of its bus.
enum class BusHealth : std::uint8_t {
  kGood,
  kPassive,  ///< error-passive: every frame meets errors, or nobody acknowledges it
  kOff,      ///< bus-off, or the interface is down: nothing is sent
};

/// Counts since the link was opened.
struct LinkCounts {
  std::uint64_t sent = 0, received = 0;
  std::uint64_t not_sent = 0;      ///< frames that the queue had no room for, or that a dead interface refused
  std::uint64_t error_frames = 0;  ///< reports of the CAN controller, ACK errors among them
  std::uint64_t ack_errors = 0;
  std::uint64_t bus_offs = 0;
  int sending_errors = 0, receiving_errors = 0;  ///< the CAN controller's own counters, as it told them last
};

/// None of these allocates, locks, throws or waits.
class Link {
 public:
  virtual ~Link() = default;
  /// Frames in the order in which they go out => how many of them there was room for; the others are counted and
  /// dropped.
  virtual std::size_t send(std::span<const drives::Message> frames) noexcept = 0;
  /// What has arrived, at most as many as there is room for; 0: nothing more.
  virtual std::size_t receive(std::span<drives::Message> frames) noexcept = 0;
  virtual BusHealth health() const noexcept = 0;
  virtual const LinkCounts& counts() const noexcept = 0;
  virtual int descriptor() const noexcept { return -1; }  ///< for poll(); -1: none
};

}  // namespace pmg::can
