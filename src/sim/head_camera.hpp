// The camera in a simulated robot's head: what an operator far away sees by.
#pragma once

#include <Eigen/Geometry>
#include <string>

#include "sim/renderer.hpp"

namespace pmg::sim {

/// ASSUMPTIONS: Z1's camera isn't known. A wide one between the eyes that looks 45 degrees down and doesn't turn with
/// the head.
struct HeadCamera {
  Eigen::Vector3d p_TC_m{0.08, 0.0, 0.50};  ///< its place in the torso's frame
  double down_rad = 0.785;
  double half_angle_rad = 1.05;  ///< of the cone that it sees: from the middle of a picture to its corners
};

/// The camera for pictures of this size.
MountedCamera mounted(const HeadCamera& camera, const std::string& torso_link, int width, int height);

}  // namespace pmg::sim
