// Where a robot's arm is: shoulder, elbow and wrist.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "generator/joint_roles.hpp"
#include "model/chain_kinematics.hpp"
#include "model/robot_model.hpp"
#include "pmg/types.hpp"

namespace pmg::retargeting {

/// In the base's frame [m]. The wrist is the end of the chain of links below the elbow.
struct ArmPoints {
  Eigen::Vector3d shoulder, elbow, wrist;
};

class ArmChain {
 public:
  /// nullopt: the robot lacks this shoulder or elbow.
  static std::optional<ArmChain> of(const model::RobotModel& robot, const generator::JointRoles& roles, Foot side);

  /// (q of all joints) => (points).
  ArmPoints compute(const JointVector& q);
  /// The joints from the shoulder's first one to the elbow, in the robot's joint order.
  std::vector<int> joints() const;

 private:
  explicit ArmChain(model::ChainKinematics chain) : chain_(std::move(chain)) {}
  model::ChainKinematics chain_;
  std::size_t shoulder_ = 0, elbow_ = 0;
};

}  // namespace pmg::retargeting
