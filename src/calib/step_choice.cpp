#include "calib/step_choice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "fitting/statistics.hpp"
#include "work/parallel.hpp"

namespace pmg::calib {

const char* name(StepLimit limit) {
  switch (limit) {
    case StepLimit::kError:
      return "its error is small beside what a model without causes misses, or beside noise";
    case StepLimit::kResidual:
      return "a finer step leaves no lower residual";
    case StepLimit::kCost:
      return "a finer step would cost too much";
    case StepLimit::kGiven:
      break;
  }
  return "it was given";
}

std::vector<SingleJoint> with_step(const bench::Bench& bench, const std::vector<SingleJoint>& runs, double step_s) {
  std::vector<SingleJoint> found;
  for (const SingleJoint& joint : runs) found.emplace_back(bench, joint.run(), step_s);
  return found;
}

IntegrationError integration_error(const bench::Bench& bench, const std::vector<SingleJoint>& runs,
                                   const JointModel& model, unsigned threads) {
  IntegrationError found{.step_s = runs.front().step_s(), .of_run_rad = std::vector<double>(runs.size())};
  try {
    work::for_each_in_parallel(runs.size(), threads, [&](std::size_t i) {
      const std::vector<double> coarse = runs[i].rollout(model);
      const std::vector<double> fine = SingleJoint(bench, runs[i].run(), 0.5 * found.step_s).rollout(model);
      double squares = 0.0;
      for (std::size_t k = 0; k < coarse.size(); ++k) squares += std::pow(coarse[k] - fine[k], 2);
      found.of_run_rad[i] = 2.0 * std::sqrt(squares / static_cast<double>(coarse.size()));
    });
    found.rms_rad = fitting::median(found.of_run_rad);
  } catch (const std::invalid_argument&) {
    found.rms_rad = std::numeric_limits<double>::infinity();
  }
  return found;
}

ChosenStep chosen_step(const bench::Bench& bench, const std::vector<SingleJoint>& runs, JointModel& model,
                       double noise_rms_rad, const FitAtStep& refit, const StepOptions& options, unsigned threads) {
  ChosenStep chosen;
  chosen.first = chosen.error = integration_error(bench, runs, model, threads);
  double steps = 0.0, usual_squares = refit(runs, model).usual_squares;
  for (const SingleJoint& joint : runs) steps += static_cast<double>(joint.steps());
  while (chosen.error.rms_rad >
         options.share_of_noise * std::sqrt(std::max(usual_squares, noise_rms_rad * noise_rms_rad))) {
    const double half_s = 0.5 * chosen.error.step_s;
    steps *= 2.0;
    if (steps > options.most_steps || half_s < (1.0 - 1e-9) * options.finest_share * chosen.first.step_s) {
      chosen.limit = StepLimit::kCost;
      break;
    }
    const std::vector<SingleJoint> finer = with_step(bench, runs, half_s);
    const FittedAtStep there = refit(finer, model);
    if (!(there.usual_squares < usual_squares)) {
      chosen.limit = StepLimit::kResidual;
      break;
    }
    model = there.model;
    usual_squares = there.usual_squares;
    chosen.error = integration_error(bench, finer, model, threads);
  }
  return chosen;
}

}  // namespace pmg::calib
