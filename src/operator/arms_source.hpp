// Sends what an operator wants of a robot's arms, in the name of the source that drives it.
#pragma once

#include <Eigen/Geometry>
#include <string>

#include "operator/operator_source.hpp"
#include "pmg/types.hpp"
#include "pmg_msgs/arms_t.hpp"

namespace pmg::ops {

struct PalmWish {
  std::int8_t wish = pmg_msgs::arms_t::HOLD;              ///< HOLD to HAND_BACK of pmg_msgs::arms_t
  Eigen::Vector3d p_m = Eigen::Vector3d::Zero();          ///< [m] of the palm in the torso link's frame T
  Eigen::Quaterniond R = Eigen::Quaterniond::Identity();  ///< R_TP
};

class ArmsSource {
 public:
  /// Keeps a reference.
  explicit ArmsSource(OperatorSource& source);

  /// Left and right, in force for lease_s after the controller has received it, 0.5 s at most. It counts only while the
  /// source drives this robot.
  void send(const std::string& robot, const PerFoot<PalmWish>& palms, double lease_s);

 private:
  OperatorSource& source_;
  pmg_msgs::arms_t message_{};
};

}  // namespace pmg::ops
