#include "sim/head_camera.hpp"

#include <cmath>

namespace pmg::sim {

MountedCamera mounted(const HeadCamera& camera, const std::string& torso_link, int width, int height) {
  Eigen::Isometry3d T_TC = Eigen::Isometry3d::Identity();
  T_TC.translation() = camera.p_TC_m;
  T_TC.linear() = Eigen::AngleAxisd(camera.down_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const double corner = std::hypot(width, height);
  return {.body = torso_link,
          .T_BC = T_TC,
          .half_height_rad = std::atan(std::tan(camera.half_angle_rad) * height / corner)};
}

}  // namespace pmg::sim
