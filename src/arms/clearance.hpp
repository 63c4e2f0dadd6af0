// Distances between the shapes of a robot's links: segments with a radius (capsules, spheres) and boxes.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace pmg::arms {

/// All points within radius_m of the line from a to b. A sphere has a == b.
struct Capsule {
  Eigen::Vector3d a = Eigen::Vector3d::Zero(), b = Eigen::Vector3d::Zero();  ///< [m]
  double radius_m = 0.0;
};

struct Box {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< of its centre
  Eigen::Vector3d half_m = Eigen::Vector3d::Zero();
};

/// How far a capsule is from another shape.
struct Clearance {
  double distance_m = 0.0;                            ///< between the surfaces; negative: they overlap
  Eigen::Vector3d point = Eigen::Vector3d::Zero();    ///< on the capsule's axis, nearest to the other shape
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit vector from the other shape to that point
};

/// (capsule, other capsule) => (clearance), exact: nearest points of two segments (Ericson, Real-Time Collision
/// Detection, 2005, 5.1.9).
Clearance clearance(const Capsule& capsule, const Capsule& other) noexcept;

/// (capsule, box) => (clearance), exact while the axis is outside the box: along the axis the squared distance to a box
/// is convex and piecewise quadratic. Where the axis enters the box the distance is -radius.
Clearance clearance(const Capsule& capsule, const Box& box) noexcept;

}  // namespace pmg::arms
