// The collision shapes of a robot's links, from its URDF, and which of them an arm must keep clear of.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "arms/clearance.hpp"
#include "model/robot_model.hpp"

namespace pmg::arms {

using Shape = std::variant<Capsule, Box>;

/// One collision shape, in its link's frame.
struct LinkShape {
  std::string link;
  Shape shape;
};

/// (robot) => (all collision shapes). A cylinder becomes the capsule around it, whose axis is the cylinder's. Throws
/// std::invalid_argument on a mesh.
std::vector<LinkShape> link_shapes(const model::RobotModel& robot);

/// (shape in a link's frame, the link's pose) => (shape there).
Shape moved(const Shape& shape, const Eigen::Isometry3d& pose) noexcept;

/// A link of an arm is a capsule, too: the one along a box's longest side, around the box.
Capsule capsule_around(const Shape& shape) noexcept;

Clearance clearance(const Capsule& capsule, const Shape& other) noexcept;

/// The middle of a shape and the distance of its farthest point from there.
struct Ball {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius_m = 0.0;
};
Ball ball_around(const Shape& shape) noexcept;

}  // namespace pmg::arms
