#include "evidence/torque_balance.hpp"

#include <algorithm>
#include <cmath>

#include "bench/noise_floor.hpp"
#include "evidence/motion.hpp"

namespace pmg::evidence {

namespace {

/// Speed below which its sign is unknown: still_deviations n of a fitted slope, n noise / (T sqrt(sum k^2)) with the
/// sample time T and k = -reach..reach.
double still_rad_s(const bench::Recording& r, double sample_s, const BalanceOptions& options) {
  const double reach = std::max(2.0, std::round(0.5 * options.speed_window_s / sample_s));
  const double squares = reach * (reach + 1.0) * (2.0 * reach + 1.0) / 3.0;
  return options.still_deviations * bench::sensor_noise_rad(r) / (sample_s * std::sqrt(squares));
}

/// The speed that one sample in 50 exceeds.
double usual_fastest(const std::vector<double>& speeds_rad_s) {
  std::vector<double> known;
  for (const double speed : speeds_rad_s) {
    if (std::isfinite(speed)) known.push_back(std::abs(speed));
  }
  if (known.empty()) return 0.0;
  const auto place = known.begin() + static_cast<std::ptrdiff_t>(known.size() - 1 - known.size() / 50);
  std::nth_element(known.begin(), place, known.end());
  return *place;
}

/// Mean of the command between each sample and the next: held, interpolated, or followed at a limited rate.
std::vector<double> means(const bench::Bench& bench, const bench::Recording& r, double rate_limit_rad_s) {
  std::vector<double> found;
  double at_rad = r.q_cmd_rad.front();
  for (std::size_t k = 0; k + 1 < r.t_s.size(); ++k) {
    const double here_rad = r.q_cmd_rad[k], next_rad = bench.linear_hold ? r.q_cmd_rad[k + 1] : here_rad;
    if (!std::isfinite(rate_limit_rad_s)) {
      found.push_back(0.5 * (here_rad + next_rad));
      continue;
    }
    const double whole_s = r.t_s[k + 1] - r.t_s[k];
    const double moving_s = std::min(whole_s, std::abs(next_rad - at_rad) / rate_limit_rad_s);
    const double end_rad = at_rad + std::copysign(rate_limit_rad_s * moving_s, next_rad - at_rad);
    found.push_back((0.5 * (at_rad + end_rad) * moving_s + end_rad * (whole_s - moving_s)) / whole_s);
    at_rad = end_rad;
  }
  return found;
}

}  // namespace

TorqueBalance::TorqueBalance(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs,
                             const BalanceOptions& options, While when)
    : bench_(&bench), source_(&runs), options_(options), when_(when), shaped_(bench.law != bench::DriveLaw::kTorque) {
  sample_s_ = 1.0 / bench.sample_rate_hz;
  const std::size_t count = std::max(static_cast<std::size_t>(options_.fewest_points),
                                     static_cast<std::size_t>(std::lround(options_.window_s / sample_s_)));
  sample_weights(count);
  for (const bench::BenchRun& run : runs) read(run);
  shape({});
  for (std::size_t i = 0; i < runs_.size(); ++i) find_windows(i);
}

/// Sums over samples miss the integrals by a share of 1 / count^2, and a constant speed would pass for an acceleration:
/// at 20 points a window viscous friction was wrong by 0.4/s times the inertia. So the sampled weights get the moments
/// that the integrals have: sum w = 1, sum w' t = -1, sum w'' = 0, sum w'' t^2 = 2. The others are 0 by symmetry.
void TorqueBalance::sample_weights(std::size_t count) {
  const double half_s = 0.5 * static_cast<double>(count) * sample_s_;
  double sum = 0.0, of_speed = 0.0, mean_2 = 0.0, of_acceleration = 0.0;
  std::vector<double> times_s;
  for (std::size_t k = 0; k < count; ++k) {
    times_s.push_back((static_cast<double>(k) + 0.5) * sample_s_ - half_s);
    const double x = times_s.back() / half_s, y = 1.0 - x * x;
    weight_.push_back(y * y * y);
    weight_1_.push_back(-6.0 * x * y * y / half_s);
    weight_2_.push_back((-6.0 * y * y + 24.0 * x * x * y) / (half_s * half_s));
    sum += weight_.back();
    of_speed += weight_1_.back() * times_s.back();
    mean_2 += weight_2_.back() / static_cast<double>(count);
  }
  for (std::size_t k = 0; k < count; ++k) of_acceleration += (weight_2_[k] - mean_2) * times_s[k] * times_s[k];
  for (std::size_t k = 0; k < count; ++k) {
    weight_[k] /= sum;
    weight_1_[k] /= -of_speed;
    weight_2_[k] = 2.0 * (weight_2_[k] - mean_2) / of_acceleration;
  }
}

void TorqueBalance::read(const bench::BenchRun& run) {
  const bench::Recording& r = run.recording;
  const Motion m = motion(*bench_, run, options_.speed_window_s);
  const double fastest_rad_s = usual_fastest(m.dq_rad_s);
  fastest_rad_s_ = std::max(fastest_rad_s_, fastest_rad_s);
  const double still = std::max(still_rad_s(r, sample_s_, options_), options_.still_share * fastest_rad_s);
  std::vector<BalancePoint> points(r.t_s.size() - 1);
  std::vector<bool> usable(points.size());
  const bool convertible = std::all_of(r.tau_ff_Nm.begin(), r.tau_ff_Nm.end(), [&](double tau_Nm) {
    return std::isfinite(bench_->feed_forward_output(tau_Nm, 1.0));
  });
  const std::vector<double>& output = r.torque_Nm.empty() ? r.drive_V : r.torque_Nm;
  const double per_unit_Nm = r.torque_Nm.empty() ? bench_->known.drive.torque_per_unit_Nm : 1.0;
  const bool held = bench_->law == bench::DriveLaw::kTorque;  // a command; other torques are measured
  for (std::size_t k = 0; k < points.size(); ++k) {
    BalancePoint& p = points[k];
    p.q_rad = 0.5 * (r.q_rad[k] + r.q_rad[k + 1]);
    p.dq_rad_s = 0.5 * (m.dq_rad_s[k] + m.dq_rad_s[k + 1]);
    p.direction = std::clamp(p.dq_rad_s / std::max(still, 1e-12), -1.0, 1.0);
    p.gravity_Nm = run.load.gravity_Nm * std::sin(p.q_rad - run.load.hangs_at_rad);
    p.hanging_Nm = run.load.gravity_Nm * std::cos(p.q_rad - run.load.hangs_at_rad);
    p.load_Nm = p.gravity_Nm + run.load.inertia_kg_m2 * 0.5 * (m.ddq_rad_s2[k] + m.ddq_rad_s2[k + 1]);
    p.recorded_Nm =
        output.empty() ? std::nan("") : per_unit_Nm * (held ? output[k] : 0.5 * (output[k] + output[k + 1]));
    p.temp_C = r.temp_C.empty() ? run.temp_C.value_or(std::nan("")) : r.temp_C[k];
    const bool on = r.enabled.empty() || (r.enabled[k] && r.enabled[k + 1]);
    const bool off = !r.enabled.empty() && !r.enabled[k] && !r.enabled[k + 1];
    usable[k] = (when_ == While::kOn ? on : off) && r.valid[k] && r.valid[k + 1] && std::isfinite(p.load_Nm) &&
                std::isfinite(p.dq_rad_s) && convertible;
  }
  runs_.push_back(std::move(points));
  usable_.push_back(std::move(usable));
}

void TorqueBalance::shape(const CommandShape& shape) {
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    const bench::BenchRun& run = (*source_)[i];
    const bench::Recording& r = run.recording;
    const auto& p = bench_->known.drive;
    const std::vector<double> command_rad = means(*bench_, r, shape.rate_limit_rad_s);
    double last_turn_s = -1e9, last_drive = 0.0;
    const auto delayed = [&](const std::vector<double>& values, std::size_t k) {
      const double place = std::max(0.0, static_cast<double>(k) - shape.delay_s / sample_s_);
      const auto below = std::min(static_cast<std::size_t>(place), values.size() - 1);
      const double share = place - static_cast<double>(below);
      return values[below] + share * (values[std::min(below + 1, values.size() - 1)] - values[below]);
    };
    for (std::size_t k = 0; k < runs_[i].size(); ++k) {
      BalancePoint& point = runs_[i][k];
      const bool servo = bench_->law == bench::DriveLaw::kServoVoltage;
      const double supply = !servo ? 1.0 : r.bus_V.empty() ? bench_->supply_V : r.bus_V[k];
      point.error_rad = delayed(command_rad, k) - point.q_rad;
      point.error_drive = p.kp_scale * run.kp * point.error_rad * supply;
      if (!r.torque_Nm.empty()) {
        point.drive = r.torque_Nm[k];
      } else {
        double wish = p.kp_scale * run.kp * point.error_rad;
        if (run.kd != 0.0) {
          const double command_rad_s = r.dq_cmd_rad_s.empty() ? 0.0 : delayed(r.dq_cmd_rad_s, k);
          wish += p.kd_scale * run.kd * (command_rad_s - (r.q_rad[k + 1] - r.q_rad[k]) / sample_s_);
        }
        if (!r.tau_ff_Nm.empty()) wish += bench_->feed_forward_output(delayed(r.tau_ff_Nm, k), supply);
        point.drive = std::clamp(wish, -p.limit, p.limit) * supply;
      }
      if (point.drive * last_drive < 0.0) last_turn_s = r.t_s[k];
      if (point.drive != 0.0) last_drive = point.drive;
      point.since_turn_s = r.t_s[k] - last_turn_s;
    }
  }
}

