#include "model/chain_kinematics.hpp"

#include <utility>

namespace pmg::model {

ChainKinematics::ChainKinematics(const KDL::Chain& chain, std::vector<int> joints)
    : chain_(chain), joints_(std::move(joints)), axes_(joints_.size()), origins_(joints_.size()) {}

void ChainKinematics::compute(const JointVector& q) noexcept {
  KDL::Frame pose = KDL::Frame::Identity();
  std::size_t moving = 0;
  for (const KDL::Segment& segment : chain_.segments) {
    const KDL::Joint& joint = segment.getJoint();
    double angle_rad = 0.0;
    if (joint.getType() != KDL::Joint::Fixed) {
      axes_[moving] = to_eigen(pose.M * joint.JointAxis());
      origins_[moving] = to_eigen(pose * joint.JointOrigin());
      angle_rad = q[joints_[moving]];
      ++moving;
    }
    pose = pose * segment.pose(angle_rad);
  }
  R_ = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(pose.M.data);
  p_ = to_eigen(pose.p);
}

}  // namespace pmg::model
