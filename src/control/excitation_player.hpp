// Excites one joint of a hanging robot in mode Stand, run after run, while the other joints hold. The loop that walks
// thus records a single-joint response (paper III-C.1).
#pragma once

#include <vector>

#include "hal/command_guard.hpp"
#include "model/robot_model.hpp"

namespace pmg::control {

struct ExcitationRun {
  std::vector<double> q_cmd_rad;  ///< one a tick
  double kp_Nm_per_rad = 0.0, kd_Nm_s_per_rad = 0.0;
};

struct ExcitationPlan {
  int joint = -1;  ///< in joint order
  std::vector<ExcitationRun> runs;
  double approach_rad_s = 0.5;  ///< to where a run begins, and back at the end
  double settle_s = 1.0;        ///< at rest before a run is recorded
};

/// The run and the sample that a tick's command belongs to.
struct ExcitationProgress {
  int run = -1, sample = -1;  ///< -1: on the way between runs
  bool over = false;          ///< all runs were played, or the play was given up
  bool given_up = false;      ///< the robot left Stand; the player doesn't resume
};

/// Throws std::invalid_argument when a command leaves the joint's range, a gain exceeds what the bus guard lets pass,
/// or there is no run.
void check(const ExcitationPlan& plan, const model::RobotModel& robot, const hal::GuardOptions& guard = {});

class ExcitationPlayer {
 public:
  struct Told {
    double q_rad, kp_Nm_per_rad, kd_Nm_s_per_rad;
  };

  /// rest: where the joint stands before and after, and with what gains. Throws as check().
  ExcitationPlayer(const ExcitationPlan& plan, const model::RobotModel& robot, const Told& rest, double dt_s,
                   const hal::GuardOptions& guard = {});

  int joint() const noexcept { return plan_.joint; }
  const Told& step() noexcept;  ///< the command of the next tick; the rest posture when all is over
  void give_up() noexcept;      ///< ends the play; no effect before its first step and after its end
  const ExcitationProgress& progress() const noexcept { return progress_; }

  double duration_s() const;  ///< from the first step to the end

 private:
  enum class Phase { kApproach, kSettle, kPlay, kReturn, kOver };
  double approach_s(double from_rad, double to_rad) const noexcept;
  void approach(std::size_t run) noexcept;
  void play() noexcept;
  bool travelled() noexcept;

  ExcitationPlan plan_;
  Told rest_, told_;
  double dt_s_;
  ExcitationProgress progress_;
  bool begun_ = false;
  Phase phase_ = Phase::kApproach;
  std::size_t run_ = 0;
  double from_rad_ = 0.0, to_rad_ = 0.0, travel_s_ = 0.0, elapsed_s_ = 0.0;
};

}  // namespace pmg::control
