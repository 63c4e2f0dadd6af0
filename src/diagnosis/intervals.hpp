// How sure a diagnosis is of its numbers.
#pragma once

#include <vector>

#include "diagnosis/diagnosis.hpp"
#include "diagnosis/folds.hpp"

namespace pmg::diagnosis {

/// 95 % intervals of a linearised model's unknowns, in their units and order. What makes them wide: the misses,
/// cluster-robust over blocks; unknowns at an edge of their range, which may be anywhere in it; what a jackknife over
/// gains, loads and trajectories (folds) moves; and what remains beyond noise_squares (mean square of the noise), a
/// difference in form that pulls all blocks the same way.
std::vector<evidence::Interval> parameter_intervals(const NestedModel& model, const std::vector<Fold>& folds,
                                                    double noise_squares);

/// Mean absolute errors of the runs at two models, with 95 % intervals by a bootstrap over blocks that draws the same
/// blocks for both.
struct HeldOutErrors {
  evidence::Interval before, after;
};
HeldOutErrors held_out_errors(const NestedFit& runs, const calib::JointModel& before, const calib::JointModel& after,
                              unsigned seed);

}  // namespace pmg::diagnosis
