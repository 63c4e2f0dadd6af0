#include "retargeting/link_capsules.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "model/link_chain.hpp"

namespace pmg::retargeting {
namespace {

/// Along z, about the origin.
Capsule along_z(double half_length_m, double radius_m) {
  const Eigen::Vector3d end(0.0, 0.0, std::max(half_length_m, 0.0));
  return {-end, end, radius_m};
}

std::optional<Capsule> capsule_of(const urdf::Geometry& geometry) {
  if (geometry.type == urdf::Geometry::SPHERE) return along_z(0.0, dynamic_cast<const urdf::Sphere&>(geometry).radius);
  if (geometry.type == urdf::Geometry::CYLINDER) {
    const auto& cylinder = dynamic_cast<const urdf::Cylinder&>(geometry);
    return along_z(0.5 * cylinder.length - cylinder.radius, std::min(cylinder.radius, 0.5 * cylinder.length));
  }
  if (geometry.type != urdf::Geometry::BOX) return std::nullopt;  // a mesh: the simulation doesn't collide it either
  const urdf::Vector3& size = dynamic_cast<const urdf::Box&>(geometry).dim;
  std::array<std::pair<double, Eigen::Index>, 3> edges = {
      std::pair{size.x, Eigen::Index{0}}, {size.y, Eigen::Index{1}}, {size.z, Eigen::Index{2}}};
  std::ranges::sort(edges);
  Capsule box;
  box.radius_m = 0.5 * edges[1].first;
  box.b[edges[2].second] = 0.5 * edges[2].first - box.radius_m;
  box.a = -box.b;
  return box;
}

Eigen::Isometry3d pose_of(const urdf::Pose& pose) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() << pose.position.x, pose.position.y, pose.position.z;
  T.linear() = Eigen::Quaterniond(pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z)
                   .normalized()
                   .toRotationMatrix();
  return T;
}

void add_link(const urdf::Link& link, std::vector<std::string>& names) {
  names.push_back(link.name);
  for (const urdf::LinkSharedPtr& child : link.child_links) add_link(*child, names);
}

/// The nearest points of two segments have the parameters s, t in [0, 1]: C. Ericson, Real-Time Collision Detection
/// (2005), 5.1.9.
double segment_distance_m(const Capsule& one, const Capsule& other) {
  const Eigen::Vector3d d1 = one.b - one.a, d2 = other.b - other.a, r = one.a - other.a;
  constexpr double kPoint_m2 = 1e-12;
  const double a = d1.squaredNorm(), e = d2.squaredNorm(), f = d2.dot(r);
  double s = 0.0, t = 0.0;
  if (a > kPoint_m2) {
    const double b = d1.dot(d2), c = d1.dot(r), denominator = a * e - b * b;
    if (denominator > kPoint_m2 * a) s = std::clamp((b * f - c * e) / denominator, 0.0, 1.0);
    t = e > kPoint_m2 ? (b * s + f) / e : 0.0;
    const double within = std::clamp(t, 0.0, 1.0);
    if (within != t || e <= kPoint_m2) s = std::clamp((b * within - c) / a, 0.0, 1.0);
    t = within;
  } else if (e > kPoint_m2) {
    t = std::clamp(f / e, 0.0, 1.0);
  }
  return (r + s * d1 - t * d2).norm();
}

}  // namespace

double distance_m(const Capsule& one, const Capsule& other) {
  return segment_distance_m(one, other) - one.radius_m - other.radius_m;
}

LinkCapsules::LinkCapsules(const model::RobotModel& robot, const std::vector<std::string>& links) {
  for (const std::string& name : links) {
    const urdf::LinkConstSharedPtr link = robot.urdf->getLink(name);
    for (const urdf::CollisionSharedPtr& collision : link->collision_array) {
      std::optional<Capsule> capsule = capsule_of(*collision->geometry);
      if (!capsule) continue;
      const Eigen::Isometry3d T = pose_of(collision->origin);
      capsule->a = T * capsule->a;
      capsule->b = T * capsule->b;
      shapes_.push_back({model::chain_between(robot, robot.base_link, name), *capsule});
    }
  }
  capsules_.resize(shapes_.size());
}

const std::vector<Capsule>& LinkCapsules::compute(const JointVector& q) {
  for (std::size_t i = 0; i < shapes_.size(); ++i) {
    Shape& shape = shapes_[i];
    shape.chain.compute(q);
    capsules_[i] = {shape.chain.p() + shape.chain.R() * shape.in_link.a,
                    shape.chain.p() + shape.chain.R() * shape.in_link.b, shape.in_link.radius_m};
  }
  return capsules_;
}

std::vector<std::string> links_below(const model::RobotModel& robot, int joint) {
  std::vector<std::string> names;
  add_link(*robot.urdf->getLink(robot.urdf->getJoint(robot.joint_index.name(joint))->child_link_name), names);
  return names;
}

}  // namespace pmg::retargeting
