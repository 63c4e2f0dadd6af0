// 95 % intervals of a diagnosis' parameters and errors.
#pragma once

#include <vector>

#include "diagnosis/diagnosis.hpp"
#include "diagnosis/options.hpp"
#include "effects/folds.hpp"

namespace pmg::diagnosis {

/// (linearised model, folds, mean square of the noise [rad^2]) => (95 % intervals of the unknowns, in their units and
/// order): x +- 1.96 sqrt(v), then 4 % of the value to each side. v is the larger of the jackknife's variance over the
/// folds and of a sum of three: the cluster-robust variance; the variance due to unknowns with a tolerance that ended
/// at its bound, uniform over their range (range^2 / 12, propagated through the correlations); and 1 % of the squares
/// beyond the noise times A^-1, for a model of the wrong form, which biases all blocks alike.
std::vector<evidence::Interval> parameter_intervals(const effects::NestedModel& model,
                                                    const std::vector<fitting::Fold>& folds, double noise_squares,
                                                    const JointDiagnosisOptions& options = {});

/// Mean absolute errors of two models, with 95 % intervals from a bootstrap over blocks, the same draws for both.
struct HeldOutErrors {
  evidence::Interval before, after;
};
HeldOutErrors held_out_errors(const effects::NestedFit& runs, const calib::JointModel& before,
                              const calib::JointModel& after, unsigned seed);

}  // namespace pmg::diagnosis
