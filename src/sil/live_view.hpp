// A window on a run, while it lasts.
#pragma once

#include <chrono>
#include <mutex>
#include <string>

#include "sil/run_measure.hpp"
#include "sil/simulated_robot.hpp"
#include "sim/viewer.hpp"
#include "sim/world.hpp"

namespace pmg::sil {

/// Made and used by the main thread, but for note().
class LiveView {
 public:
  /// Keeps references. Throws std::runtime_error when no window can be opened.
  LiveView(sim::World& world, const model::RobotModel& robot);

  /// Of a lockstep run: shows the world, some fifty times a second, and waits so that the run keeps to real time.
  void after_tick(const RunProgress& progress);

  /// Of a run in threads: what the window says from now on. Not for a real-time thread; any other.
  void note(const RunProgress& progress);
  /// Likewise: one frame of where the robot is.
  void draw(SimulatedRobot& robot);

  bool closed() const { return viewer_.closed(); }

 private:
  std::string text(const RunProgress& progress) const;

  sim::World& world_;
  const model::RobotModel& robot_;
  sim::Viewer viewer_;
  std::chrono::steady_clock::time_point start_{}, last_frame_{};
  double start_s_ = -1.0;  // of the run's time; negative: not yet begun
  std::int64_t ticks_ = 0;
  PoseSample pose_;
  std::mutex mutex_;
  std::string noted_;
};

}  // namespace pmg::sil
