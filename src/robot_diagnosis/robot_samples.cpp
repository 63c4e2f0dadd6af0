#include "robot_diagnosis/robot_samples.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pmg::robot_diagnosis {

namespace {

constexpr int kMargin = 8;  // ticks without samples at both ends: the reach, 3 * 25 ms, of the shorter low-pass

struct TickMeans {
  RobotSample mean;

  TickMeans(const RobotTick& before, const RobotTick& at, const RobotTick& after, double period_s,
            const DriveSampling& drive) {
    const auto between = [](const auto& a, const auto& b, double share) { return (a + share * (b - a)).eval(); };
    mean.t_s = at.t_s + 0.5 * period_s;
    mean.q = between(at.state.q, after.state.q, drive.position_share(period_s)) +
             drive.speed_share(period_s) * period_s * (at.state.dq - after.state.dq);
    // Mean speed from positions, not from speed readings: a held command makes joints ring at the tick rate, and a
    // speed that is always read at the same phase is wrong by up to a tenth.
    mean.dq = (after.state.q - at.state.q) / period_s;
    mean.ddq = (after.state.dq - at.state.dq) / period_s;
    const auto spring = [&](const model::JointCommand& c) { return (c.kp.array() * (c.q - mean.q).array()).matrix(); };
    const auto damper = [&](const model::JointCommand& c) {
      return (c.kd.array() * (c.dq - mean.dq).array()).matrix();
    };
    mean.spring_Nm = spring(at.command);
    mean.damper_Nm = damper(at.command);
    mean.feed_forward_Nm = at.command.tau_ff;
    mean.late_Nm_per_s = (spring(before.command) + damper(before.command) + before.command.tau_ff - mean.spring_Nm -
                          mean.damper_Nm - mean.feed_forward_Nm) /
                         period_s;
    mean.direction = JointVector::Zero(mean.dq.size());
    mean.omega_I = between(at.state.gyro_rad_s, after.state.gyro_rad_s, 0.5);
    mean.alpha_I = (after.state.gyro_rad_s - at.state.gyro_rad_s) / period_s;
    mean.specific_force_I =
        mean_of_readings(at.state.acceleration_m_s2, after.state.acceleration_m_s2, drive.acceleration_share(period_s));
    const auto up = [](const model::RobotState& s) {
      return (s.orientation_WI.conjugate() * Eigen::Vector3d::UnitZ()).eval();
    };
    mean.up_I = between(up(at.state), up(after.state), 0.5);
  }
};

void add(const RobotSample& from, double weight, RobotSample& to) {
  to.t_s += weight * from.t_s;
  to.q += weight * from.q;
  to.dq += weight * from.dq;
  to.ddq += weight * from.ddq;
  to.spring_Nm += weight * from.spring_Nm;
  to.damper_Nm += weight * from.damper_Nm;
  to.feed_forward_Nm += weight * from.feed_forward_Nm;
  to.direction += weight * from.direction;
  to.late_Nm_per_s += weight * from.late_Nm_per_s;
  to.omega_I += weight * from.omega_I;
  to.alpha_I += weight * from.alpha_I;
  to.specific_force_I += weight * from.specific_force_I;
  to.up_I += weight * from.up_I;
}

RobotSample zero(int joints) {
  RobotSample sample;
  for (JointVector* v : {&sample.q, &sample.dq, &sample.ddq, &sample.spring_Nm, &sample.damper_Nm,
                         &sample.feed_forward_Nm, &sample.direction, &sample.late_Nm_per_s})
    v->setZero(joints);
  for (Eigen::Vector3d* v : {&sample.omega_I, &sample.alpha_I, &sample.specific_force_I, &sample.up_I}) v->setZero();
  return sample;
}

/// Weights of a Gaussian low-pass, three deviations to each side.
std::vector<double> weights(double deviation_s, double period_s) {
  const int reach = static_cast<int>(std::ceil(3.0 * deviation_s / period_s));
  std::vector<double> w;
  for (int i = -reach; i <= reach; ++i) {
    const double x = i * period_s / deviation_s;
    w.push_back(std::exp(-0.5 * x * x));
  }
  const double sum = std::accumulate(w.begin(), w.end(), 0.0);
  for (double& value : w) value /= sum;
  return w;
}

/// Calls add(k', weight) for the ticks around tick k of `count`. Beyond the ends the first and the last tick repeat.
template <typename Add>
void around(int k, int count, const std::vector<double>& w, Add&& add) {
  const auto reach = static_cast<int>(w.size() / 2);
  for (int i = -reach; i <= reach; ++i)
    add(static_cast<std::size_t>(std::clamp(k + i, 0, count - 1)), w[static_cast<std::size_t>(i + reach)]);
}

/// Directions of motion from the low-passed speed: encoder noise would flip a slow joint's direction between ticks.
void find_directions(double period_s, const SampleOptions& options, std::vector<TickMeans>& means) {
  const std::vector<double> w = weights(options.direction_low_pass_s, period_s);
  const auto count = static_cast<int>(means.size());
  for (int k = 0; k < count; ++k) {
    JointVector dq = JointVector::Zero(means.front().mean.dq.size());
    around(k, count, w, [&](std::size_t at, double weight) { dq += weight * means[at].mean.dq; });
    means[static_cast<std::size_t>(k)].mean.direction = (dq / options.turning_rad_s).array().tanh();
  }
}

}  // namespace

