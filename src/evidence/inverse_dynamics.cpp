#include "evidence/inverse_dynamics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "evidence/cluster_regression.hpp"
#include "evidence/torque_balance.hpp"

namespace pmg::evidence {

namespace {

/// A servo's voltage is a duty: back-EMF isn't in it.
bool tells_its_torque(const bench::Bench& bench, const bench::BenchRun& run) {
  if (!run.recording.torque_Nm.empty()) return true;
  return !run.recording.drive_V.empty() && bench.law != bench::DriveLaw::kServoVoltage &&
         std::ranges::find(bench.unknown, "drive.torque_per_unit_Nm") == bench.unknown.end();
}

/// Root mean square of the drive about cubics through five samples, over its standard deviation. Such a cubic leaves
/// the fourth difference over sqrt(1 + 16 + 36 + 16 + 1).
double unresolved(const std::vector<bench::BenchRun>& runs) {
  double left = 0.0, sum = 0.0, squares = 0.0, count = 0.0;
  for (const bench::BenchRun& run : runs) {
    const std::vector<double>& d = run.recording.torque_Nm.empty() ? run.recording.drive_V : run.recording.torque_Nm;
    for (std::size_t k = 2; k + 2 < d.size(); ++k) {
      const double fourth = d[k - 2] - 4.0 * d[k - 1] + 6.0 * d[k] - 4.0 * d[k + 1] + d[k + 2];
      left += fourth * fourth / 70.0;
      sum += d[k], squares += d[k] * d[k], ++count;
    }
  }
  const double spread = squares - sum * sum / count;
  return spread > 0.0 ? std::sqrt(left / spread) : 0.0;
}

}  // namespace

std::optional<calib::InverseDynamics> inverse_dynamics(const bench::Bench& bench,
                                                       const std::vector<bench::BenchRun>& runs,
                                                       const SignatureOptions& options) {
  std::vector<bench::BenchRun> recorded;
  std::ranges::copy_if(runs, std::back_inserter(recorded),
                       [&](const bench::BenchRun& run) { return tells_its_torque(bench, run); });
  if (recorded.empty()) return std::nullopt;
  const TorqueBalance balance(bench, recorded, options.balance);
  const std::vector<int> clusters = balance.clusters();
  if (clusters.empty() || clusters.back() + 1 < options.fewest_clusters) return std::nullopt;
  const Column torque_Nm =
      balance.integral([](const BalancePoint& p) { return p.recorded_Nm - p.gravity_Nm; }) - balance.load_inertia_Nm();
  const auto windows = torque_Nm.size();
  const std::array<Column, 4> columns = {balance.acceleration_rad_s2(), balance.speed_rad_s(),
                                         balance.integral([](const BalancePoint& p) { return p.direction; }),
                                         -Column::Ones(windows)};
  std::array<calib::InverseDynamics::Estimate, 4> found;
  Column left_Nm = torque_Nm;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    std::vector<Column> others;
    for (std::size_t j = 0; j < columns.size(); ++j) {
      if (j != i) others.push_back(columns[j]);
    }
    const TermEstimate term =
        ClusterRegression(others, torque_Nm, clusters, options.balance.collinear_share).term(columns[i]);
    if (!(term.own > options.balance.collinear_share)) return std::nullopt;
    found[i] = {term.coefficient, term.deviation};
    left_Nm -= term.coefficient * columns[i];
  }
  return calib::InverseDynamics{.armature_kg_m2 = found[0],
                                .viscous_Nm_s_per_rad = found[1],
                                .coulomb_Nm = found[2],
                                .offset_Nm = found[3],
                                .residual_Nm = left_Nm.norm() / std::sqrt(static_cast<double>(windows - 4)),
                                .unresolved = unresolved(recorded),
                                .sample_rate_hz = bench.sample_rate_hz,
                                .windows = static_cast<std::size_t>(windows)};
}

}  // namespace pmg::evidence
