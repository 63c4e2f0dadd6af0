// 95 % intervals of a diagnosis' parameters and errors.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "effects/nested_fit.hpp"
#include "evidence/verdict.hpp"
#include "work/threshold.hpp"

namespace pmg::effects {

// docs/explanation/hidden-plants.md
inline constexpr std::string_view kPlants = "an earlier family of hidden plants, seeds 0 to 83";
inline constexpr std::string_view kAssumed = "assumed; how often intervals hold a known truth would settle it";
inline constexpr std::string_view kCost = "time of a diagnosis";

struct IntervalOptions {
  work::Threshold form_of_squares{
      0.01, "",
      "intervals: share of the squares beyond the noise that counts as one observation, for a form that isn't right",
      kPlants};
  work::Threshold form_of_value{
      0.03, "",
      "intervals: share of the value that two integrators of one joint differ by, beyond the error of the step",
      kPlants};
  work::Threshold told_width{
      1.5, "",
      "intervals: as they are told, so many times as wide as those by which an effect is taken: 84 % of the known "
      "numbers were in these",
      "334 numbers of hidden plants"};
  work::Threshold reach_squares{
      3.84, "",
      "intervals: as they are told, further while the fit with a parameter there is worse by less than so many blocks' "
      "squares: a block counts as one observation",
      "chi squared, 95 %"};
  work::Threshold widest_tolerance{
      0.3, "", "intervals: a wider range, as a share of its upper end, is a search's and no tolerance", kAssumed};
  work::Threshold wider{1.5, "",
                        "intervals: where a parameter's deviation is so many times its difference, the difference "
                        "becomes as wide: in a narrower one, a joint that sticks a sample earlier looks like a slope",
                        kAssumed};
  work::Threshold widest_difference{0.1, "", "intervals: no wider than this share of its range", kAssumed};
  work::CountThreshold widenings{3, "", "intervals: so many times", kCost};
  work::CountThreshold iterations{4, "", "Gauss-Newton iterations each time", kCost};

  PMG_THRESHOLDS(form_of_squares, form_of_value, told_width, reach_squares, widest_tolerance, wider, widest_difference,
                 widenings, iterations)
};

/// (linearised model, folds, mean square of the noise [rad^2]) => (standard deviations of its coordinates; 0 at the
/// bound of a range and where nothing is seen): the root of the larger of the jackknife's variance over the folds and
/// of a sum of three: the cluster-robust variance; the variance due to unknowns with a tolerance that ended at its
/// bound, uniform over their range (range^2 / 12, propagated through the correlations); and 1 % of the squares beyond
/// the noise times A^-1, for a model of the wrong form, which biases all blocks alike.
Eigen::VectorXd coordinate_deviations(const NestedModel& model, const std::vector<fitting::Fold>& folds,
                                      double noise_squares, const IntervalOptions& options = {});

/// (linearised model, some of its coordinates, other values of these, mean square of the noise [rad^2]) => (probability
/// that the fit would end so far from them by chance): F of the distance by the sum of three and its correlations, with
/// Kish's effective number of blocks (H. Hotelling, Annals of Mathematical Statistics 2:360, 1931). Two numbers may
/// each be unsure where one does as well as the other, and both together sure. Those at the bound of their range don't
/// count; 1 if none is left.
double chance_of(const NestedModel& model, const std::vector<Eigen::Index>& coordinates, const Eigen::VectorXd& at,
                 double noise_squares, const IntervalOptions& options = {});

/// (linearised model, folds, mean square of the noise [rad^2]) => (95 % intervals of the unknowns, in their units and
/// order): x +- t deviations, on to where an exact integrator would move it, then 3 % of the value to each side. t is
/// Student's, with the effective number of blocks as degrees of freedom: 1.96 for many, 2.57 for five.
std::vector<evidence::Interval> parameter_intervals(const NestedModel& model, const std::vector<fitting::Fold>& folds,
                                                    double noise_squares, const IntervalOptions& options = {});

/// (intervals of a model's unknowns) => (the same as they are told: told_width times as wide to each side of the value,
/// within the unknown's range).
std::vector<evidence::Interval> told(std::vector<evidence::Interval> intervals, const NestedModel& model,
                                     const IntervalOptions& options = {});

/// (runs, fitted model, intervals as they are told, parameters) => (the same, of these parameters as far to each side
/// as the other unknowns make up for it): 4/3, 2 and 3 times as wide, as long as the squares and the prior grow by less
/// than reach_squares of a block's. Rollouts of a joint that sticks are jagged: between two minima that are as good, a
/// linearised interval is that of one of them. Costs a Jacobian, and up to a
/// hundred rollouts for each parameter.
std::vector<evidence::Interval> reaching(const NestedFit& fit, const NestedModel& model,
                                         std::vector<evidence::Interval> intervals,
                                         const std::vector<std::string>& parameters,
                                         const IntervalOptions& options = {});

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
