// The integrator's error in rollouts of a joint, and the simulation step that it asks for.
#pragma once

#include <vector>

#include "calib/single_joint.hpp"

namespace pmg::calib {

/// evidence::listed() gives the reason of each threshold.
struct StepOptions {
  double share_of_noise = 0.25, finest_share = 0.125, most_steps = 2e5;
};

/// Error of one step size: of each run, and of the usual one.
struct IntegrationError {
  double step_s = 0.0;
  double rms_rad = 0.0;            ///< median over the runs: a run that sticks in one rollout only doesn't decide
  std::vector<double> of_run_rad;  ///< rms of each run
};

/// (bench, runs at their step h, model) => (error of h), 2 rms(reading(h) - reading(h / 2)): semi-implicit Euler is of
/// first order, so half the step leaves half the error. Infinite where the model can't be simulated with half the step.
/// Costs two rollouts of every run, one of them with half the step.
IntegrationError integration_error(const bench::Bench& bench, const std::vector<SingleJoint>& runs,
                                   const JointModel& model, unsigned threads);

enum class StepLimit { kError, kCost, kGiven };
const char* name(StepLimit limit);

struct ChosenStep {
  IntegrationError error;               ///< of the step chosen
  IntegrationError first;               ///< of the step that the runs had
  StepLimit limit = StepLimit::kError;  ///< what ended the choice: the error is small, or a finer step costs too much
};

/// (bench, runs, model, rms noise floor) => (step). Halves the runs' step until its error is at most share_of_noise of
/// the floor, but not below finest_share of the first step, nor where the runs together would take more than
/// most_steps.
ChosenStep chosen_step(const bench::Bench& bench, const std::vector<SingleJoint>& runs, const JointModel& model,
                       double noise_rms_rad, const StepOptions& options, unsigned threads);

/// The same runs with another simulation step.
std::vector<SingleJoint> with_step(const bench::Bench& bench, const std::vector<SingleJoint>& runs, double step_s);

}  // namespace pmg::calib
