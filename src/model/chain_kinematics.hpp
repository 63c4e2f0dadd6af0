// One pass over a KDL chain: the pose of its end and every joint's axis, in the chain's base frame.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <kdl/chain.hpp>
#include <kdl/frames.hpp>
#include <vector>

#include "pmg/types.hpp"

namespace pmg::model {

inline Eigen::Vector3d to_eigen(const KDL::Vector& v) { return {v.x(), v.y(), v.z()}; }

/// Forward kinematics of a chain of fixed and revolute joints. KDL's position and Jacobian solvers walk the chain once
/// each; this class walks it once for both. No heap after construction.
class ChainKinematics {
 public:
  /// joints: for each moving joint of the chain, from the base on, its index in the robot's joint order.
  ChainKinematics(const KDL::Chain& chain, std::vector<int> joints);

  void compute(const JointVector& q) noexcept;  ///< (q) => (axes, origins, R, p); q: all joints of the robot [rad]

  std::size_t size() const noexcept { return joints_.size(); }
  int joint(std::size_t i) const noexcept { return joints_[i]; }
  const Eigen::Vector3d& axis(std::size_t i) const noexcept { return axes_[i]; }  ///< unit vector in the base frame
  const Eigen::Vector3d& origin(std::size_t i) const noexcept { return origins_[i]; }  ///< a point on the axis [m]
  const Eigen::Matrix3d& R() const noexcept { return R_; }                             ///< of the chain's end
  const Eigen::Vector3d& p() const noexcept { return p_; }                             ///< of the chain's end [m]

 private:
  KDL::Chain chain_;
  std::vector<int> joints_;
  std::vector<Eigen::Vector3d> axes_, origins_;
  Eigen::Matrix3d R_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_ = Eigen::Vector3d::Zero();
};

}  // namespace pmg::model
