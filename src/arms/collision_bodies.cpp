#include "arms/collision_bodies.hpp"

#include <fmt/format.h>

#include <memory>
#include <stdexcept>

namespace pmg::arms {

namespace {

Eigen::Isometry3d isometry(const urdf::Pose& pose) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = Eigen::Vector3d(pose.position.x, pose.position.y, pose.position.z);
  T.linear() =
      Eigen::Quaterniond(pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z).toRotationMatrix();
  return T;
}

Shape shape_of(const urdf::Collision& collision, const std::string& link) {
  const Eigen::Isometry3d T = isometry(collision.origin);
  const urdf::Geometry& geometry = *collision.geometry;
  if (geometry.type == urdf::Geometry::SPHERE) {
    return Capsule{T.translation(), T.translation(), dynamic_cast<const urdf::Sphere&>(geometry).radius};
  }
  if (geometry.type == urdf::Geometry::CYLINDER) {
    const auto& cylinder = dynamic_cast<const urdf::Cylinder&>(geometry);
    const Eigen::Vector3d half = 0.5 * cylinder.length * Eigen::Vector3d::UnitZ();
    return Capsule{T * -half, T * half, cylinder.radius};
  }
  if (geometry.type == urdf::Geometry::BOX) {
    const auto& box = dynamic_cast<const urdf::Box&>(geometry);
    return Box{T, 0.5 * Eigen::Vector3d(box.dim.x, box.dim.y, box.dim.z)};
  }
  throw std::invalid_argument(fmt::format("link {}: collision by a mesh; expected box, cylinder or sphere", link));
}

}  // namespace

std::vector<LinkShape> link_shapes(const model::RobotModel& robot) {
  std::vector<LinkShape> shapes;
  for (const auto& [name, link] : robot.urdf->links_) {
    for (const auto& collision : link->collision_array) shapes.push_back({name, shape_of(*collision, name)});
  }
  return shapes;
}

Shape moved(const Shape& shape, const Eigen::Isometry3d& pose) noexcept {
  if (const auto* capsule = std::get_if<Capsule>(&shape))
    return Capsule{pose * capsule->a, pose * capsule->b, capsule->radius_m};
  const auto& box = *std::get_if<Box>(&shape);
  return Box{pose * box.pose, box.half_m};
}

Capsule capsule_around(const Shape& shape) noexcept {
  if (const auto* capsule = std::get_if<Capsule>(&shape)) return *capsule;
  const auto& box = *std::get_if<Box>(&shape);
  Eigen::Index longest = 0;
  box.half_m.maxCoeff(&longest);
  Eigen::Vector3d along = Eigen::Vector3d::Zero(), across = box.half_m;
  along[longest] = box.half_m[longest];
  across[longest] = 0.0;
  return {box.pose * Eigen::Vector3d(-along), box.pose * along, across.norm()};
}

Clearance clearance(const Capsule& capsule, const Shape& other) noexcept {
  if (const auto* theirs = std::get_if<Capsule>(&other)) return clearance(capsule, *theirs);
  return clearance(capsule, *std::get_if<Box>(&other));
}

Ball ball_around(const Shape& shape) noexcept {
  if (const auto* capsule = std::get_if<Capsule>(&shape)) {
    return {0.5 * (capsule->a + capsule->b), 0.5 * (capsule->b - capsule->a).norm() + capsule->radius_m};
  }
  const auto& box = *std::get_if<Box>(&shape);
  return {box.pose.translation(), box.half_m.norm()};
}

}  // namespace pmg::arms
