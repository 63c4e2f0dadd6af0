#include "residual_torque/rollout_fit.hpp"

#include <numeric>

namespace pmg::residual_torque {

namespace {

constexpr double kDifference = 0.02;  // of an amplitude's deviation: as wide as those of other torques

fitting::ResidualFunction residuals(const effects::NestedFit& fit, const RolloutFit& extended) {
  return [&fit, &extended](const Eigen::VectorXd& x) { return fit.residuals(extended.model_at(x)); };
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
  const fitting::Residuals at_start = problem.residuals(found.coordinates);
  if (at_start.empty()) return std::nullopt;
  const fitting::Jacobian slopes = fitting::jacobian(problem, found.coordinates, at_start);
  problem.known = &slopes;
  problem.known_column.resize(static_cast<std::size_t>(others + modes));
  std::iota(problem.known_column.begin(), problem.known_column.end(), 0);
  const fitting::Minimum best =
      fitting::gauss_newton(problem, found.coordinates, {.most_iterations = iterations, .relative_tolerance = 1e-3});
  found.coordinates = best.x;
  found.squares = best.squares;
  found.blocks = fit.blocks().normal_equations(problem.residuals(found.coordinates), slopes);
  return found;
}

fitting::HeldOut held_out_squares(const effects::NestedFit& fit, const RolloutFit& extended,
                                  const std::vector<fitting::Fold>& folds) {
  return fitting::held_out_squares(residuals(fit, extended), fit.blocks(), extended, folds);
}

}  // namespace pmg::residual_torque
