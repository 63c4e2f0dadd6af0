// URDF poses, inertias and shapes as MJCF attributes.
#pragma once

#include <urdf_model/link.h>
#include <urdf_model/pose.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>

namespace pmg::sim {

/// `pos="x y z" quat="w x y z"`; the printed numbers read back exactly.
std::string pose_attributes(const Eigen::Isometry3d& T);
Eigen::Isometry3d isometry(const urdf::Pose& pose);

/// The whole <inertial .../> element. A full inertia matrix becomes its principal axes and moments.
std::string inertial_element(const urdf::Inertial& inertial);

/// `type="..." size="..."`; nothing for a mesh.
std::optional<std::string> visual_shape(const urdf::Geometry& geometry);

/// The same for collisions, with a capsule inside each cylinder: MuJoCo's capsules collide in closed form and have no
/// edges that catch.
std::optional<std::string> collision_shape(const urdf::Geometry& geometry);

}  // namespace pmg::sim
