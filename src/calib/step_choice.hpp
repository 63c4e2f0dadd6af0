// The integrator's error in rollouts of a joint, and the simulation step that it asks for.
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "calib/single_joint.hpp"
#include "work/threshold.hpp"

namespace pmg::calib {

struct StepOptions {
  work::Threshold share_of_noise{0.5, "",
                                 "an integration error of this share of residual or noise adds a quarter to its mean "
                                 "square; a residual counts as unexplained from several times the noise's on",
                                 "arithmetic"};
  work::Threshold finest_share{0.125, "", "of the first step: three halvings, eight times the time of a rollout",
                               "time of a diagnosis"};
  work::CountThreshold most_steps{
      100000, "",
      "steps of all searched runs together: a finer step than this takes counts into the noise floor instead",
      "time of a diagnosis"};

  PMG_THRESHOLDS(share_of_noise, finest_share, most_steps)
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

enum class StepLimit { kError, kResidual, kCost, kGiven };
const char* name(StepLimit limit);

struct ChosenStep {
  IntegrationError error;               ///< of the step chosen
  IntegrationError first;               ///< of the step that the runs had
  StepLimit limit = StepLimit::kError;  ///< what ended the choice
};

/// A model fitted at one step, and its usual residual: the geometric mean over blocks of the mean squares [rad^2].
struct FittedAtStep {
  JointModel model;
  double usual_squares = 0.0;
};
using FitAtStep = std::function<FittedAtStep(const std::vector<SingleJoint>& runs, const JointModel& start)>;

/// (bench, runs, model, rms noise floor, refit) => (step; the model becomes the one fitted at it). Halves the runs'
/// step until its error is at most share_of_noise of the residual, or of the floor if that is larger. An error that is
/// small beside the residual of a model without effects decides nothing. Stops before where
///  - the model fitted at half the step has no lower residual: what was recorded then is no finer than this step (a
///    simulation);
///  - the step would be below finest_share of the first, or the runs together would take more than most_steps.
ChosenStep chosen_step(const bench::Bench& bench, const std::vector<SingleJoint>& runs, JointModel& model,
                       double noise_rms_rad, const FitAtStep& refit, const StepOptions& options, unsigned threads);

/// The same runs with another simulation step.
std::vector<SingleJoint> with_step(const bench::Bench& bench, const std::vector<SingleJoint>& runs, double step_s);

}  // namespace pmg::calib
