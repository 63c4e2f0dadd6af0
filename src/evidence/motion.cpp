#include "evidence/motion.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

namespace pmg::evidence {

namespace {

constexpr double kNoMotion = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kSmallestReach = 2;  // five samples: a parabola has three coefficients

/// Slope [rad/s] and curvature [rad/s^2] at the sample `at` of a least-squares parabola through the valid samples from
/// first to last; NaN with fewer than four of them.
Eigen::Vector2d parabola(const bench::Recording& r, std::size_t first, std::size_t last, std::size_t at) {
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Eigen::Vector3d products = Eigen::Vector3d::Zero();
  const double scale_s = std::max(1e-9, r.t_s[last] - r.t_s[first]);
  int count = 0;
  for (std::size_t k = first; k <= last; ++k) {
    if (!r.valid[k]) continue;
    const double x = (r.t_s[k] - r.t_s[at]) / scale_s;
    const Eigen::Vector3d row(1.0, x, x * x);
    squares += row * row.transpose();
    products += row * (r.q_rad[k] - r.q_rad[at]);
    ++count;
  }
  if (count < 4) return {kNoMotion, kNoMotion};
  const Eigen::Vector3d c = squares.ldlt().solve(products);
  return {c[1] / scale_s, 2.0 * c[2] / (scale_s * scale_s)};
}

void differentiate(const bench::Recording& r, double window_s, Motion& motion) {
  const std::size_t count = r.t_s.size();
  const double step_s = (r.t_s.back() - r.t_s.front()) / static_cast<double>(count - 1);
  const std::size_t reach = std::max(kSmallestReach, static_cast<std::size_t>(std::lround(0.5 * window_s / step_s)));
  motion.dq_rad_s.assign(count, kNoMotion);
  motion.ddq_rad_s2.assign(count, kNoMotion);
  for (std::size_t k = reach; k + reach < count; ++k) {
    const Eigen::Vector2d d = parabola(r, k - reach, k + reach, k);
    motion.dq_rad_s[k] = d[0];
    motion.ddq_rad_s2[k] = d[1];
  }
}

}  // namespace

void compute_drive(const bench::Bench& bench, const bench::BenchRun& run, Motion& motion) {
  const bench::Recording& r = run.recording;
  const auto& p = bench.known.drive;
  motion.drive.clear();
  motion.at_limit.clear();
  for (std::size_t k = 0; k < r.t_s.size(); ++k) {
    const bool enabled = r.enabled.empty() || r.enabled[k];
    if (!r.torque_Nm.empty()) {
      motion.drive.push_back(r.torque_Nm[k]);
      motion.at_limit.push_back(false);
      continue;
    }
    double wish = p.kp_scale * run.kp * (r.q_cmd_rad[k] - r.q_rad[k]);
    if (run.kd != 0.0) {
      const double dq_cmd_rad_s = r.dq_cmd_rad_s.empty() ? 0.0 : r.dq_cmd_rad_s[k];
      wish += p.kd_scale * run.kd * (dq_cmd_rad_s - motion.dq_rad_s[k]);
    }
    const bool servo = bench.law == bench::DriveLaw::kServoVoltage;
    const double supply = !servo ? 1.0 : r.bus_V.empty() ? bench.supply_V : r.bus_V[k];
    if (!r.tau_ff_Nm.empty()) wish += bench.feed_forward_output(r.tau_ff_Nm[k], supply);
    const double given = std::isnan(wish) ? wish : std::clamp(wish, -p.limit, p.limit);
    motion.drive.push_back(enabled ? given * supply : 0.0);
    motion.at_limit.push_back(enabled && std::abs(given) >= 0.999 * p.limit);
  }
}

std::vector<std::size_t> command_steps(const bench::Recording& r, const StepOptions& options) {
  const auto [low, high] = std::minmax_element(r.q_cmd_rad.begin(), r.q_cmd_rad.end());
  const double smallest_rad = options.jump_share * (*high - *low);
  const auto move_rad = [&](std::size_t k) { return std::abs(r.q_cmd_rad[k] - r.q_cmd_rad[k - 1]); };
  std::vector<std::size_t> steps;
  for (std::size_t k = 1; k < r.q_cmd_rad.size(); ++k) {
    const double beside_rad =
        std::max(k > 1 ? move_rad(k - 1) : 0.0, k + 1 < r.q_cmd_rad.size() ? move_rad(k + 1) : 0.0);
    if (move_rad(k) > std::max(smallest_rad, options.jump_ratio * beside_rad) && move_rad(k) > 0.0) steps.push_back(k);
  }
  return steps;
}

Motion motion(const bench::Bench& bench, const bench::BenchRun& run, double window_s, const StepOptions& steps) {
  const bench::Recording& r = run.recording;
  Motion motion;
  differentiate(r, window_s, motion);
  compute_drive(bench, run, motion);
  motion.steps = command_steps(r, steps);
  std::size_t next = 0;
  double last_step_s = kNoMotion;
  for (std::size_t k = 0; k < r.t_s.size(); ++k) {
    motion.gravity_Nm.push_back(run.load.gravity_Nm * std::sin(r.q_rad[k] - run.load.hangs_at_rad));
    if (next < motion.steps.size() && motion.steps[next] == k) last_step_s = r.t_s[k], ++next;
    motion.since_step_s.push_back(r.t_s[k] - last_step_s);
  }
  return motion;
}

}  // namespace pmg::evidence