void TorqueBalance::find_windows(std::size_t run) {
  const std::vector<BalancePoint>& points = runs_[run];
  const std::size_t count = weight_.size();
  for (std::size_t first = 0; first + count <= points.size(); first += std::max<std::size_t>(1, count / 2)) {
    std::size_t moving = 0;
    bool usable = true;
    for (std::size_t k = first; k < first + count; ++k) {
      usable = usable && usable_[run][k];
      moving += std::abs(points[k].direction) >= 1.0 ? 1 : 0;
    }
    if (usable && static_cast<double>(moving) >= options_.moving_share * static_cast<double>(count)) {
      windows_.push_back({run, first});
    }
  }
}

Column TorqueBalance::drive() const {
  return integral([](const BalancePoint& p) { return p.drive; });
}

Column TorqueBalance::acceleration_rad_s2() const {
  Column column(static_cast<Eigen::Index>(windows_.size()));
  for (std::size_t i = 0; i < windows_.size(); ++i) {
    const BalancePoint* points = &runs_[windows_[i].run][windows_[i].first];
    double sum = 0.0;
    for (std::size_t k = 0; k < weight_.size(); ++k) sum += weight_2_[k] * points[k].q_rad;
    column[static_cast<Eigen::Index>(i)] = sum;
  }
  return column;
}

