#include "robot_diagnosis/robot_noise.hpp"

#include <numeric>

namespace pmg::robot_diagnosis {

namespace {

bool moves(const RobotRow& row, const NoiseOptions& options) { return row.standstill <= options.most_standstill; }

/// 1 + 2 * sum of the autocorrelations, up to the first one below least_autocorrelation.
double rows_per_independent(const std::vector<double>& e, double mean_square, const NoiseOptions& options) {
  double inflation = 1.0;
  for (int lag = 1; lag <= options.longest_lag && static_cast<std::size_t>(lag) < e.size(); ++lag) {
    const double product = std::inner_product(e.begin() + lag, e.end(), e.begin(), 0.0) / static_cast<double>(e.size());
    if (product <= options.least_autocorrelation * mean_square) break;
    inflation += 2.0 * product / mean_square;
  }
  return inflation;
}

}  // namespace

double residual(const RobotRow& row, const Eigen::VectorXd& theta) {
  double r = row.residual;
  for (const auto& [index, coefficient] : row.coefficients) r += coefficient * theta[index];
  return r;
}

double NoiseLevels::weight(const RobotRow& row) const {
  if (!moves(row, options)) return 0.0;
  const auto kind = static_cast<std::size_t>(row.kind);
  return variance[kind] > 0.0 ? 1.0 / ((variance[kind] + row.friction_variance) * rows_per_independent[kind]) : 0.0;
}

NoiseLevels noise_levels(const std::vector<RobotBlock>& blocks, int kinds, const Eigen::VectorXd& theta,
                         const NoiseOptions& options) {
  std::vector<std::vector<double>> by_kind(static_cast<std::size_t>(kinds));
  for (const RobotBlock& block : blocks) {
    for (const RobotRow& row : block.rows)
      if (moves(row, options)) by_kind[static_cast<std::size_t>(row.kind)].push_back(residual(row, theta));
  }
  NoiseLevels levels(kinds, options);
  for (std::size_t kind = 0; kind < by_kind.size(); ++kind) {
    const std::vector<double>& e = by_kind[kind];
    if (static_cast<double>(e.size()) < options.fewest_rows) continue;
    const double square = std::inner_product(e.begin(), e.end(), e.begin(), 0.0) / static_cast<double>(e.size());
    if (square <= 0.0) continue;
    levels.variance[kind] = square;
    levels.rows_per_independent[kind] = rows_per_independent(e, square, options);
  }
  return levels;
}

fitting::NormalEquations normal_equations(std::span<const RobotRow> rows, const NoiseLevels& noise,
                                          Eigen::Index parameters) {
  fitting::NormalEquations sum = fitting::NormalEquations::zero(parameters);
  for (const RobotRow& row : rows) {
    const double w = noise.weight(row);
    if (w == 0.0) continue;
    sum.squares += w * row.residual * row.residual;
    sum.samples += 1.0 / noise.rows_per_independent[static_cast<std::size_t>(row.kind)];
    for (const auto& [i, a] : row.coefficients) {
      sum.gradient[i] += w * a * row.residual;
      for (const auto& [k, b] : row.coefficients) {
        if (k > i) break;
        sum.information(i, k) += w * a * b;
      }
    }
  }
  sum.information.triangularView<Eigen::StrictlyUpper>() = sum.information.transpose();
  return sum;
}

}  // namespace pmg::robot_diagnosis
