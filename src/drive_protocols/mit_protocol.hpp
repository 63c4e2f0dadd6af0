// The 8-byte protocol of drives that descend from MIT's Mini Cheetah: one command, one reply. Byte order and bits as in
// that robot's published firmware; temperature and fault code of the reply as in CubeMars' AK series (driver manual,
// section "MIT mode").
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "drive_protocols/fixed_point.hpp"
#include "drives/motor.hpp"

namespace pmg::drives {

/// What a drive's firmware takes as the ends of the frames' fields: [-position, position], ..., [0, kp], [0, kd].
struct MitRanges {
  double position_rad = 0.0, velocity_rad_s = 0.0, torque_Nm = 0.0;
  double kp_Nm_per_rad = 0.0, kd_Nm_s_per_rad = 0.0;
  std::uint32_t reply_id = 0;  ///< identifier of its replies: the host's, 0 unless the firmware is set otherwise
};

using MitFrame = std::array<std::uint8_t, 8>;

/// Which frames of ones a dialect takes for something else than a command.
struct MitSpecials {
  std::uint8_t lowest = 0xFC;  ///< last byte of seven bytes of ones and this one, up to 0xFE
  bool six_bytes = false;      ///< six bytes of ones are enough, whatever the others are
};

inline constexpr MitFrame kMitEnable = {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFC};
inline constexpr MitFrame kMitDisable = {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFD};
/// The drive takes its present position as zero and keeps that over power cycles.
inline constexpr MitFrame kMitZero = {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFE};

struct MitReply {
  std::uint8_t node = 0;
  MotorReading reading;
};

class MitProtocol {
 public:
  explicit MitProtocol(const MitRanges& ranges, MitSpecials specials = {}) noexcept;

  /// Bits 63..0: position 16, velocity 12, kp 12, kd 12, torque 12. Each value is the nearest that the field has within
  /// limits and ranges; values that aren't finite give a command without torque. No command is one of the dialect's
  /// special frames: see the definition.
  MitFrame command(const MotorCommand& command, const MotorLimits& limits) const noexcept;
  /// The same for a command that is sent again and again. Zero lies between two codes of velocity and torque: rounded
  /// alike each time, a joint at rest would get a torque that nobody asked for. So the torque takes what the steps of
  /// position and velocity leave, and left_Nm carries what its own step leaves, half of it at most, to the next frame:
  /// the mean torque is the asked one. What a limit cuts is not made up for.
  MitFrame command(const MotorCommand& command, const MotorLimits& limits, double& left_Nm) const noexcept;
  /// What the drive reads from a command. Nullopt: one of its dialect's special frames.
  std::optional<MotorCommand> command(const MitFrame& frame) const noexcept;

  /// Bytes: node, position 16 bits, velocity 12, torque 12, temperature + 40 degC, fault code. Nullopt: not 8 bytes.
  std::optional<MitReply> reply(std::span<const std::uint8_t> bytes) const noexcept;
  MitFrame reply(const MitReply& reply) const noexcept;

  const FixedPoint& position() const noexcept { return position_; }
  const FixedPoint& velocity() const noexcept { return velocity_; }
  const FixedPoint& torque() const noexcept { return torque_; }

 private:
  bool special(const MitFrame& frame) const noexcept;

  FixedPoint position_, velocity_, kp_, kd_, torque_;
  MitSpecials specials_;
};

}  // namespace pmg::drives
