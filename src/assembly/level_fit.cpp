#include "assembly/level_fit.hpp"

#include <algorithm>
#include <cmath>

#include "calib/unknown.hpp"
#include "fitting/covariance.hpp"
#include "fitting/f_distribution.hpp"

namespace pmg::assembly {

LevelFit::LevelFit(const effects::NestedFit& fit, const effects::NestedModel& at, std::vector<VaryingParameter> varying)
    : fit_(fit), at_(at), varying_(std::move(varying)), count_(at.coordinates.size()) {
  for (const VaryingParameter& one : varying_) {
    first_level_.push_back(count_);
    count_ += std::ssize(one.effect.grouping.levels);
  }
  const effects::RolloutJacobian of_columns = fit_.jacobian(at_, fit_.residuals(at_.model));
  for (std::size_t r = 0; r < of_columns.of_run.size(); ++r) {
    const Eigen::MatrixXd& columns = of_columns.of_run[r];
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(columns.rows(), count_);
    all.leftCols(columns.cols()) = columns;
    for (std::size_t v = 0; v < varying_.size(); ++v) {
      const LevelEffect& effect = varying_[v].effect;
      const int level = effect.grouping.level_of_run[r];
      if (level < 0) continue;
      const calib::Unknown& u = at_.unknowns[static_cast<std::size_t>(effect.column)];
      const double per_value = 1.0 / u.slope(at_.coordinates[effect.column]);
      all.col(first_level_[v] + level) = columns.col(effect.column) * per_value;
    }
    jacobian_.push_back(std::move(all));
  }
}

std::vector<std::vector<bench::AssemblyDifference>> LevelFit::differences(const Eigen::VectorXd& x) const {
  std::vector<std::vector<bench::AssemblyDifference>> found(fit_.runs().size());
  for (std::size_t v = 0; v < varying_.size(); ++v) {
    const LevelEffect& effect = varying_[v].effect;
    const calib::Unknown& u = at_.unknowns[static_cast<std::size_t>(effect.column)];
    for (std::size_t r = 0; r < found.size(); ++r) {
      const int level = effect.grouping.level_of_run[r];
      if (level >= 0) found[r].push_back({u.name, x[first_level_[v] + level], u.lower, u.upper});
    }
  }
  return found;
}

/// The model's columns alone, or with those of the levels.
fitting::Jacobian LevelFit::jacobian(bool with_levels) const {
  if (with_levels) return jacobian_;
  fitting::Jacobian found;
  for (const Eigen::MatrixXd& run : jacobian_) found.emplace_back(run.leftCols(at_.coordinates.size()));
  return found;
}

/// The result refers to the runs, the Jacobian and this object: all must outlive it.
fitting::Problem LevelFit::problem(std::vector<calib::SingleJoint>& runs, const fitting::Jacobian& known,
                                   bool with_levels) const {
  fitting::Problem problem{.residuals =
                               [this, &runs](const Eigen::VectorXd& x) {
                                 if (x.size() == count_) {
                                   const auto differs = differences(x);
                                   for (std::size_t r = 0; r < runs.size(); ++r) runs[r].set_differences(differs[r]);
                                 }
                                 return calib::residuals(calib::model_at(at_.model, at_.unknowns, x), runs,
                                                         fit_.threads());
                               },
                           .coordinates = at_.ranges,
                           .prior_weight = at_.prior_weight,
                           .known = &known};
  for (const VaryingParameter& one : with_levels ? varying_ : std::vector<VaryingParameter>{}) {
    const calib::Unknown& u = at_.unknowns[static_cast<std::size_t>(one.effect.column)];
    const double reach = u.upper - u.lower;
    const double deviation = std::sqrt(problem.prior_weight / one.effect.penalty);
    for (std::size_t level = 0; level < one.effect.grouping.levels.size(); ++level)
      problem.coordinates.push_back(
          {.lower = -reach, .upper = reach, .step = u.typical * 5e-3, .expected = 0.0, .deviation = deviation});
  }
  for (Eigen::Index i = 0; i < std::ssize(problem.coordinates); ++i) problem.known_column.push_back(i);
  return problem;
}

FittedLevels LevelFit::fitted(const std::vector<fitting::Fold>& folds, bool with_levels, int most_iterations) const {
  std::vector<calib::SingleJoint> runs = fit_.runs();
  const fitting::Jacobian known = jacobian(with_levels);
  const fitting::Problem problem = this->problem(runs, known, with_levels);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(std::ssize(problem.coordinates));
  x.head(at_.coordinates.size()) = at_.coordinates;
  const fitting::Minimum best =
      fitting::gauss_newton(problem, x, {.most_iterations = most_iterations, .relative_tolerance = 1e-4});
  fitting::LinearisedFit linear{.ranges = problem.coordinates,
                                .coordinates = best.x,
                                .squares = best.squares,
                                .blocks = fit_.blocks().normal_equations(problem.residuals(best.x), known),
                                .prior_weight = problem.prior_weight};
  FittedLevels found;
  found.model = calib::model_at(at_.model, at_.unknowns, best.x);
  found.held_out = fitting::held_out_squares(problem.residuals, fit_.blocks(), linear, folds);
  if (!with_levels) return found;
  read_off(found, linear);
  return found;
}

void LevelFit::read_off(FittedLevels& found, const fitting::LinearisedFit& fit) const {
  const Eigen::MatrixXd information = fitting::information(fit);
  const Eigen::MatrixXd inverse = fitting::solved(information, Eigen::MatrixXd::Identity(count_, count_));
  for (std::size_t v = 0; v < varying_.size(); ++v) {
    const LevelEffect& effect = varying_[v].effect;
    const calib::Unknown& u = at_.unknowns[static_cast<std::size_t>(effect.column)];
    const double mean = u.value(fit.coordinates[effect.column]),
                 per_coordinate = u.slope(fit.coordinates[effect.column]);
    const double wide = fitting::student95(varying_[v].freedom) * std::sqrt(varying_[v].unit_squares);
    const double of_mean = wide * per_coordinate * std::sqrt(std::max(0.0, inverse(effect.column, effect.column)));
    found.means.push_back({mean, std::max(u.lower, mean - of_mean), std::min(u.upper, mean + of_mean)});
    std::vector<LevelValue> levels;
    for (std::size_t l = 0; l < effect.grouping.levels.size(); ++l) {
      const Eigen::Index i = first_level_[v] + static_cast<Eigen::Index>(l);
      const double value = std::clamp(mean + fit.coordinates[i], u.lower, u.upper);
      const double variance = per_coordinate * per_coordinate * inverse(effect.column, effect.column) + inverse(i, i) +
                              2.0 * per_coordinate * inverse(effect.column, i);
      const double half = wide * std::sqrt(std::max(0.0, variance));
      levels.push_back({effect.grouping.levels[l],
                        effect.grouping.runs_of(static_cast<int>(l)),
                        {value, std::max(u.lower, value - half), std::min(u.upper, value + half)}});
    }
    found.levels.push_back(std::move(levels));
  }
}

}  // namespace pmg::assembly
