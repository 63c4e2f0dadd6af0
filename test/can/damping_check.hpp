// Whether a drive damps: of drives that close their loop themselves, and of drives that get a torque.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <variant>
#include <vector>

#include "can/bus_setup.hpp"
#include "can/drive_emulator.hpp"
#include "drive_protocols/canopen_drive.hpp"
#include "drive_protocols/mit_drive.hpp"
#include "drive_protocols/mit_protocol.hpp"
#include "model/robot_io.hpp"
#include "model/robot_model.hpp"

namespace pmg::test {

/// A drive damps when it holds no position and its torque is zero or opposes the motor's speed, by kd |dq| at most. kd
/// is robot.yaml's, or that of the drive's own brake.
class DampingCheck {
 public:
  DampingCheck(const can::DriveSetup& setup, const model::RobotModel& robot) : bounds_(robot.joints.size()) {
    for (const can::BusSetup& bus : setup.buses) {
      for (const drives::MotorSetup& motor : bus.motors) {
        const auto joint = static_cast<std::size_t>(motor.index);
        bounds_[joint] = bounds(motor, robot.joints[joint].kd_Nm_s_per_rad);
      }
    }
  }

  /// given: what the drives do now, at the joints. felt: the true joints at that moment.
  bool damps(int joint, const model::JointCommand& given, const model::RobotState& felt) const noexcept {
    const Bounds& bounds = bounds_[static_cast<std::size_t>(joint)];
    const double dq = felt.dq[joint];
    const double torque_Nm = given.kd[joint] * (given.dq[joint] - dq) + given.tau_ff[joint];
    const double along_Nm = dq < 0.0 ? -torque_Nm : torque_Nm;
    return given.kp[joint] == 0.0 && along_Nm <= bounds.rounding_Nm &&
           along_Nm >= -bounds.kd_Nm_s_per_rad * std::abs(dq) - bounds.rounding_Nm;
  }

 private:
  struct Bounds {
    double kd_Nm_s_per_rad = 0.0;
    double rounding_Nm = 0.0;  // of the bus's numbers for torque and speed
  };
  static constexpr double kHalf = 0.501;  // a value may lie midway between two codes, but for its own rounding error
  /// Half a step of each field of the drive's messages: zero lies between two codes of an MIT drive's.
  static Bounds bounds(const drives::MotorSetup& motor, double kd_Nm_s_per_rad) {
    drives::MotorCommand step;
    if (const drives::MitDrive* mit = drives::as_mit(motor.drive)) {
      const drives::MitProtocol& protocol = mit->codec();
      step.torque_Nm = protocol.torque().step();
      step.dq_rad_s = protocol.velocity().step();
      step.kd_Nm_s_per_rad = drives::FixedPoint(0.0, mit->ranges().kd_Nm_s_per_rad, 12).step();
    } else {
      const auto& settings = *drives::as_cia402(motor.drive);
      step.torque_Nm = 1e-3 * settings.rated_torque_Nm;
      step.dq_rad_s = settings.velocity_unit_rad_s;
    }
    const drives::MotorCommand at_joint = motor.transmission.to_joint(step);
    const double brake =
        motor.transmission.to_joint({.kd_Nm_s_per_rad = DriveEmulator::kBrake_Nm_s_per_rad}).kd_Nm_s_per_rad;
    const double kd = std::max(kd_Nm_s_per_rad, brake) + kHalf * at_joint.kd_Nm_s_per_rad;
    return {.kd_Nm_s_per_rad = kd,
            .rounding_Nm = kHalf * (std::abs(at_joint.torque_Nm) + kd * std::abs(at_joint.dq_rad_s))};
  }

  std::vector<Bounds> bounds_;
};

}  // namespace pmg::test
