#include "effects/pair_screen.hpp"

#include <algorithm>
#include <cmath>

#include "fitting/covariance.hpp"

namespace pmg::effects {

namespace {

constexpr double kMost = 2.0;       // of a start's strength
constexpr double kParallel = 1e-9;  // of the largest determinant: the two starts do the same

/// The least |x_0 + a x_i + b x_j|^2 over 0 <= a, b <= kMost, from the products of the columns.
double least_squares(const Eigen::MatrixXd& g, Eigen::Index i, Eigen::Index j) {
  const auto squares = [&](double a, double b) {
    return g(0, 0) + 2.0 * (a * g(0, i) + b * g(0, j)) + a * a * g(i, i) + b * b * g(j, j) + 2.0 * a * b * g(i, j);
  };
  const auto best = [](double slope, double curvature) {
    return curvature > 0.0 ? std::clamp(-slope / curvature, 0.0, kMost) : 0.0;
  };
  double least = g(0, 0);
  const double determinant = g(i, i) * g(j, j) - g(i, j) * g(i, j);
  if (determinant > kParallel * g(i, i) * g(j, j)) {
    const double a = (g(i, j) * g(0, j) - g(j, j) * g(0, i)) / determinant;
    const double b = (g(i, j) * g(0, i) - g(i, i) * g(0, j)) / determinant;
    if (std::min(a, b) >= 0.0 && std::max(a, b) <= kMost) return squares(a, b);
  }
  for (const double edge : {0.0, kMost}) {  // the least lies on the square's edge
    const double b = best(g(0, j) + edge * g(i, j), g(j, j)), a = best(g(0, i) + edge * g(i, j), g(i, i));
    least = std::min({least, squares(edge, b), squares(a, edge)});
  }
  return least;
}

}  // namespace

std::vector<ScreenedPair> screened_pairs(const StartScreen& screen, const std::vector<EffectStart>& starts) {
  const fitting::Residuals& at_current = screen.residuals();
  std::vector<const EffectStart*> simulated;
  std::vector<Eigen::MatrixXd> columns;
  for (const Eigen::VectorXd& run : at_current) columns.emplace_back(run.size(), 1 + std::ssize(starts)).col(0) = run;
  for (const EffectStart& start : starts) {
    const fitting::Residuals there = screen.fit().residuals(start.start.model);
    if (!std::isfinite(fitting::sum_of_squares(there))) continue;
    simulated.push_back(&start);
    for (std::size_t run = 0; run < there.size(); ++run)
      columns[run].col(std::ssize(simulated)) = there[run] - at_current[run];
  }
  for (Eigen::MatrixXd& run : columns) run.conservativeResize(Eigen::NoChange, 1 + std::ssize(simulated));
  const Eigen::MatrixXd products = fitting::beyond(
      fitting::products(columns, columns), fitting::products(screen.jacobian().of_run, columns), screen.information());
  std::vector<ScreenedPair> found;
  for (std::size_t i = 0; i < simulated.size(); ++i) {
    for (std::size_t j = i + 1; j < simulated.size(); ++j) {
      if (simulated[i]->effect == simulated[j]->effect) continue;
      const auto first = static_cast<Eigen::Index>(i + 1), second = static_cast<Eigen::Index>(j + 1);
      found.push_back({simulated[i], simulated[j], least_squares(products, first, second)});
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const ScreenedPair& a, const ScreenedPair& b) { return a.squares < b.squares; });
  return found;
}

}  // namespace pmg::effects
