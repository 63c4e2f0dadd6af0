// One run of the real controller against one simulated robot, in lockstep, and what it measured.
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

namespace pmg::evaluation {

/// A policy under evaluation.
struct Candidate {
  std::string name;               ///< as shown
  control::ControlSetup control;  ///< robot, clips and policy
};

/// Mean absolute errors against the user's command, in the paper's order of columns.
enum Error { kLinVel, kYawVel, kRollError, kPitchError, kHeightError, kErrors };
using Errors = std::array<double, kErrors>;
inline constexpr std::array<const char*, kErrors> kErrorKeys = {"lin_vel_m_s", "yaw_vel_rad_s", "roll_rad", "pitch_rad",
                                                                "height_m"};
inline constexpr std::array<const char*, kErrors> kErrorNames = {"linear velocity", "yaw velocity", "roll", "pitch",
                                                                 "height"};
inline constexpr std::array<const char*, kErrors> kErrorUnits = {"m/s", "rad/s", "rad", "rad", "m"};

struct TrialResult {
  bool complete = false;  ///< false: it was interrupted
  bool fell = false;      ///< or the simulation diverged
  double fell_at_s = -1.0;
  std::vector<std::string> faults;            ///< that latched, in words
  double judged_s = 0.0;                      ///< over which errors were taken
  Errors errors{};                            ///< over the steps that aren't beyond reach
  Errors errors_raw{};                        ///< the same, velocities not averaged over a gait period
  std::optional<Errors> errors_beyond_reach;  ///< over the steps that are
  std::vector<Errors> step_errors;            ///< by step of the scenario; NaN for one that wasn't judged
  double duration_s = 0.0;                    ///< simulated

  bool survived() const { return complete && !fell && faults.empty(); }
};

/// Who looks on: after every tick, when the world shows what the tick saw. Returns false to end the trial there.
using TrialObserver = std::function<bool(const sil::RunProgress&, sim::World&)>;

struct TrialOptions {
  bool gantry = false;                ///< the robot hangs in it throughout, and nothing is judged
  std::function<bool()> interrupted;  ///< may be empty
  TrialObserver observer;             ///< may be empty
};

/// Plays the scenario. Nobody intervenes after a fall: it runs to the end, velocity and height count as zero and
/// attitude as measured, and so for the rest of a simulation that diverged. Throws what loading throws.
TrialResult run_trial(const Candidate& candidate, const sil::Scenario& scenario, const sim::WorldOptions& world,
                      const TrialOptions& options);

}  // namespace pmg::evaluation
