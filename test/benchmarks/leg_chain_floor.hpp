// A six-joint humanoid leg by hand: the floor for KDL's kinematics and for the ground-aware optimisation.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "model/chain_kinematics.hpp"
#include "model/robot_model.hpp"
#include "pmg/types.hpp"

namespace pmg::test {

/// Hip pitch, roll, yaw, knee, ankle pitch, roll: rotations about coordinate axes with constant offsets, multiplied one
/// after another.
class LegChainFloor {
 public:
  LegChainFloor(const model::RobotModel& robot, Foot foot) : joints_(robot.leg_joints[foot]) {
    model::ChainKinematics chain(robot.leg_chain[foot], joints_);
    chain.compute(JointVector::Zero(robot.joint_index.size()));
    offset_[0] = chain.origin(0);
    for (std::size_t i = 1; i < 6; ++i) offset_[i] = chain.origin(i) - chain.origin(i - 1);
    offset_[6] = chain.p() - chain.origin(5);
  }

  void compute(const JointVector& q) {
    R = Eigen::Matrix3d::Identity();
    p = offset_[0];
    turn<2, 0>(0, q);  // y: hip pitch
    turn<1, 2>(1, q);  // x: hip roll
    turn<0, 1>(2, q);  // z: hip yaw
    turn<2, 0>(3, q);  // y: knee
    turn<2, 0>(4, q);  // y: ankle pitch
    turn<1, 2>(5, q);  // x: ankle roll
    for (int i = 0; i < 6; ++i) {
      const auto joint = static_cast<std::size_t>(i);
      J.col(i).head<3>() = axis_[joint].cross(p - origin_[joint]);
      J.col(i).tail<3>() = axis_[joint];
    }
  }

  Eigen::Matrix3d R;
  Eigen::Vector3d p;
  Eigen::Matrix<double, 6, 6> J;

 private:
  /// Rotates columns kA, kB of R about the third one, then moves on to the next joint.
  template <int kA, int kB>
  void turn(std::size_t joint, const JointVector& q) {
    axis_[joint] = R.col(3 - kA - kB);
    origin_[joint] = p;
    const double angle = q[joints_[joint]];
    const double cosine = std::cos(angle), sine = std::sin(angle);
    const Eigen::Vector3d a = R.col(kA), b = R.col(kB);
    R.col(kA) = cosine * a + sine * b;
    R.col(kB) = cosine * b - sine * a;
    p += R * offset_[joint + 1];
  }

  std::vector<int> joints_;
  std::array<Eigen::Vector3d, 7> offset_;
  std::array<Eigen::Vector3d, 6> axis_, origin_;
};

}  // namespace pmg::test
