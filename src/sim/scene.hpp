// The shapes in a picture of a world, for every renderer.
#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>

#include "sim/world.hpp"

namespace pmg::sim {

/// A round bar that is only seen: a line of a stick figure.
struct Bar {
  Eigen::Vector3d from_W = Eigen::Vector3d::Zero(), to_W = Eigen::Vector3d::Zero();  ///< [m]
  double radius_m = 0.01;
  std::array<float, 4> colour = {0.1F, 0.1F, 0.1F, 1.0F};
};

class Scene {
 public:
  static constexpr int kBaseBody = 1;  ///< the robot's base; body 0 is the world

  explicit Scene(const mjModel* model);
  ~Scene();
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  /// The floor, the robot's visual shapes, the gantry's rope and the bars, as the camera sees them.
  mjvScene& update(mjData* data, mjvCamera& camera, const std::optional<Rope>& rope, std::span<const Bar> bars = {});
  mjvScene& last() { return scene_; }

 private:
  void add(const Bar& bar);

  const mjModel* model_;
  mjvOption visible_{};
  mjvScene scene_{};
};

}  // namespace pmg::sim
