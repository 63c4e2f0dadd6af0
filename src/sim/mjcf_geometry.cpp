#include "sim/mjcf_geometry.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace pmg::sim {

namespace {

std::string sphere(double radius) { return fmt::format(R"(type="sphere" size="{}")", radius); }

std::optional<std::string> box_or_sphere(const urdf::Geometry& geometry) {
  if (geometry.type == urdf::Geometry::SPHERE) return sphere(dynamic_cast<const urdf::Sphere&>(geometry).radius);
  if (geometry.type != urdf::Geometry::BOX) return std::nullopt;
  const urdf::Vector3& size = dynamic_cast<const urdf::Box&>(geometry).dim;
  return fmt::format(R"(type="box" size="{} {} {}")", size.x / 2.0, size.y / 2.0, size.z / 2.0);
}

}  // namespace

Eigen::Isometry3d isometry(const urdf::Pose& pose) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() << pose.position.x, pose.position.y, pose.position.z;
  const urdf::Rotation& r = pose.rotation;
  T.linear() = Eigen::Quaterniond(r.w, r.x, r.y, r.z).normalized().toRotationMatrix();
  return T;
}

std::string pose_attributes(const Eigen::Isometry3d& T) {
  const Eigen::Vector3d p = T.translation();
  const Eigen::Quaterniond q(T.linear());
  std::string attributes = fmt::format(R"(pos="{} {} {}")", p.x(), p.y(), p.z());
  if (q.vec().isZero(0.0)) return attributes;  // shorter text for an unrotated pose
  return attributes + fmt::format(R"( quat="{} {} {} {}")", q.w(), q.x(), q.y(), q.z());
}

std::string inertial_element(const urdf::Inertial& inertial) {
  Eigen::Matrix3d I;
  I << inertial.ixx, inertial.ixy, inertial.ixz,  //
      inertial.ixy, inertial.iyy, inertial.iyz,   //
      inertial.ixz, inertial.iyz, inertial.izz;
  Eigen::Isometry3d T = isometry(inertial.origin);
  Eigen::Vector3d principal = I.diagonal();
  if (!I.isDiagonal(0.0)) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(I);
    principal = solver.eigenvalues();
    Eigen::Matrix3d axes = solver.eigenvectors();
    if (axes.determinant() < 0.0) axes.col(2) *= -1.0;
    T.linear() = T.linear() * axes;
  }
  return fmt::format(R"(<inertial mass="{}" {} diaginertia="{} {} {}"/>)", inertial.mass, pose_attributes(T),
                     principal.x(), principal.y(), principal.z());
}

std::optional<std::string> visual_shape(const urdf::Geometry& geometry) {
  if (geometry.type != urdf::Geometry::CYLINDER) return box_or_sphere(geometry);
  const auto& cylinder = dynamic_cast<const urdf::Cylinder&>(geometry);
  return fmt::format(R"(type="cylinder" size="{} {}")", cylinder.radius, cylinder.length / 2.0);
}

std::optional<std::string> collision_shape(const urdf::Geometry& geometry) {
  if (geometry.type != urdf::Geometry::CYLINDER) return box_or_sphere(geometry);
  const auto& cylinder = dynamic_cast<const urdf::Cylinder&>(geometry);
  const double half_segment = cylinder.length / 2.0 - cylinder.radius;
  if (half_segment <= 0.0) return sphere(std::min(cylinder.radius, cylinder.length / 2.0));
  return fmt::format(R"(type="capsule" size="{} {}")", cylinder.radius, half_segment);
}

}  // namespace pmg::sim
