// The load of one joint of a hanging robot while all other joints hold: the bench is then the robot itself.
#pragma once

#include <string>

#include "model/robot_model.hpp"

namespace pmg::sim {

struct HangingLoad {
  double mass_kg = 0.0;        ///< of all links beyond the joint
  double inertia_kg_m2 = 0.0;  ///< about the axis, without the rotor; all other joints are rigid
  double gravity_Nm = 0.0;     ///< torque on the joint is -gravity_Nm sin(q - hangs_at_rad)
  double hangs_at_rad = 0.0;
};

/// In the standing posture, base upright and fixed. (A robot in straps recoils, so its limbs seem lighter.) Throws
/// std::runtime_error if MuJoCo refuses the robot, std::invalid_argument if there is no such joint.
HangingLoad hanging_load(const model::RobotModel& robot, const std::string& joint);

}  // namespace pmg::sim
