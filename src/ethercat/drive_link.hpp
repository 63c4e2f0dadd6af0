// CiA 402 drives that are slaves themselves, as nodes of a bus: their process data are a CANopen drive's PDOs.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "can/link.hpp"
#include "drive_protocols/canopen.hpp"

namespace pmg::ethercat {

/// Outputs of a drive: RPDO1. Its inputs: TPDO1, then TPDO2, without gaps.
inline constexpr std::size_t kDriveOutputs = 8, kFirstInputs = 8;
constexpr std::size_t drive_inputs(bool temperature) { return kFirstInputs + (temperature ? 8 : 6); }

/// SYNC asks for the inputs of this cycle; a node's targets wait for the cycle's outputs. What CANopen needs besides,
/// node commands and heartbeats, EtherCAT has in its slaves' states and watchdogs: dropped. No heap after construction.
class DriveLink final : public can::Link {
 public:
  /// In the order of the slaves.
  explicit DriveLink(const std::vector<int>& nodes);

  std::size_t send(std::span<const drives::Message> frames) noexcept override;
  std::size_t receive(std::span<drives::Message> frames) noexcept override;
  can::BusHealth health() const noexcept override { return can::BusHealth::kGood; }
  const can::LinkCounts& counts() const noexcept override { return counts_; }

  /// A drive's inputs of this cycle; they are no answer without a SYNC before them, or of another
  /// length than drive_inputs'.
  void take(std::size_t drive, std::span<const std::uint8_t> inputs) noexcept;
  void fill(std::size_t drive, std::span<std::uint8_t> outputs) const noexcept;

 private:
  struct Drive {
    std::uint32_t node = 0;
    bool asked = false;
    std::array<std::uint8_t, kDriveOutputs> targets{};
  };
  std::vector<Drive> drives_;
  std::vector<drives::Message> in_;  // room for two of each drive
  std::size_t in_first_ = 0, in_count_ = 0;
  can::LinkCounts counts_;
};

}  // namespace pmg::ethercat
