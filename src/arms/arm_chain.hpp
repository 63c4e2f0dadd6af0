// Kinematics of one arm: palm, axes, and the arm's own collision shapes, in the torso's frame.
#pragma once

#include <kdl/chain.hpp>
#include <vector>

#include "arms/arm_setup.hpp"
#include "arms/collision_bodies.hpp"
#include "arms/palm.hpp"

namespace pmg::arms {

/// One collision shape that an arm moves.
struct ArmBody {
  std::string link;
  Capsule shape;              ///< in its link's frame
  std::size_t segment = 0;    ///< of the chain, which carries it
  Eigen::Index moved_by = 0;  ///< number of the arm's joints above it
};

/// One pass over the chain gives everything. No heap after construction.
class ArmChain {
 public:
  ArmChain(const PalmSetup& palm, const std::vector<LinkShape>& shapes);

  void compute(const ArmVector& q) noexcept;  ///< [rad]

  Eigen::Index size() const noexcept { return static_cast<Eigen::Index>(joints_.size()); }
  const std::vector<int>& joints() const noexcept { return joints_; }  ///< in the robot's joint order
  const std::vector<ArmBody>& bodies() const noexcept { return bodies_; }

  const PalmPose& palm() const noexcept { return palm_; }
  const Eigen::Vector3d& axis(Eigen::Index i) const noexcept { return axes_[static_cast<std::size_t>(i)]; }
  const Eigen::Vector3d& origin(Eigen::Index i) const noexcept { return origins_[static_cast<std::size_t>(i)]; }
  const std::vector<Capsule>& capsules() const noexcept { return capsules_; }  ///< of bodies(), in T

  /// The way that a unit of speed of joint i moves a point of the arm beyond it [m/rad].
  Eigen::Vector3d lever(Eigen::Index i, const Eigen::Vector3d& point) const noexcept {
    return axis(i).cross(point - origin(i));
  }
  /// No point of the body is farther from joint i's axis in any posture [m].
  double reach_m(std::size_t body, Eigen::Index i) const noexcept {
    return reach_m_[body][static_cast<std::size_t>(i)];
  }

 private:
  KDL::Chain chain_;
  std::vector<int> joints_;
  Eigen::Isometry3d T_LP_;
  std::vector<ArmBody> bodies_;
  std::vector<std::vector<double>> reach_m_;
  std::vector<Eigen::Vector3d> axes_, origins_;
  std::vector<Capsule> capsules_;
  PalmPose palm_;
};

}  // namespace pmg::arms
