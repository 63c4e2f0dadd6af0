// What one joint of a hanging robot moves while all others hold: the load of a bench that is made of a robot.
#pragma once

#include <Eigen/Core>
#include <string>

#include "model/robot_model.hpp"

namespace pmg::model {

struct HangingLoad {
  double mass_kg = 0.0;        ///< of all links beyond the joint
  double inertia_kg_m2 = 0.0;  ///< about the axis, without the rotor; nothing else gives way
  double gravity_Nm = 0.0;     ///< torque on the joint is -gravity_Nm sin(q - hangs_at_rad), base upright
  double hangs_at_rad = 0.0;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();             ///< of the joint, in the base's axes
  Eigen::Vector3d center_m = Eigen::Vector3d::Zero();          ///< centre of mass in the base, at q
  Eigen::Vector3d center_m_per_rad = Eigen::Vector3d::Zero();  ///< its motion a x (c - o), in the base's axes
};

/// How a robot hangs.
struct Hanging {
  Eigen::Vector3d down_B = -Eigen::Vector3d::UnitZ();  ///< gravity's direction in the base's axes
  std::string held_link;                               ///< what the gantry holds; empty: the base
};

/// The torque that holds a joint at rest is gravity_Nm sin(q - hangs_at_rad).
struct GravityLoad {
  double gravity_Nm = 0.0, hangs_at_rad = 0.0;
  double holding_Nm(double q_rad) const noexcept;
};

/// What hangs at the joint, all other joints at q [rad]: the links beyond it; of a joint between the base and the held
/// link everything on the base's side, which turns the other way. With the centre of mass c of these links, the axis a
/// through o and the sign s = 1 or -1: holding torque = -s m g down . (a x (c - o)). Throws std::invalid_argument when
/// there is no such joint.
GravityLoad gravity_load(const RobotModel& robot, const std::string& joint, const JointVector& q,
                         const Hanging& hanging);

/// The link is beyond the joint.
bool beyond(const RobotModel& robot, const std::string& joint, const std::string& link);
/// The joint is on the way from the base to the held link: it turns the base, not what is held.
bool turns_base(const RobotModel& robot, const std::string& joint, const Hanging& hanging);

/// The links beyond the joint as one rigid body, all other joints at q [rad], base upright and held:
/// inertia = a^T I_o a, gravity torque = a . ((c - o) x m g), with the axis a through o, the inertia I_o about o and
/// the centre of mass c. (A robot in straps recoils: its limbs seem lighter.) Throws std::invalid_argument when there
/// is no such joint.
HangingLoad hanging_load(const RobotModel& robot, const std::string& joint, const JointVector& q);

/// The same in the standing posture.
HangingLoad hanging_load(const RobotModel& robot, const std::string& joint);

}  // namespace pmg::model
