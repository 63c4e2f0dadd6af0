#include "robot_diagnosis/robot_samples.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "model/constants.hpp"

namespace pmg::robot_diagnosis {

namespace {

constexpr int kMargin = 8;  // ticks without samples at both ends: the reach, 3 * 25 ms, of the shorter low-pass

/// What is the same in every tick of a recording.
struct TickTiming {
  double period_s;
  const DriveSampling& drive;
  PathWeights position;                                   // mean over a tick
  std::vector<std::array<CommandInForce, 2>> in_force{};  // of each joint

  explicit TickTiming(const RobotRecording& recording)
      : period_s(recording.period_s), drive(recording.drive), position(drive.mean_position(0.0, 1.0, period_s)) {
    const auto joints = static_cast<int>(recording.ticks.front().state.q.size());
    for (int j = 0; j < joints; ++j) in_force.push_back(drive.in_force(j, period_s));
  }
};

struct TickMeans {
  RobotSample mean;

  TickMeans(const RobotTick& before, const RobotTick& at, const RobotTick& after, const TickTiming& timing) {
    const double period_s = timing.period_s;
    const auto between = [](const auto& a, const auto& b, double share) { return (a + share * (b - a)).eval(); };
    const auto path = [&](int j) {
      PathWeights p;
      p << before.state.q[j], at.state.q[j], after.state.q[j], period_s * before.state.dq[j], period_s * at.state.dq[j],
          period_s * after.state.dq[j];
      return p;
    };
    mean.t_s = at.t_s + 0.5 * period_s;
    // Mean speed from positions, not from speed readings: a held command makes joints ring at the tick rate, and a
    // speed that is always read at the same phase is wrong by up to a tenth.
    mean.dq = (after.state.q - at.state.q) / period_s;
    mean.ddq = (after.state.dq - at.state.dq) / period_s;
    mean.q = mean.spring_Nm = mean.damper_Nm = mean.feed_forward_Nm = JointVector::Zero(mean.dq.size());
    for (int j = 0; j < mean.q.size(); ++j) {
      const PathWeights p = path(j);
      mean.q[j] = timing.position.dot(p);
      const auto& parts = timing.in_force[static_cast<std::size_t>(j)];
      for (std::size_t i = 0; i < parts.size(); ++i) {
        const model::JointCommand& c = i == 0 ? before.command : at.command;
        mean.spring_Nm[j] += parts[i].share * c.kp[j] * (c.q[j] - parts[i].position.dot(p));
        mean.damper_Nm[j] += parts[i].share * c.kd[j] * (c.dq[j] - parts[i].speed.dot(p) / period_s);
        mean.feed_forward_Nm[j] += parts[i].share * c.tau_ff[j];
      }
    }
    const auto torque_Nm = [&](const model::JointCommand& c) {
      return (c.kp.cwiseProduct(c.q - mean.q) + c.kd.cwiseProduct(c.dq - mean.dq) + c.tau_ff).eval();
    };
    mean.late_Nm_per_s = (torque_Nm(before.command) - torque_Nm(at.command)) / period_s;
    mean.direction = JointVector::Zero(mean.dq.size());
    mean.omega_I = between(at.state.gyro_rad_s, after.state.gyro_rad_s, 0.5);
    mean.alpha_I = (after.state.gyro_rad_s - at.state.gyro_rad_s) / period_s;
    mean.specific_force_I = mean_of_readings(at.state.acceleration_m_s2, after.state.acceleration_m_s2,
                                             timing.drive.acceleration_share(period_s));
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

/// Older parts of a state move on by their age: linearly to the mean of the next tick.
void bring_to_one_moment(const DriveSampling& drive, double period_s, std::vector<TickMeans>& means) {
  const double share = drive.older_by_s / period_s;
  if (share <= 0.0) return;
  const auto move = [share](auto& value, const auto& next) { value += share * (next - value); };
  for (std::size_t k = 0; k + 1 < means.size(); ++k) {
    RobotSample& mean = means[k].mean;
    const RobotSample& next = means[k + 1].mean;
    for (JointVector RobotSample::*const part :
         {&RobotSample::q, &RobotSample::dq, &RobotSample::ddq, &RobotSample::spring_Nm, &RobotSample::damper_Nm,
          &RobotSample::feed_forward_Nm, &RobotSample::late_Nm_per_s}) {
      for (const int j : drive.older_joints) move((mean.*part)[j], (next.*part)[j]);
    }
    if (!drive.older_imu) continue;
    for (Eigen::Vector3d RobotSample::*const part :
         {&RobotSample::omega_I, &RobotSample::alpha_I, &RobotSample::specific_force_I, &RobotSample::up_I})
      move(mean.*part, next.*part);
  }
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
  if (ticks.size() < 3) return ripple;
  const TickTiming timing(recording);
  const auto mean_torque = [&](std::size_t k) {  // of the tick that begins at k
    const RobotSample mean = TickMeans(ticks[k > 0 ? k - 1 : k], ticks[k], ticks[k + 1], timing).mean;
    return (mean.spring_Nm + mean.damper_Nm + mean.feed_forward_Nm).eval();
  };
  // The accelerometer's moment, as seen from each joint's state.
  const DriveSampling& drive = recording.drive;
  JointVector lead_s = JointVector::Constant(ripple.front().size(), drive.older_imu ? -drive.older_by_s : 0.0);
  for (const int j : drive.older_joints) lead_s[j] += drive.older_by_s;
  JointVector sampled_s = (lead_s.array() - drive.step_s).matrix();
  for (const int j : drive.closed_by_bus) sampled_s[j] = lead_s[j] - drive.bus_loop_age_s - 0.5 * model::kBusPeriod_s;
  JointVector before = mean_torque(0);
  for (std::size_t k = 1; k + 1 < ticks.size(); ++k) {
    const model::JointCommand& command = ticks[k - 1].command;
    const model::RobotState& state = ticks[k].state;
    const JointVector q = state.q + sampled_s.cwiseProduct(state.dq);
    const JointVector last =
        command.kp.cwiseProduct(command.q - q) + command.kd.cwiseProduct(command.dq - state.dq) + command.tau_ff;
    const JointVector after = mean_torque(k);
    ripple[k] = last - 0.5 * (before + after) - (lead_s / recording.period_s).cwiseProduct(after - before);
    before = after;
  }
  return ripple;
}

Eigen::Vector3d mean_of_readings(const Eigen::Vector3d& at, const Eigen::Vector3d& after, double share) {
  return at + share * (after - at);
}

std::vector<RobotSample> robot_samples(const RobotRecording& recording, const SampleOptions& options) {
  const auto& ticks = recording.ticks;
  if (ticks.size() < 2 * kMargin + 3) return {};
  const TickTiming timing(recording);
  std::vector<TickMeans> means;
  means.reserve(ticks.size());
  for (std::size_t k = 1; k + 1 < ticks.size(); ++k) means.emplace_back(ticks[k - 1], ticks[k], ticks[k + 1], timing);
  const auto forces_I = options.specific_force_I;
  for (std::size_t k = 1; k < forces_I.size() && k <= means.size(); ++k)
    means[k - 1].mean.specific_force_I = forces_I[k];
  bring_to_one_moment(recording.drive, recording.period_s, means);
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
