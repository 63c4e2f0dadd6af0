// The wiping task (the paper's IV-D): one hand moves a towel sideways across a table, the robot stepping along.
#pragma once

#include <cstdint>
#include <optional>

#include "evaluation/trial.hpp"
#include "teleoperation/task.hpp"

namespace pmg::teleoperation {

/// Heights and sizes [m] and kilograms. The towel is a stiff patch: a cloth's folds and its hanging edges are left out.
/// ASSUMPTIONS: the table's height and depth, and the towel's size and its friction on the table, which the paper
/// doesn't tell.
struct WipingPlan {
  static constexpr double kTableTop_m = 0.76, kTableDepth_m = 0.50, kTableLength_m = 2.4;
  static constexpr double kTowelMass_kg = 0.2, kTowelFriction = 0.3, kTowelLength_m = 0.20, kTowelThickness_m = 0.02;
  static constexpr double kMoved_m = 1.0;  ///< required, along the table
  static constexpr double kLongest_s = 180.0;

  bool from_left = true;  ///< the towel lies near the table's left end, and moves right
  double along_m = 0.0, deep_m = 0.0, towel_yaw_rad = 0.0;  ///< the towel's place from that end and from the front edge
  double edge_m = 0.0;    ///< from the robot's base to the front edge at the beginning
  double beside_m = 0.0;  ///< of the robot to the left of the towel
  std::uint64_t seed = 0;

  static WipingPlan of(std::uint64_t trial);
};

/// What the judge says of a towel that lies there; nothing: go on. The criterion: moved along the table by more than
/// kMoved_m, while it lay on the table all the time.
std::optional<End> judge_towel(const Eigen::Vector3d& towel_E_m, double moved_m) noexcept;

/// world: the simulated robot's; the task's things are added. Throws what loading throws.
TaskResult run_wiping(const evaluation::Candidate& candidate, sim::WorldOptions world, const WipingPlan& plan,
                      const work::Progress& progress = {}, const TaskObserver& observer = {});

}  // namespace pmg::teleoperation
