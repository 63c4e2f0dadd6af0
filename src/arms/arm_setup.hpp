// Which joints are arms: the section `arms` of robot.yaml.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "arms/palm.hpp"
#include "model/robot_model.hpp"

namespace pmg::arms {

struct PalmSetup {
  std::string link;                                        ///< that carries the palm
  Eigen::Isometry3d T_LP = Eigen::Isometry3d::Identity();  ///< palm in that link's frame
  KDL::Chain chain;                                        ///< torso_link -> link
  std::vector<int> joints;                                 ///< joint order index of each moving joint of the chain
};

struct ArmSetup {
  PerArm<PalmSetup> palm;
  double speed_rad_s = 0.0;  ///< bound on every arm joint's speed, besides its own limit
};

/// Reads DIRECTORY/robot.yaml's `arms`. Nothing: the robot has none. Throws ConfigError if a palm's link isn't a link,
/// hangs on no joints or more than kMaxArmJoints, or if a joint of an arm is one of the policy's or of both arms.
std::optional<ArmSetup> read_arm_setup(const model::RobotModel& robot);

/// From palm to palm with both arms stretched sideways [m], by their links' lengths alone: the shoulder is as far from
/// the middle as its first joint lies to the side, the rest of the arm as long as the distances from joint to joint.
///   span = sum over arms of ( |sum of y up to the first moving joint| + sum over later origins of |p_i| + |p_LP| )
double span_m(const ArmSetup& setup);

}  // namespace pmg::arms
