// The shapes with which a robot's links collide, as capsules: how far arms are from legs.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "model/chain_kinematics.hpp"
#include "model/robot_model.hpp"
#include "pmg/types.hpp"

namespace pmg::retargeting {

/// The points within radius_m of the line from a to b [m].
struct Capsule {
  Eigen::Vector3d a = Eigen::Vector3d::Zero(), b = a;
  double radius_m = 0.0;
};

/// Of their surfaces; negative where they are in each other, down to the sum of the radii.
double distance_m(const Capsule& one, const Capsule& other);

/// The collision shapes of some links of a robot. A cylinder has the capsule inside it, as in the simulation; a box one
/// along its longest edge, as thick as its middle one.
class LinkCapsules {
 public:
  LinkCapsules(const model::RobotModel& robot, const std::vector<std::string>& links);

  /// (q of all joints) => (capsules in the base's frame).
  const std::vector<Capsule>& compute(const JointVector& q);

 private:
  struct Shape {
    model::ChainKinematics chain;  ///< from the base to the link
    Capsule in_link;
  };
  std::vector<Shape> shapes_;
  std::vector<Capsule> capsules_;
};

/// The link that a joint moves, and all below it.
std::vector<std::string> links_below(const model::RobotModel& robot, int joint);

}  // namespace pmg::retargeting
