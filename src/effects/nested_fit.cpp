#include "effects/nested_fit.hpp"

#include <algorithm>

namespace pmg::effects {

namespace {

/// A fit ends where an iteration lowers the squares by a smaller share. With 500 blocks, each one observation, such a
/// step moves a number by about a fifth of its deviation: sqrt(500 kEnough).
constexpr double kEnough = 1e-4;
constexpr int kIterationsBeside = 4;
constexpr int kMostSecants = 3;  // later ones gain little: rollouts with dry friction are jagged

/// Factor on the difference steps. The usual ones move a reading by a few milliradians; a coarse encoder of that model
/// shows nothing of that, or a step that one sample takes earlier, and its fit would stop where it began.
double wider_steps(const calib::JointModel& model) {
  constexpr double kFine_rad = 5e-3, kMost = 10.0;
  return std::clamp(calib::value(model, "sensor.quantum_rad") / kFine_rad, 1.0, kMost);
}

}  // namespace

/// The result refers to the model and to the known Jacobian: both must outlive it.
fitting::Problem NestedFit::problem(const NestedModel& model, const RolloutJacobian* known) const {
  fitting::Problem problem{
      .residuals = [this, &model](
                       const Eigen::VectorXd& x) { return residuals(calib::model_at(model.model, model.unknowns, x)); },
      .coordinates = model.ranges,
      .prior_weight = model.prior_weight};
  if (known == nullptr) return problem;
  problem.known = &known->of_run;
  for (const calib::Unknown& u : model.unknowns) {
    const auto there = std::find(known->unknowns.begin(), known->unknowns.end(), u);
    problem.known_column.push_back(there == known->unknowns.end() ? -1 : there - known->unknowns.begin());
  }
  return problem;
}

RolloutJacobian NestedFit::jacobian(const NestedModel& model, const fitting::Residuals& at_model) const {
  return {model.unknowns, fitting::jacobian(problem(model), model.coordinates, at_model)};
}

void NestedFit::linearise(NestedModel& model, const RolloutJacobian* known) const {
  const fitting::Residuals at_model = residuals(model.model);
  model.blocks =
      blocks_.normal_equations(at_model, fitting::jacobian(problem(model, known), model.coordinates, at_model));
}

NestedModel NestedFit::fit(const calib::JointModel& start, const calib::Unknowns& unknowns, int most_iterations,
                           const RolloutJacobian* known, double prior_weight) const {
  NestedModel found;
  found.model = start;
  found.unknowns = unknowns;
  found.prior_weight = prior_weight;
  found.ranges = calib::ranges(unknowns, wider_steps(start));
  found.coordinates = calib::coordinates(unknowns, start);
  const fitting::Minimum best = fitting::gauss_newton(
      problem(found, known), found.coordinates,
      {.most_iterations = most_iterations, .relative_tolerance = kEnough, .most_secants = kMostSecants});
  found.coordinates = best.x;
  found.squares = best.squares;
  found.model = calib::model_at(start, unknowns, best.x);
  if (!best.jacobian_at_x.empty()) found.blocks = blocks_.normal_equations(best.residuals, best.jacobian_at_x);
  return found;
}

NestedModel NestedFit::beside(const NestedModel& model, const std::string& parameter, double value,
                              const RolloutJacobian* known) const {
  calib::JointModel start = model.model;
  calib::set(start, parameter, value);
  calib::Unknowns others = model.unknowns;
  std::erase_if(others, [&](const calib::Unknown& u) { return u.name == parameter; });
  return fit(start, others, kIterationsBeside, known, model.prior_weight);
}

fitting::HeldOut NestedFit::held_out_squares(const NestedModel& model, const std::vector<fitting::Fold>& folds) const {
  return fitting::held_out_squares(problem(model).residuals, blocks_, model, folds);
}

}  // namespace pmg::effects
