#include "residual_torque/repeat.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace pmg::residual_torque {

namespace {

using model::ResidualQuantity;

constexpr int kColumns = 10;
constexpr double kTurnsOff =
    0.1;  // between neighbours of the grid, at the end of the longest run: a wave shows in both

/// Rows in which the joint moves, of all runs.
struct Rows {
  std::vector<double> missing_Nm, change_Nm, t_s;
  double longest_s = 0.0;
};

Rows rows_of(const MissingTorque& missing) {
  Rows rows;
  for (const MissingRun& run : missing.runs) {
    const Eigen::VectorXd& change = run.values(ResidualQuantity::kCommandChange, kLags - 1);
    const Eigen::VectorXd& t_s = run.values(ResidualQuantity::kTime, 0);
    rows.longest_s = std::max(rows.longest_s, t_s.maxCoeff());
    for (Eigen::Index k = 0; k < run.missing_Nm.size(); ++k) {
      if (run.direction[k] == 0.0) continue;
      rows.missing_Nm.push_back(run.missing_Nm[k]);
      rows.change_Nm.push_back(change[k]);
      rows.t_s.push_back(t_s[k]);
    }
  }
  return rows;
}

/// Squares of the missing torque that a + b c alone leave, and those that it leaves with waves of this frequency.
struct Left {
  double alone, with_waves;
};

Left left(const Rows& rows, double frequency_hz) {
  Eigen::Matrix<double, kColumns, kColumns> squares = Eigen::Matrix<double, kColumns, kColumns>::Zero();
  Eigen::Matrix<double, kColumns, 1> with_missing = Eigen::Matrix<double, kColumns, 1>::Zero(), row;
  double all = 0.0;
  for (std::size_t k = 0; k < rows.t_s.size(); ++k) {
    const double turn = 2.0 * std::numbers::pi * frequency_hz * rows.t_s[k], c = rows.change_Nm[k];
    const double cosine = std::cos(turn), sine = std::sin(turn);
    const double waves[] = {cosine, sine, cosine * cosine - sine * sine, 2.0 * sine * cosine};
    row[0] = 1.0;
    row[1] = c;
    for (int i = 0; i < 4; ++i) row[2 + 2 * i] = waves[i], row[3 + 2 * i] = waves[i] * c;
    squares.selfadjointView<Eigen::Lower>().rankUpdate(row);
    with_missing += rows.missing_Nm[k] * row;
    all += rows.missing_Nm[k] * rows.missing_Nm[k];
  }
  squares = squares.selfadjointView<Eigen::Lower>();
  squares.diagonal() *= 1.0 + 1e-9;  // a bench whose command never changes has columns of zeros
  squares.diagonal().array() += 1e-12;
  const auto explained = [&](int columns) {
    const Eigen::VectorXd found = squares.topLeftCorner(columns, columns).ldlt().solve(with_missing.head(columns));
    return found.dot(with_missing.head(columns));
  };
  return {all - explained(2), all - explained(kColumns)};
}

}  // namespace

std::optional<double> repeats_each_s(const MissingTorque& missing, const Options& options) {
  const Rows rows = rows_of(missing);
  if (rows.t_s.size() < 10 * kColumns || !(rows.longest_s > 0.0)) return std::nullopt;
  double best_share = options.least_repeating, best_s = 0.0;
  const double step_hz = kTurnsOff / rows.longest_s, slowest_hz = options.least_repeats / rows.longest_s;
  for (double f_hz = slowest_hz; f_hz <= 1.0 / options.shortest_period_s; f_hz += step_hz) {
    const Left now = left(rows, f_hz);
    const double share = 1.0 - now.with_waves / std::max(1e-300, now.alone);
    if (share <= best_share) continue;
    best_share = share;
    best_s = 1.0 / f_hz;
  }
  if (best_s == 0.0) return std::nullopt;
  return best_s;
}

}  // namespace pmg::residual_torque
