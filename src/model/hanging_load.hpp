// What one joint of a hanging robot moves while all others hold: the load of a bench that is made of a robot.
#pragma once

#include <Eigen/Core>
#include <string>

#include "model/robot_model.hpp"

namespace pmg::model {

struct HangingLoad {
  double mass_kg = 0.0;        ///< of all links beyond the joint
  double inertia_kg_m2 = 0.0;  ///< about the axis, without the rotor; nothing else gives way
  double gravity_Nm = 0.0;     ///< torque on the joint is -gravity_Nm sin(q - hangs_at_rad)
  double hangs_at_rad = 0.0;
  Eigen::Vector3d center_m = Eigen::Vector3d::Zero();          ///< centre of mass in the base, at q
  Eigen::Vector3d center_m_per_rad = Eigen::Vector3d::Zero();  ///< its motion a x (c - o), in the base's axes
};

/// The links beyond the joint as one rigid body, all other joints at q [rad], base upright and held:
/// inertia = a^T I_o a, gravity torque = a . ((c - o) x m g), with the axis a through o, the inertia I_o about o and
/// the centre of mass c. (A robot in straps recoils: its limbs seem lighter.) Throws std::invalid_argument when there
/// is no such joint.
HangingLoad hanging_load(const RobotModel& robot, const std::string& joint, const JointVector& q);

/// The same in the standing posture.
HangingLoad hanging_load(const RobotModel& robot, const std::string& joint);

}  // namespace pmg::model
