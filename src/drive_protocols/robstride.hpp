// The MIT protocol as RobStride's drives speak it once they are switched to it (RobStride/SampleProgram, and the manual
// of RS00): a temperature of 16 bits in each reply, no fault, no state.
#pragma once

#include "drive_protocols/mit_drive.hpp"

namespace pmg::drives {

/// Reply: node, position 16 bits, velocity 12, torque 12, temperature 16 [0.1 degC]. The answer to a question for
/// faults, which this project doesn't ask, has the same identifier and length: it is no reading. Six bytes of ones
/// begin messages that set identifiers, modes and protocols: no command has them.
class RobstrideDrive final : public MitDrive {
 public:
  static constexpr std::uint32_t kReplyId = 0xFD;  ///< the host's, as delivered

  explicit RobstrideDrive(const MitRanges& ranges) noexcept : MitDrive(ranges, "robstride", {.six_bytes = true}) {}

  std::optional<MitReply> read(std::span<const std::uint8_t> bytes) const noexcept override;
  Message reply(const MitReply& reply) const noexcept override;

 protected:
  DriveKind with(const MitRanges& ranges) const override { return std::make_shared<RobstrideDrive>(ranges); }
};

}  // namespace pmg::drives
