// The kinds of drives that robot.yaml's `drives` describes.
#pragma once

#include <string>
#include <variant>

#include "drives/cia402.hpp"
#include "drives/mit_protocol.hpp"
#include "drives/motor.hpp"
#include "files/config_reader.hpp"

namespace pmg::drives {

using DriveKind = std::variant<MitRanges, Cia402Settings>;

/// One entry of `drives`. Throws files::ConfigError.
DriveKind read_drive_kind(files::ConfigReader reader);

/// What a joint asks of its drive, at the drive's output shaft.
struct DriveNeeds {
  MotorLimits limits;
  MotorCommand gains;  ///< kp and kd
};

/// Throws files::ConfigError at reader's `bus` when the drive doesn't cover these needs: a field of its frames is too
/// short, its torque too small, or its own loop has other gains. drive: its name in `drives`.
void check_covers(const DriveKind& kind, const DriveNeeds& needs, const std::string& joint, const std::string& drive,
                  const files::ConfigReader& reader);

}  // namespace pmg::drives
