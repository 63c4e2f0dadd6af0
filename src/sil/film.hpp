// A film of a run in lockstep, of whatever plays it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "sil/run_measure.hpp"
#include "sim/renderer.hpp"
#include "sim/video_writer.hpp"
#include "sim/world.hpp"

namespace pmg::sil {

/// Every fourth tick a picture: 25 a second of simulation, of a size that a CPU draws in a few minutes. A film that
/// fails on the way (ffmpeg dies, the disk is full) ends there and says why; the run that it shows goes on.
class Film {
 public:
  static constexpr double kElevation_deg = -9.0;  ///< of the line of sight

  /// Keeps a reference to world. Throws std::runtime_error without ffmpeg or OSMesa.
  Film(sim::World& world, const std::filesystem::path& file, double elevation_deg = kElevation_deg);

  void after_tick(const RunProgress& progress);
  void after_tick(const std::string& words);  ///< which stand in the picture, below the time
  void close();
  const std::string& failure() const noexcept { return failure_; }  ///< one line; empty: all is well

 private:
  static constexpr int kFramesPerSecond = 25;
  static constexpr int kTicksPerFrame = 4;

  bool due() noexcept;
  void face(const ScenarioStep& step);  ///< turns the camera to where the step's motion is seen
  void shoot(double time_s, const std::string& words);

  sim::World& world_;
  sim::Renderer renderer_;
  sim::VideoWriter writer_;
  std::int64_t ticks_ = 0;
  const ScenarioStep* step_ = nullptr;  ///< that the camera faces
  std::string failure_;
};

}  // namespace pmg::sil
