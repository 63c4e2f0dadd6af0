// The MIT protocol as the Mini Cheetah's own firmware speaks it (bgkatz/motorcontrol): replies of six bytes, without
// temperature and fault.
#pragma once

#include "drive_protocols/mit_drive.hpp"

namespace pmg::drives {

/// Reply: node, position 16 bits, velocity 12, torque 12; drives built after it add a seventh byte, which isn't read.
class MiniCheetahDrive final : public MitDrive {
 public:
  explicit MiniCheetahDrive(const MitRanges& ranges) noexcept : MitDrive(ranges, "mini_cheetah") {}

  std::optional<MitReply> read(std::span<const std::uint8_t> bytes) const noexcept override;
  Message reply(const MitReply& reply) const noexcept override;
  bool tells_temperature() const noexcept override { return false; }

 protected:
  DriveKind with(const MitRanges& ranges) const override { return std::make_shared<MiniCheetahDrive>(ranges); }
};

}  // namespace pmg::drives
