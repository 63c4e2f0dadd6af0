// A film of a lockstep run.
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
  /// Keeps a reference to world. Throws std::runtime_error without ffmpeg or OSMesa.
  Film(sim::World& world, const std::filesystem::path& file);

  void after_tick(const RunProgress& progress);
  void close();
  const std::string& failure() const noexcept { return failure_; }  ///< one line; empty: all is well

 private:
  static constexpr int kFramesPerSecond = 25;
  static constexpr int kTicksPerFrame = 4;

  void shoot(const RunProgress& progress);

  sim::World& world_;
  sim::Renderer renderer_;
  sim::VideoWriter writer_;
  std::int64_t ticks_ = 0;
  std::string failure_;
};

}  // namespace pmg::sil
