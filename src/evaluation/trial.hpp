// One lockstep run of the real controller against one simulated robot, and its measures.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "control/control_setup.hpp"
#include "sil/run_measure.hpp"
#include "sil/scenario.hpp"
#include "sim/world.hpp"
#include "work/progress.hpp"

namespace pmg::evaluation {

/// A policy under evaluation.
struct Candidate {
  std::string name;               ///< name in tables and pages
  control::ControlSetup control;  ///< robot, clips and policy
};

/// Mean absolute errors against the user's command, in the order of the paper's columns.
enum Error { kLinVel, kYawVel, kRollError, kPitchError, kHeightError, kErrors };
using Errors = std::array<double, kErrors>;
inline constexpr std::array<const char*, kErrors> kErrorKeys = {"lin_vel_m_s", "yaw_vel_rad_s", "roll_rad", "pitch_rad",
                                                                "height_m"};
inline constexpr std::array<const char*, kErrors> kErrorNames = {"linear velocity", "yaw velocity", "roll", "pitch",
                                                                 "height"};
inline constexpr std::array<const char*, kErrors> kErrorUnits = {"m/s", "rad/s", "rad", "rad", "m"};

struct TrialResult {
  bool complete = false;  ///< false: interrupted
  bool fell = false;      ///< or the simulation diverged
  double fell_at_s = -1.0;
  std::vector<std::string> faults;            ///< latched ones, in words
  double judged_s = 0.0;                      ///< time over which errors are taken
  Errors errors{};                            ///< over all steps within the clips' reach
  Errors errors_raw{};                        ///< the same, not averaged over a gait period
  std::optional<Errors> errors_beyond_reach;  ///< over the steps beyond the clips' reach
  std::vector<Errors> step_errors;            ///< by step of the scenario; NaN for steps without judged ticks
  double duration_s = 0.0;                    ///< simulated time

  bool survived() const { return complete && !fell && faults.empty(); }
};

/// Called after every tick with the world that the tick has seen. Returns false to end the trial.
using TrialObserver = std::function<bool(const sil::RunProgress&, sim::World&)>;

struct TrialOptions {
  bool gantry = false;        ///< the robot hangs throughout, and nothing is judged
  work::Progress progress{};  ///< asked for interruptions; a trial reports nothing
  TrialObserver observer{};   ///< may be empty
};

/// Plays the scenario without intervention after a fall. From then on velocity and height count as zero and attitude as
/// measured; the same holds for the rest of a diverged simulation. Throws what loading throws.
TrialResult run_trial(const Candidate& candidate, const sil::Scenario& scenario, const sim::WorldOptions& world,
                      const TrialOptions& options);

}  // namespace pmg::evaluation
