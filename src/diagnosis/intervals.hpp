// How sure a diagnosis is of its numbers.
#pragma once

#include <vector>

#include "diagnosis/diagnosis.hpp"
#include "diagnosis/options.hpp"
#include "effects/folds.hpp"

namespace pmg::diagnosis {

/// (linearised model, folds, mean square of the noise [rad^2]) => (95 % intervals of the unknowns, in their units and
/// order): x +- 1.96 sqrt(v), then 4 % of the value to each side. v is the larger of the jackknife's variance over the
/// folds and of the sum of: the cluster-robust variance; the variance of unknowns at an edge of their range, which may
/// be anywhere in it (range^2 / 12, through the correlations); and 1 % of the squares beyond the noise, for a model
/// whose form isn't right and so pulls all blocks the same way.
std::vector<evidence::Interval> parameter_intervals(const effects::NestedModel& model,
                                                    const std::vector<fitting::Fold>& folds, double noise_squares,
                                                    const JointDiagnosisOptions& options = {});

/// Mean absolute errors of the runs at two models, with 95 % intervals by a bootstrap over blocks that draws the same
/// blocks for both.
struct HeldOutErrors {
  evidence::Interval before, after;
};
HeldOutErrors held_out_errors(const effects::NestedFit& runs, const calib::JointModel& before,
                              const calib::JointModel& after, unsigned seed);

}  // namespace pmg::diagnosis
