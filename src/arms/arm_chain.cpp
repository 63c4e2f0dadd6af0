#include "arms/arm_chain.hpp"

#include <algorithm>

#include "model/chain_kinematics.hpp"

namespace pmg::arms {

namespace {

using model::to_eigen;

Eigen::Isometry3d isometry(const KDL::Frame& frame) noexcept {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(frame.M.data);
  T.translation() = to_eigen(frame.p);
  return T;
}

}  // namespace

ArmChain::ArmChain(const PalmSetup& palm, const std::vector<LinkShape>& shapes)
    : chain_(palm.chain), joints_(palm.joints), T_LP_(palm.T_LP), axes_(joints_.size()), origins_(joints_.size()) {
  Eigen::Index moving = 0;
  for (std::size_t i = 0; i < chain_.segments.size(); ++i) {
    if (chain_.segments[i].getJoint().getType() != KDL::Joint::Fixed) ++moving;
    for (const LinkShape& shape : shapes) {
      if (shape.link == chain_.segments[i].getName())
        bodies_.push_back({shape.link, capsule_around(shape.shape), i, moving});
    }
  }
  capsules_.resize(bodies_.size());
  compute(ArmVector::Zero(size()));
  // Lengths between joints add up: no posture reaches farther.
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    std::vector<double> reach(joints_.size(), 0.0);
    const ArmBody& body = bodies_[b];
    double beyond_m = 0.0;
    for (Eigen::Index i = body.moved_by; i-- > 0;) {
      if (i + 1 == body.moved_by) {
        const Capsule& shape = capsules_[b];
        beyond_m = std::max((shape.a - origin(i)).norm(), (shape.b - origin(i)).norm()) + shape.radius_m;
      }
      if (i + 1 < body.moved_by) beyond_m += (origin(i + 1) - origin(i)).norm();
      reach[static_cast<std::size_t>(i)] = beyond_m;
    }
    reach_m_.push_back(std::move(reach));
  }
}

void ArmChain::compute(const ArmVector& q) noexcept {
  KDL::Frame pose = KDL::Frame::Identity();
  Eigen::Index moving = 0;
  std::size_t body = 0;
  for (std::size_t i = 0; i < chain_.segments.size(); ++i) {
    const KDL::Segment& segment = chain_.segments[i];
    const KDL::Joint& joint = segment.getJoint();
    double angle_rad = 0.0;
    if (joint.getType() != KDL::Joint::Fixed) {
      axes_[static_cast<std::size_t>(moving)] = to_eigen(pose.M * joint.JointAxis());
      origins_[static_cast<std::size_t>(moving)] = to_eigen(pose * joint.JointOrigin());
      angle_rad = q[moving++];
    }
    pose = pose * segment.pose(angle_rad);
    for (; body < bodies_.size() && bodies_[body].segment == i; ++body) {
      const Eigen::Isometry3d T = isometry(pose);
      const Capsule& shape = bodies_[body].shape;
      capsules_[body] = {T * shape.a, T * shape.b, shape.radius_m};
    }
  }
  const Eigen::Isometry3d T_TP = isometry(pose) * T_LP_;
  palm_.p_m = T_TP.translation();
  palm_.R = Eigen::Quaterniond(T_TP.linear());
}

}  // namespace pmg::arms
