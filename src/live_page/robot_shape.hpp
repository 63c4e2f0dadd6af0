// A robot's links, joints and visual shapes for a page to draw.
#pragma once

#include <string>

#include "model/robot_model.hpp"

namespace pmg::live_page {

/// JSON: an array of links, each behind its parent, the base link first:
///   {"parent": index or -1, "at": T, "axis": [x, y, z], "joint": index in the joints' order or -1, "shapes": [SHAPE]},
///   SHAPE: {"box": [x, y, z]}, {"cylinder": [radius, length]} or {"sphere": radius} [m], with "at": T.
/// T: 12 numbers, the rows of a 3 x 4 matrix: of the link's joint in its parent, of the shape in its link. Meshes are
/// left out.
std::string robot_shape(const model::RobotModel& robot);

}  // namespace pmg::live_page
