// One motor as every drive protocol sees it: command, reading, limits. Values belong to the drive's output shaft.
#pragma once

#include <cstdint>

namespace pmg::drives {

/// torque = kp (q - q_measured) + kd (dq - dq_measured) + feed-forward, closed by the drive until the next command.
struct MotorCommand {
  double q_rad = 0.0, dq_rad_s = 0.0;
  double kp_Nm_per_rad = 0.0, kd_Nm_s_per_rad = 0.0;
  double torque_Nm = 0.0;  ///< feed-forward
};

bool finite(const MotorCommand& command) noexcept;  ///< every value

/// Every |value| that a command may have. A command beyond them never reaches a bus.
struct MotorLimits {
  double q_lower_rad = 0.0, q_upper_rad = 0.0;
  double dq_rad_s = 0.0;
  double torque_Nm = 0.0;
};

/// The fault that a drive reports of itself.
enum class DriveFault : std::uint8_t {
  kNone = 0,
  kOverTemperature,
  kOverCurrent,
  kOverVoltage,
  kUnderVoltage,
  kEncoder,
  kBridgeTemperature,
  kStall,
  kOther,  ///< a code that the protocol's documentation doesn't name
  kCommunication,
  kFollowing,  ///< the position lags behind its target by more than the drive allows
  kOverload,   ///< more torque for longer than the drive allows
};

const char* to_string(DriveFault fault) noexcept;  ///< "over-temperature of the motor"

/// Whether a drive does what it was told, as it says itself.
enum class Follows : std::uint8_t { kUnknown, kNo, kYes };

struct MotorReading {
  double q_rad = 0.0, dq_rad_s = 0.0, torque_Nm = 0.0;
  double temperature_degC = 0.0;
  DriveFault fault = DriveFault::kNone;
  Follows follows = Follows::kUnknown;
};

}  // namespace pmg::drives
