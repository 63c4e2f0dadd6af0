// The first movements of a new robot on the gantry: one motor at a time, the others switched off.
#pragma once

#include <functional>
#include <string>

#include "can/link.hpp"
#include "drives/drive_setup.hpp"
#include "model/robot_model.hpp"

namespace pmg::can {

struct WiggleOptions {
  double by_rad = 0.05;     ///< there, back, and back to the start
  double gain_share = 0.3;  ///< of robot.yaml's kp and kd; a drive in position mode has its own
  double speed_rad_s = 0.1;
};

/// One joint's movement as its drive reports it, in the joint's own sign.
struct Wiggle {
  double asked_rad = 0.0, moved_rad = 0.0;  ///< from the start to the farther end of the positive way
  double held_Nm = 0.0;                     ///< mean torque of the drive at rest between the two ends
  double model_Nm = 0.0;                    ///< the model's torque to hold the hanging joint there
  double friction_Nm = 0.0;                 ///< within which the two can't be compared
};

/// Enables the motor, moves the joint forth and back, and disables it whatever happens. Throws std::runtime_error when
/// the motor doesn't answer, reports a fault, starts outside its joint's range, or when it was interrupted. q: how the
/// robot hangs [rad], which the model's torque depends on. tick is called every 2 ms and waits; emulators answer in it.
Wiggle wiggle(const model::RobotModel& robot, const JointVector& q, const drives::BusSetup& bus,
              const drives::MotorSetup& motor, Link& link, const WiggleOptions& options,
              const std::function<void()>& tick, const std::function<bool()>& interrupted);

/// Where the centre of mass of everything beyond the joint goes when the joint turns by +by_rad from the posture q
/// [rad], base upright: "31 mm backward, 4 mm up". This is what the eye compares.
std::string way_of(const model::RobotModel& robot, const JointVector& q, const std::string& joint, double by_rad);

/// What the figures say of direction and gear, one line.
std::string verdict(const Wiggle& wiggle);

}  // namespace pmg::can