std::vector<JointVector> torque_ripple(const RobotRecording& recording) {
  const auto& ticks = recording.ticks;
  std::vector<JointVector> ripple;
  if (ticks.empty()) return ripple;
  ripple.assign(ticks.size(), JointVector::Zero(ticks.front().state.q.size()));
  const auto mean_torque = [&](std::size_t k) {  // of the tick that begins at k
    const RobotSample mean = TickMeans(ticks[k], ticks[k], ticks[k + 1], recording.period_s, recording.drive).mean;
    return (mean.spring_Nm + mean.damper_Nm + mean.feed_forward_Nm).eval();
  };
  for (std::size_t k = 1; k + 1 < ticks.size(); ++k) {
    const model::JointCommand& command = ticks[k - 1].command;
    const model::RobotState& state = ticks[k].state;
    const JointVector q = state.q - recording.drive.step_s * state.dq;
    const JointVector last =
        command.kp.cwiseProduct(command.q - q) + command.kd.cwiseProduct(command.dq - state.dq) + command.tau_ff;
    ripple[k] = last - 0.5 * (mean_torque(k - 1) + mean_torque(k));
  }
  return ripple;
}

Eigen::Vector3d mean_of_readings(const Eigen::Vector3d& at, const Eigen::Vector3d& after, double share) {
  return at + share * (after - at);
}

std::vector<RobotSample> robot_samples(const RobotRecording& recording, const SampleOptions& options) {
  const auto& ticks = recording.ticks;
  if (ticks.size() < 2 * kMargin + 3) return {};
  std::vector<TickMeans> means;
  means.reserve(ticks.size());
  for (std::size_t k = 1; k + 1 < ticks.size(); ++k)
    means.emplace_back(ticks[k - 1], ticks[k], ticks[k + 1], recording.period_s, recording.drive);
  const auto forces_I = options.specific_force_I;
  for (std::size_t k = 1; k < forces_I.size() && k <= means.size(); ++k)
    means[k - 1].mean.specific_force_I = forces_I[k];
  find_directions(recording.period_s, options, means);
  const std::vector<double> w = weights(options.low_pass_s, recording.period_s);
  const auto joints = static_cast<int>(ticks.front().state.q.size()), count = static_cast<int>(means.size());
  std::vector<RobotSample> samples;
  for (int k = kMargin; k + kMargin < count; k += options.ticks_per_sample) {
    RobotSample sample = zero(joints);
    around(k, count, w, [&](std::size_t at, double weight) { add(means[at].mean, weight, sample); });
    sample.t_s = means[static_cast<std::size_t>(k)].mean.t_s;
    sample.up_I.normalize();
    samples.push_back(std::move(sample));
  }
  return samples;
}

}  // namespace pmg::robot_diagnosis
