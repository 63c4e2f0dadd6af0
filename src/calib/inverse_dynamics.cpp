#include "calib/inverse_dynamics.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cctype>
#include <cmath>

namespace pmg::calib {

namespace {

constexpr std::size_t kFewestWindows = 100;
constexpr double kUnresolved = 0.1;   // share of the drive: above it, accelerations are wrong by as much
constexpr double kRest_share = 0.01;  // share of the greatest speed, below which the sign is noise

/// Value, first and second derivative of a cubic through 2 reach + 1 evenly spaced samples, at the middle one.
struct LocalCubic {
  LocalCubic(std::size_t reach, double step_s) {
    const auto count = static_cast<Eigen::Index>(2 * reach + 1);
    powers.resize(count, 4);
    for (Eigen::Index row = 0; row < count; ++row) {
      const double x = (static_cast<double>(row) - static_cast<double>(reach)) * step_s;
      powers.row(row) << 1.0, x, x * x, x * x * x;
    }
    // Columns are scaled: the fourth is about 1e-8 of the first.
    const Eigen::RowVector4d scale = powers.cwiseAbs().colwise().maxCoeff();
    const Eigen::MatrixXd scaled = powers.array().rowwise() / scale.array();
    weights = (scaled.transpose() * scaled).ldlt().solve(scaled.transpose());
    weights.array().colwise() /= scale.transpose().array();
  }
  Eigen::Vector3d operator()(const std::vector<double>& values, std::size_t middle) const {
    const auto count = weights.cols();
    const Eigen::Map<const Eigen::VectorXd> near(values.data() + middle - static_cast<std::size_t>(count) / 2, count);
    const Eigen::Vector4d c = weights * near;
    return {c[0], c[1], 2.0 * c[2]};
  }
  /// Variance of the samples about the cubic.
  double scatter(const std::vector<double>& values, std::size_t middle) const {
    const auto count = weights.cols();
    const Eigen::Map<const Eigen::VectorXd> near(values.data() + middle - static_cast<std::size_t>(count) / 2, count);
    return (near - powers * (weights * near)).squaredNorm() / static_cast<double>(count - 4);
  }
  Eigen::MatrixXd powers;
  Eigen::Matrix<double, 4, Eigen::Dynamic> weights;
};

struct Equations {
  std::vector<Eigen::Vector4d> rows;  // ddq, dq, sign dq, -1
  std::vector<double> torque_Nm;
  double scatter = 0.0;                    // of the drive about the cubics: the sum of variances [Nm^2]
  double drive_Nm = 0.0, drive_Nm2 = 0.0;  // sums
};

void add(const bench::Bench& bench, const bench::BenchRun& run, double window_s, Equations& equations) {
  const bench::Recording& r = run.recording;
  const bool torque = !r.torque_Nm.empty();
  const std::vector<double>& drive = torque ? r.torque_Nm : r.drive_V;
  const double torque_per_unit = torque ? 1.0 : bench.known.drive.torque_per_unit_Nm;
  const double step_s = (r.t_s.back() - r.t_s.front()) / static_cast<double>(r.t_s.size() - 1);
  const std::size_t reach = std::max<std::size_t>(2, static_cast<std::size_t>(std::lround(window_s / step_s)));
  if (drive.size() < 4 * reach) return;
  const LocalCubic cubic(reach, step_s);
  double fastest = 0.0;
  for (std::size_t k = reach; k + reach < drive.size(); ++k)
    fastest = std::max(fastest, std::abs(cubic(r.q_rad, k)[1]));
  for (std::size_t k = reach; k + reach < drive.size(); k += 2 * reach + 1) {  // windows that share no sample
    const Eigen::Vector3d q = cubic(r.q_rad, k);
    if (std::abs(q[1]) < kRest_share * fastest) continue;
    const double load_Nm = run.load.inertia_kg_m2 * q[2] + run.load.gravity_Nm * std::sin(q[0] - run.load.hangs_at_rad);
    equations.rows.emplace_back(q[2], q[1], q[1] > 0.0 ? 1.0 : -1.0, -1.0);
    const double drive_Nm = torque_per_unit * cubic(drive, k)[0];
    equations.torque_Nm.push_back(drive_Nm - load_Nm);
    equations.scatter += torque_per_unit * torque_per_unit * cubic.scatter(drive, k);
    equations.drive_Nm += drive_Nm;
    equations.drive_Nm2 += drive_Nm * drive_Nm;
  }
}

/// "Viscous friction and dry friction backwards"; empty where there is none of them.
std::string named(const std::vector<ImpossibleEstimate>& estimates, bool significant) {
  std::vector<std::string> names;
  for (const ImpossibleEstimate& estimate : estimates) {
    if (estimate.significant == significant) names.push_back(estimate.what);
  }
  std::string text = fmt::format("{}", fmt::join(names, " and "));
  if (!text.empty()) text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text;
}

}  // namespace

std::vector<ImpossibleEstimate> impossible_estimates(const InverseDynamics& found) {
  std::vector<ImpossibleEstimate> impossible;
  const auto check = [&](const char* what, double value, double deviation) {
    if (value < 0.0) impossible.push_back({what, value < -2.0 * deviation});
  };
  check("rotor inertia", found.armature_kg_m2.value, found.armature_kg_m2.deviation);
  check("viscous friction", found.viscous_Nm_s_per_rad.value, found.viscous_Nm_s_per_rad.deviation);
  const double dry_Nm = std::hypot(found.coulomb_Nm.deviation, found.offset_Nm.deviation);
  if (std::max(found.coulomb_forward_Nm(), found.coulomb_backward_Nm()) < 0.0) {
    check("dry friction", found.coulomb_Nm.value, dry_Nm);
  } else {
    check("dry friction forwards", found.coulomb_forward_Nm(), dry_Nm);
    check("dry friction backwards", found.coulomb_backward_Nm(), dry_Nm);
  }
  return impossible;
}

bool possible(const InverseDynamics& found) {
  return std::ranges::none_of(impossible_estimates(found), &ImpossibleEstimate::significant);
}

std::string meaning_of_negative(const InverseDynamics& found) {
  const std::vector<ImpossibleEstimate> impossible = impossible_estimates(found);
  std::string text;
  if (const std::string beyond_noise = named(impossible, true); !beyond_noise.empty()) {
    text = beyond_noise + " below zero: no joint has that. ";
    text += found.unresolved > kUnresolved
                ? fmt::format(
                      "The torque changes too fast for {:g} samples a second: {:.0f} % of it is lost between them. ",
                      found.sample_rate_hz, 100.0 * found.unresolved)
                : "The recorded torque doesn't belong to the recorded motion: it is early or late, its unit is another "
                  "one, or "
                  "the load in bench.yaml is wrong. ";
    text += "The fit needs no torque: go by the fit.";
  }
  if (const std::string noise = named(impossible, false); !noise.empty()) {
    text += fmt::format("{}{} below zero by less than its uncertainty: too small to be seen in these recordings.",
                        text.empty() ? "" : " ", noise);
  }
  return text;
}

std::optional<InverseDynamics> inverse_dynamics(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs,
                                                double window_s) {
  const bool unknown =
      std::find(bench.unknown.begin(), bench.unknown.end(), "drive.torque_per_unit_Nm") != bench.unknown.end();
  Equations equations;
  for (const bench::BenchRun& run : runs) {
    const bool voltage_is_duty = bench.law == bench::DriveLaw::kServoVoltage;  // back-EMF isn't in it
    if (!run.recording.torque_Nm.empty() || (!run.recording.drive_V.empty() && !unknown && !voltage_is_duty)) {
      add(bench, run, window_s, equations);
    }
  }
  const std::size_t count = equations.rows.size();
  if (count < kFewestWindows) return std::nullopt;

  Eigen::Matrix4d squares = Eigen::Matrix4d::Zero();
  Eigen::Vector4d products = Eigen::Vector4d::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    squares += equations.rows[i] * equations.rows[i].transpose();
    products += equations.rows[i] * equations.torque_Nm[i];
  }
  const Eigen::LDLT<Eigen::Matrix4d> solver(squares);
  const Eigen::Vector4d solution = solver.solve(products);
  double sum_Nm2 = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double miss_Nm = equations.torque_Nm[i] - equations.rows[i].dot(solution);
    sum_Nm2 += miss_Nm * miss_Nm;
  }
  const double mean_Nm = equations.drive_Nm / static_cast<double>(count);
  const double variance = sum_Nm2 / static_cast<double>(count - 4);
  const Eigen::Matrix4d covariance = variance * solver.solve(Eigen::Matrix4d::Identity());
  const auto estimate = [&](Eigen::Index i) -> InverseDynamics::Estimate {
    return {solution[i], std::sqrt(std::max(0.0, covariance(i, i)))};
  };
  return InverseDynamics{
      .armature_kg_m2 = estimate(0),
      .viscous_Nm_s_per_rad = estimate(1),
      .coulomb_Nm = estimate(2),
      .offset_Nm = estimate(3),
      .residual_Nm = std::sqrt(variance),
      .unresolved = std::sqrt(equations.scatter / (equations.drive_Nm2 - mean_Nm * equations.drive_Nm)),
      .sample_rate_hz = bench.sample_rate_hz,
      .samples = count};
}

}  // namespace pmg::calib
