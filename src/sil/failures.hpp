// Failures that a user injects into a simulated run, and what the drives got after each: the page's promises, measured.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "model/robot_model.hpp"

namespace pmg::sil {

enum class FailureKind {
  kEncoderStuck,        ///< the joint reports the position that it had
  kEncoderOffset,       ///< value is added to the joint's position [rad]
  kEncoderLost,         ///< the joint reports no number
  kSpeedReading,        ///< the joint reports the speed value [rad/s]
  kTorqueReading,       ///< the joint reports the torque value [Nm]
  kHot,                 ///< the joint's drive reports the temperature value [degC]
  kMotorSilent,         ///< the joint's motor gives no torque; its encoder works
  kImuLost,             ///< the IMU reports no number
  kImuFrozen,           ///< the IMU reports what it had
  kImuDrift,            ///< the orientation turns about the pitch axis by value [rad/s]
  kPacketLoss,          ///< value per cent of the cycles bring no answer of the drives
  kDelay,               ///< the drives' answers are value [s] old
  kBusLost,             ///< the drives don't answer at all
  kStall,               ///< both real-time threads sleep
  kStallBus,            ///< the bus thread sleeps
  kStallControl,        ///< the control thread sleeps
  kPolicyLate,          ///< the policy gives no result in time
  kPolicyNotFinite,     ///< the policy gives no number
  kPolicyFar,           ///< the policy pulls the joint value [rad] away from the reference
  kOverrun,             ///< the control thread's ticks end value [s] later than they would
  kReferenceNotFinite,  ///< the motion generator gives no number
  kCommandNotFinite,    ///< the control thread's command has no number
};

const char* to_string(FailureKind kind) noexcept;

/// One failure, from at_s for for_s seconds of the run.
struct Failure {
  FailureKind kind = FailureKind::kStall;
  double at_s = 0.0, for_s = 0.0;
  int joint = -1;
  double value = 0.0;

  /// Times are whole bus cycles; a tenth of one is rounding.
  bool acts(double time_s) const noexcept { return time_s > at_s - 2e-4 && time_s < at_s + for_s - 2e-4; }
};

/// Reads a list of failures (docs/reference/file-formats.md). Throws files::ConfigError.
std::vector<Failure> load_failures(const std::filesystem::path& file, const model::RobotModel& robot);

/// The drives' side of one failure, in bus cycles from the first one that carries it; -1: never.
struct FailureReaction {
  std::int64_t cycles_to_sit_down = -1, cycles_to_damping = -1;
};

}  // namespace pmg::sil
