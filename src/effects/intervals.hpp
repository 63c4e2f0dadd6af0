// 95 % intervals of a diagnosis' parameters and errors.
#pragma once

#include <vector>

#include "effects/nested_fit.hpp"
#include "evidence/verdict.hpp"

namespace pmg::effects {

/// The list of a diagnosis' options gives the reason of each.
struct IntervalOptions {
  double form_of_squares = 0.01, form_of_value = 0.03, widest_tolerance = 0.3;
  double wider = 1.5, widest_difference = 0.1, widenings = 3.0, iterations = 4.0;
};

/// (linearised model, folds, mean square of the noise [rad^2]) => (standard deviations of its coordinates; 0 at the
/// bound of a range and where nothing is seen): the root of the larger of the jackknife's variance over the folds and
/// of a sum of three: the cluster-robust variance; the variance due to unknowns with a tolerance that ended at its
/// bound, uniform over their range (range^2 / 12, propagated through the correlations); and 1 % of the squares beyond
/// the noise times A^-1, for a model of the wrong form, which biases all blocks alike.
Eigen::VectorXd coordinate_deviations(const NestedModel& model, const std::vector<fitting::Fold>& folds,
                                      double noise_squares, const IntervalOptions& options = {});

/// (linearised model, folds, mean square of the noise [rad^2]) => (95 % intervals of the unknowns, in their units and
/// order): x +- t deviations, on to where an exact integrator would move it, then 3 % of the value to each side. t is
/// Student's, with the effective number of blocks as degrees of freedom: 1.96 for many, 2.57 for five.
std::vector<evidence::Interval> parameter_intervals(const NestedModel& model, const std::vector<fitting::Fold>& folds,
                                                    double noise_squares, const IntervalOptions& options = {});

/// (linearised model) => (fitted again and linearised with differences as wide as the coordinates' deviations, and at
/// least 3 % of the value: no interval is narrower). Where a joint sticks, its rollouts jump with a number that changes
/// a little. A narrow difference takes these jumps for a slope: the fit stays where it began, and its interval is too
/// narrow. Costs up to three times four iterations.
NestedModel with_wide_differences(const NestedFit& fit, NestedModel model, const std::vector<fitting::Fold>& folds,
                                  double noise_squares, const IntervalOptions& options = {});

/// (fitted model) => (by how much its coordinates would move with an exact integrator, linearised). Semi-implicit Euler
/// is of first order: the residuals move by d = 2 (r(h / 2) - r(h)), so the minimum by -(J^T J + prior)^-1 J^T d,
/// within the bounds. Empty where the model can't be simulated. Costs a Jacobian and a rollout with half the step.
Eigen::VectorXd step_shift(const bench::Bench& bench, const NestedFit& fit, const NestedModel& model);

/// Mean absolute errors of two models, with 95 % intervals from a bootstrap over blocks, the same draws for both. Each
/// model has its runs, which differ only in what is known of their assemblies.
struct HeldOutErrors {
  evidence::Interval before, after;
};
HeldOutErrors held_out_errors(const NestedFit& runs_before, const calib::JointModel& before,
                              const NestedFit& runs_after, const calib::JointModel& after, unsigned seed);

}  // namespace pmg::effects
