// Periods of samples and holds. Rollouts are not smooth in them, so they are searched on a grid and not fitted.
#pragma once

#include <string>
#include <vector>

#include "effects/nested_fit.hpp"

namespace pmg::effects {

constexpr std::size_t kRunsForPeriods = 6;  ///< some hundred periods are tried on so many runs

/// True for a period that is searched: of a drive's output, of its commands, of its readings.
bool is_period(const std::string& parameter);

/// (model without a hold, the form's parameter) => (the most promising periods between these limits, the best first
/// [s]). A wrong period P + dP is out of step after a time t = P^2 / (4 dP), so a whole run of length T shows a period
/// only on a grid as fine as P / (4 T), of which there would be a thousand values. So the beginnings of runs, some
/// periods long, are searched first on a coarse grid, and the best periods again on twice as long a beginning and half
/// the grid, until the runs end. Costs about as much as fifty rollouts of every run, whatever the runs' length.
std::vector<double> promising_periods_s(const NestedFit& fit, const calib::JointModel& model,
                                        const std::string& parameter, double low_s, double high_s);

/// (model with a period) => (the period nearby with the lowest squares, the other parameters as they are [s]). Looks up
/// to four percent to both sides, finer near the best. Costs about twelve rollouts of every run.
double best_period_s(const NestedFit& fit, const calib::JointModel& model, const std::string& parameter);

struct PeriodRange {
  double low_s, high_s;
};

/// (fitted model with a period) => (the nearest periods to both sides, on a grid of a percent to a half, at which the
/// runs are explained worse by so many standard deviations over blocks, also where the other unknowns are fitted beside
/// them, with the model's Jacobian). Costs that and up to sixteen fits of four iterations.
PeriodRange period_range(const NestedFit& fit, const NestedModel& model, const std::string& parameter,
                         double noise_squares, double deviations);

}  // namespace pmg::effects
