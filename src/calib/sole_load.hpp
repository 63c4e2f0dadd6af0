// How a still robot's soles are loaded, from its joints' torques: nobody has force sensors.
#pragma once

#include <Eigen/Core>
#include <kdl/chaindynparam.hpp>
#include <vector>

#include "model/leg_kinematics.hpp"

namespace pmg::calib {

struct SoleLoad {
  double force_N = 0.0;                                 ///< along the sole's normal, positive when the ground pushes
  Eigen::Vector2d moment_Nm = Eigen::Vector2d::Zero();  ///< of the ground on the sole about its centre, its x and y
  /// From the centre of pressure to the nearest edge of the sole [m]: a sole that stands on an edge has it there, one
  /// that lies flat inside.
  double inside_m = 0.0;
};

class SoleLoads {
 public:
  explicit SoleLoads(const model::RobotModel& robot);

  /// Statics of each leg: J^T f = gravity torque of the leg - joint torques. q [rad], torque [Nm]: all joints.
  /// gravity_B: unit vector in the base frame. Joint friction is an error of its size over the force's lever.
  PerFoot<SoleLoad> of(const JointVector& q, const JointVector& torque_Nm, const Eigen::Vector3d& gravity_B);

 private:
  const model::RobotModel& robot_;
  model::LegKinematics legs_;
};

}  // namespace pmg::calib