Column TorqueBalance::speed_rad_s() const {
  Column column(static_cast<Eigen::Index>(windows_.size()));
  for (std::size_t i = 0; i < windows_.size(); ++i) {
    const BalancePoint* points = &runs_[windows_[i].run][windows_[i].first];
    double sum = 0.0;
    for (std::size_t k = 0; k < weight_.size(); ++k) sum -= weight_1_[k] * points[k].q_rad;
    column[static_cast<Eigen::Index>(i)] = sum;
  }
  return column;
}

Column TorqueBalance::load_inertia_Nm() const {
  Column column = acceleration_rad_s2();
  for (std::size_t i = 0; i < windows_.size(); ++i) {
    column[static_cast<Eigen::Index>(i)] *= (*source_)[windows_[i].run].load.inertia_kg_m2;
  }
  return column;
}

std::vector<int> TorqueBalance::clusters(bool whole_runs) const {
  std::vector<int> found;
  int cluster = -1;
  std::size_t run = 0, second = 0;
  for (const Window& window : windows_) {
    const auto this_second = whole_runs ? 0 : static_cast<std::size_t>(static_cast<double>(window.first) * sample_s_);
    if (cluster < 0 || window.run != run || this_second != second) ++cluster;
    run = window.run;
    second = this_second;
    found.push_back(cluster);
  }
  return found;
}

}  // namespace pmg::evidence
