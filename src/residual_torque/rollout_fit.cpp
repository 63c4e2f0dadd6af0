#include "residual_torque/rollout_fit.hpp"

#include <cmath>
#include <limits>

namespace pmg::residual_torque {

namespace {

constexpr double kShares[] = {1.0, 0.5, 0.2, 0.05};  // of a start
constexpr double kDifference = 0.02;                 // of an amplitude's deviation: as wide as those of other torques
constexpr double kEnough = 1e-3;
constexpr int kMostSecants = 3;

fitting::ResidualFunction residuals(const effects::NestedFit& fit, const RolloutFit& extended) {
  return [&fit, &extended](const Eigen::VectorXd& x) { return fit.residuals(extended.model_at(x)); };
}

/// (problem, start, how many of its last coordinates are amplitudes) => (the start with as much of these as rollouts
/// bear). They follow from the torque along the recordings; a rollout that such a torque has thrown off its recording
/// meets another one.
Eigen::VectorXd nearest(const fitting::Problem& problem, const Eigen::VectorXd& start, Eigen::Index amplitudes) {
  Eigen::VectorXd best = start;
  double least = std::numeric_limits<double>::infinity();
  for (const double share : kShares) {
    Eigen::VectorXd there = start;
    there.tail(amplitudes) *= share;
    const double squares = fitting::sum_of_squares(problem.residuals(there)) +
                           fitting::prior(problem.coordinates, there, problem.prior_weight).squares;
    if (!(squares < least)) continue;
    least = squares;
    best = std::move(there);
  }
  return best;
}

}  // namespace

calib::JointModel RolloutFit::model_at(const Eigen::VectorXd& at) const {
  const Eigen::Index others = without.coordinates.size();
  calib::JointModel model = calib::model_at(without.model, without.unknowns, at);
  model.actuator.residual_torque.count = 1;
  model.actuator.residual_torque.terms[0] = term_of(candidate, at.tail(at.size() - others), bound_Nm);
  return model;
}

std::optional<RolloutFit> rollout_fit(const effects::NestedFit& fit, const effects::NestedModel& without,
                                      const TorqueFit& start, double bound_Nm, int iterations) {
  RolloutFit found;
  found.without = without;
  found.candidate = start.candidate;
  found.bound_Nm = bound_Nm;
  found.ranges = without.ranges;
  const Eigen::Index others = without.coordinates.size(), modes = start.amplitudes.size();
  found.coordinates.resize(others + modes);
  found.coordinates << without.coordinates, start.amplitudes;
  for (Eigen::Index m = 0; m < modes; ++m) {
    const double deviation = start.deviations[m], most = 1e3 * start.deviations.maxCoeff();
    found.ranges.push_back({-most, most, kDifference * start.deviations.maxCoeff(), 0.0, deviation});
  }
  // Each block counts as one observation, and so does each prior.
  found.prior_weight = without.squares / static_cast<double>(std::max<std::size_t>(1, fit.blocks().count()));
  fitting::Problem problem{
      .residuals = residuals(fit, found), .coordinates = found.ranges, .prior_weight = found.prior_weight};
  const fitting::Minimum best = fitting::gauss_newton(
      problem, nearest(problem, found.coordinates, modes),
      {.most_iterations = iterations, .relative_tolerance = kEnough, .most_secants = kMostSecants});
  if (!std::isfinite(best.squares)) return std::nullopt;
  found.coordinates = best.x;
  found.squares = best.squares;
  const bool known = !best.jacobian_at_x.empty();
  found.blocks = fit.blocks().normal_equations(
      best.residuals, known ? best.jacobian_at_x : fitting::jacobian(problem, best.x, best.residuals));
  return found;
}

fitting::HeldOut held_out_squares(const effects::NestedFit& fit, const RolloutFit& extended,
                                  const std::vector<fitting::Fold>& folds) {
  return fitting::held_out_squares(residuals(fit, extended), fit.blocks(), extended, folds);
}

}  // namespace pmg::residual_torque
