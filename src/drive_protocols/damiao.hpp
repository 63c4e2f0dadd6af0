// The MIT protocol as DaMiao's drives speak it: a state besides the node in each reply, two temperatures, and a message
// that clears faults. As the Python packages damiao-motor 1.0.6 and pydamiao 0.1.4 have it, and the open firmware
// umeow0716/damiao_firmware.
#pragma once

#include "drive_protocols/mit_drive.hpp"

namespace pmg::drives {

inline constexpr MitFrame kDamiaoClear = {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFB};

/// Reply: state and node (4 bits each), position 16, velocity 12, torque 12, temperature of the bridge and of the motor
/// [degC]. The reading has the higher one.
class DamiaoDrive final : public MitDrive {
 public:
  explicit DamiaoDrive(const MitRanges& ranges) noexcept : MitDrive(ranges, "damiao", {.lowest = kDamiaoClear[7]}) {}

  std::optional<MitReply> read(std::span<const std::uint8_t> bytes) const noexcept override;
  Message reply(const MitReply& reply) const noexcept override;
  const MitFrame* clearing() const noexcept override { return &kDamiaoClear; }
  bool says_enabled() const noexcept override { return true; }
  /// A larger number would spoil the state: the firmware puts both into one byte.
  int most_node() const noexcept override { return 15; }

 protected:
  DriveKind with(const MitRanges& ranges) const override { return std::make_shared<DamiaoDrive>(ranges); }
};

}  // namespace pmg::drives
