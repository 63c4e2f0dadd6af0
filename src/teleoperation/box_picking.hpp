// The box-picking task (the paper's IV-D): two palms lift a box from a low table, and the robot carries it to a higher
// one.
#pragma once

#include <cstdint>
#include <optional>

#include "evaluation/trial.hpp"
#include "teleoperation/task.hpp"

namespace pmg::teleoperation {

/// Heights and sizes [m] and kilograms. The paper tells the box's width, both tables' heights and how far the box is
/// moved. ASSUMPTIONS: everything else, that the tables stand side by side, and that they have no legs.
struct BoxPlan {
  static constexpr double kLowTop_m = 0.50, kHighTop_m = 0.76, kApart_m = 0.60;
  static constexpr double kTableDepth_m = 0.40, kLowLength_m = 0.50, kHighLength_m = 0.46, kTableThickness_m = 0.03;
  static constexpr double kWidth_m = 0.34, kDepth_m = 0.24, kHeight_m = 0.24, kMass_kg = 1.0, kFriction = 0.4;
  static constexpr double kLongest_s = 120.0;

  bool to_left = true;    ///< the higher table stands to the left of the lower one
  double edge_m = 0.0;    ///< from the robot's base to the front edges at the beginning
  double beside_m = 0.0;  ///< of the robot to the left of the lower table's middle
  double along_m = 0.0;   ///< of the box to the left of it
  double deep_m = 0.0;    ///< of the box's front face behind the front edge
  double yaw_rad = 0.0;   ///< of the box
  std::uint64_t seed = 0;

  static BoxPlan of(std::uint64_t trial);
};

/// What a judge sees of the box. T_WB: of its middle.
struct BoxState {
  Eigen::Isometry3d T_WB = Eigen::Isometry3d::Identity();
  bool held = false;  ///< a palm touches it
};

/// Done: the box was lifted by at least kLifted_m (0.30 less a tenth) and stands on the higher table at least kMoved_m
/// (0.60 less a tenth) from where it was, upright, its middle over the table, at rest for kRest_s and touched by no
/// palm. Dropped, at once and for good: it falls faster than after a free fall of 13 mm, or tips over.
class BoxJudge {
 public:
  static constexpr double kLifted_m = 0.27, kMoved_m = 0.54, kRest_s = 1.0;
  static constexpr double kFall_m_s = 0.5, kTipped_rad = 0.6;
  static constexpr double kUpright_rad = 0.05, kOnTop_m = 0.01, kStill_m_s = 0.02;

  /// T_WE: of the higher table's middle.
  BoxJudge(const BoxState& start, const Eigen::Isometry3d& T_WE) : start_(start), last_(start), T_WE_(T_WE) {}

  /// dt_s after the last look.
  std::optional<End> look(const BoxState& box, double dt_s) noexcept;
  double lifted_m() const noexcept { return lifted_m_; }  ///< at most, until now
  double moved_m() const noexcept;                        ///< horizontally, now
  End time_up() const noexcept { return lifted_m_ >= kLifted_m ? End::kNotPutDown : End::kNotLifted; }

 private:
  bool stands(const BoxState& box, double speed_m_s) const noexcept;

  BoxState start_, last_;
  Eigen::Isometry3d T_WE_;
  double lifted_m_ = 0.0, rested_s_ = 0.0;
};

/// world: the simulated robot's; the task's things are added. Throws what loading throws.
TaskResult run_box_picking(const evaluation::Candidate& candidate, sim::WorldOptions world, const BoxPlan& plan,
                           const work::Progress& progress = {}, const TaskObserver& observer = {});

}  // namespace pmg::teleoperation
