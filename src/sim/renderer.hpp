// Pictures of a world without a display: MuJoCo's renderer on OSMesa.
#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/scene.hpp"
#include "sim/world.hpp"

namespace pmg::sim {

/// Fixed to a body B. Its frame C has x along the line of sight and z up in the picture.
struct MountedCamera {
  std::string body;
  Eigen::Isometry3d T_BC = Eigen::Isometry3d::Identity();
  double half_height_rad = 0.0;  ///< from the middle of a picture to its upper edge
};

struct RendererOptions {
  int width = 1280, height = 720;  ///< at most the size of the model's off-screen buffer
  double distance_m = 2.9;         ///< from the camera to its target
  double azimuth_deg = 216.0;      ///< of the line of sight about z: from the robot's front and left at yaw 0
  double elevation_deg = -9.0;
  double follow_s = 0.4;                   ///< time constant with which the camera follows the robot
  std::optional<MountedCamera> mounted{};  ///< in place of the camera that follows
};

/// A renderer belongs to the thread that made it.
class Renderer {
 public:
  /// Throws std::runtime_error if OSMesa gives no context, or the model lacks the camera's body.
  explicit Renderer(const mjModel* model, const RendererOptions& options = {});
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// width * height RGB triples, from the top left. The camera follows body 1, the robot's base, unless it is
  /// mounted. The text is drawn over
  /// the picture's top left corner.
  const std::vector<std::uint8_t>& render(mjData* data, const std::string& text = "",
                                          const std::optional<Rope>& rope = std::nullopt,
                                          std::span<const Bar> bars = {});

  /// Turns the camera that follows to this azimuth, on the shorter way, as softly as it follows.
  void look_from(double azimuth_deg);

  int width() const;
  int height() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pmg::sim
