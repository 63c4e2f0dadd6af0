#include "calib/single_joint.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <numeric>

#include "calib/simulated.hpp"
#include "calib/unknown.hpp"
#include "model/constants.hpp"

namespace pmg::calib {

namespace {

constexpr double kLost_rad = 1e3;  // a larger angle means divergence

std::atomic<std::uint64_t> rollouts{0}, steps_of_rollouts{0};

sim::ActuatorInput input_at(const bench::Bench& bench, const bench::BenchRun& run, std::size_t sample) {
  const bench::Recording& r = run.recording;
  sim::ActuatorInput input;
  input.q_rad = r.q_cmd_rad[sample];
  input.kp = run.kp;
  input.kd = run.kd;
  if (!r.dq_cmd_rad_s.empty()) input.dq_rad_s = r.dq_cmd_rad_s[sample];
  if (!r.tau_ff_Nm.empty()) input.feed_forward_Nm = r.tau_ff_Nm[sample];
  if (bench.law == bench::DriveLaw::kTorque) input.feed_forward_Nm = r.torque_Nm[sample];
  if (bench.law == bench::DriveLaw::kServoVoltage) input.supply = r.bus_V.empty() ? bench.supply_V : r.bus_V[sample];
  if (!r.enabled.empty()) input.enabled = r.enabled[sample];
  if (!r.temp_C.empty())
    input.temperature_C = r.temp_C[sample];
  else if (run.temp_C)
    input.temperature_C = *run.temp_C;
  return input;
}

/// Resting position before the command first changes: the mean reading, or the first one if the readings drift by more
/// than three deviations of their noise. The error of a single noisy reading would preload friction by gain times
/// noise.
double resting_reading_rad(const bench::Recording& r) {
  std::size_t count = 0;
  while (count < r.q_rad.size() && r.valid[count] && r.q_cmd_rad[count] == r.q_cmd_rad.front()) ++count;
  const std::size_t half = count / 2;
  if (half < 2) return r.q_rad.front();
  double means_rad[2], squares_rad2 = 0.0;
  for (std::size_t h = 0; h < 2; ++h) {
    const auto begin = r.q_rad.begin() + static_cast<std::ptrdiff_t>(h * half);
    const auto end = begin + static_cast<std::ptrdiff_t>(half);
    means_rad[h] = std::accumulate(begin, end, 0.0) / static_cast<double>(half);
    for (auto reading = begin; reading != end; ++reading) squares_rad2 += std::pow(*reading - means_rad[h], 2);
  }
  const double noise_rad = std::sqrt(squares_rad2 / static_cast<double>(2 * half - 2));
  const double drift_rad = std::abs(means_rad[1] - means_rad[0]);
  if (drift_rad > 3.0 * noise_rad * std::sqrt(2.0 / static_cast<double>(half))) return r.q_rad.front();
  return 0.5 * (means_rad[0] + means_rad[1]);
}

}  // namespace

Simulated simulated() noexcept { return {rollouts, steps_of_rollouts}; }

double simulation_step_s(const bench::Bench& bench) {
  return std::min(model::kBusPeriod_s, 0.25 / bench.sample_rate_hz);
}

JointModel after_the_slip(JointModel model) {
  model.actuator.sensor.zero_offset_rad += model.zero_slip_rad;
  model.zero_slip_rad = 0.0;
  return model;
}

SingleJoint::SingleJoint(const bench::Bench& bench, bench::BenchRun run, double step_s)
    : run_(std::move(run)), step_s_(step_s), start_reading_rad_(resting_reading_rad(run_.recording)) {
  const bench::Recording& r = run_.recording;
  for (std::size_t s = 0; s < r.t_s.size(); ++s) inputs_.push_back(input_at(bench, run_, s));
  const double start_s = r.t_s.front();
  const auto steps = static_cast<std::size_t>(std::ceil((r.t_s.back() - start_s) / step_s - 1e-9));
  std::size_t sample = 0;
  for (std::size_t k = 0; k < steps; ++k) {
    const double t_s = start_s + static_cast<double>(k) * step_s + 1e-9;
    while (sample + 1 < r.t_s.size() && r.t_s[sample + 1] <= t_s) ++sample;
    sample_of_step_.push_back(sample);
    double q_cmd_rad = r.q_cmd_rad[sample];
    if (bench.linear_hold && sample + 1 < r.t_s.size()) {
      const double share = (t_s - r.t_s[sample]) / (r.t_s[sample + 1] - r.t_s[sample]);
      q_cmd_rad += share * (r.q_cmd_rad[sample + 1] - q_cmd_rad);
    }
    q_cmd_of_step_rad_.push_back(q_cmd_rad);
  }
  for (const double t_s : r.t_s) {
    const double position = std::max(0.0, (t_s - start_s) / step_s - 1e-9);
    const std::size_t step = std::min(static_cast<std::size_t>(position), steps - 1);
    place_of_sample_.push_back({step, std::clamp((t_s - start_s) / step_s - static_cast<double>(step), 0.0, 1.0)});
  }
}

sim::ActuatorInput SingleJoint::input(std::size_t step) const {
  sim::ActuatorInput input = inputs_[sample_of_step_[step]];
  input.q_rad = q_cmd_of_step_rad_[step];
  return input;
}

/// Of a sensor before an elastic transmission the reading is that of a motor which is ahead of its joint by what the
/// load winds there, and the load depends on the joint's angle. Near the angle at which the load hangs, the motor is
/// within the play, and the load hangs there. Elsewhere the joint is on the motor's side of that angle: halving finds
/// it.
SingleJoint::Start SingleJoint::start(const JointModel& model) const {
  constexpr double kTurn_rad = 2.0 * std::numbers::pi;
  constexpr int kHalvings = 40;  // of at most half a turn: far below any sensor's quantum
  const double motor_rad = sim::ActuatorModel::joint_rad(model.actuator, start_reading_rad_, 0.0);
  const double on_motor = model.actuator.sensor.on_motor, weight_Nm = load(model).gravity_Nm;
  const auto load_Nm = [&](double q_rad) { return weight_Nm * std::sin(q_rad - run_.load.hangs_at_rad); };
  if (on_motor == 0.0 || weight_Nm == 0.0) return {motor_rad, load_Nm(motor_rad)};
  const double lowest_rad = run_.load.hangs_at_rad + (weight_Nm > 0.0 ? 0.0 : 0.5 * kTurn_rad);
  const double hangs_rad = lowest_rad + kTurn_rad * std::round((motor_rad - lowest_rad) / kTurn_rad);
  const double slack_rad = (motor_rad - hangs_rad) / on_motor;
  if (std::abs(slack_rad) <= 0.5 * model.actuator.transmission.backlash_rad) return {hangs_rad, 0.0, slack_rad};
  double low_rad = hangs_rad, high_rad = motor_rad;
  for (int halving = 0; halving < kHalvings; ++halving) {
    const double q_rad = 0.5 * (low_rad + high_rad);
    const double foreseen_rad = sim::ActuatorModel::joint_rad(model.actuator, start_reading_rad_, load_Nm(q_rad));
    ((q_rad < foreseen_rad) == (high_rad > low_rad) ? low_rad : high_rad) = q_rad;
  }
  return {high_rad, load_Nm(high_rad)};
}

bench::JointLoad SingleJoint::load(const JointModel& model) const {
  const double gravity_Nm =
      run_.load.gravity_Nm == 0.0 ? 0.0 : run_.load.gravity_Nm * model.gravity_scale + model.more_gravity_Nm;
  return {run_.load.inertia_kg_m2 * model.inertia_scale + model.more_inertia_kg_m2, gravity_Nm, run_.load.hangs_at_rad};
}

SingleJoint SingleJoint::beginning(double seconds) const {
  SingleJoint found = *this;
  bench::Recording& r = found.run_.recording;
  const auto end = std::upper_bound(r.t_s.begin(), r.t_s.end(), r.t_s.front() + seconds);
  const auto samples = static_cast<std::size_t>(std::max<std::ptrdiff_t>(2, end - r.t_s.begin()));
  if (samples >= r.t_s.size()) return found;
  for (std::vector<double>* column : {&r.t_s, &r.q_cmd_rad, &r.q_rad, &r.dq_cmd_rad_s, &r.dq_rad_s, &r.tau_ff_Nm,
                                      &r.torque_Nm, &r.bus_V, &r.drive_V, &r.temp_C})
    column->resize(std::min(column->size(), samples));
  r.enabled.resize(std::min(r.enabled.size(), samples));
  r.valid.resize(samples);
  found.inputs_.resize(samples);
  found.place_of_sample_.erase(found.place_of_sample_.begin() + static_cast<std::ptrdiff_t>(samples),
                               found.place_of_sample_.end());
  const std::size_t steps = found.place_of_sample_.back().step + 1;
  found.sample_of_step_.resize(steps);
  found.q_cmd_of_step_rad_.resize(steps);
  return found;
}

JointModel SingleJoint::of_run(JointModel model) const {
  for (const bench::AssemblyDifference& differs : run_.differs) {
    const double sum = value(model, differs.parameter) + differs.amount;
    set(model, differs.parameter, std::clamp(sum, differs.lower, differs.upper));
  }
  if (run_.place < model.zero_slip_at) model.zero_slip_rad = 0.0;
  return after_the_slip(model);
}

template <typename Seen>
void SingleJoint::simulate(const JointModel& of_all, Seen&& seen) const {
  const JointModel model = of_run(of_all);
  sim::ActuatorModel actuator(model.actuator, step_s_);
  const Start begin = start(model);
  double q_rad = begin.q_rad, dq_rad_s = 0.0;
  const bench::JointLoad load = this->load(model);
  const double inertia_kg_m2 = load.inertia_kg_m2 + actuator.joint_armature_kg_m2();
  sim::ActuatorInput now;
  std::size_t told_sample = inputs_.size();
  const auto tell = [&](std::size_t step) {
    if (sample_of_step_[step] != told_sample) {  // several steps share a sample's input
      told_sample = sample_of_step_[step];
      now = inputs_[told_sample];
      now.feed_forward_Nm *= model.feed_forward_scale;
    }
    now.q_rad = q_cmd_of_step_rad_[step];
  };
  tell(0);
  actuator.reset_at_rest(now, q_rad, begin.load_Nm, begin.slack_rad);
  rollouts.fetch_add(1, std::memory_order_relaxed);
  steps_of_rollouts.fetch_add(sample_of_step_.size(), std::memory_order_relaxed);
  std::size_t sample = 0;
  for (std::size_t k = 0; k < sample_of_step_.size(); ++k) {
    tell(k);
    now.external_Nm = load.gravity_Nm != 0.0 ? -load.gravity_Nm * std::sin(q_rad - load.hangs_at_rad) : 0.0;
    const sim::ActuatorTorque drive = actuator.step(now, q_rad, dq_rad_s);
    const double torque_Nm = drive.torque_Nm + now.external_Nm;
    dq_rad_s += step_s_ * torque_Nm / (inertia_kg_m2 - step_s_ * drive.slope_Nm_s_per_rad);
    const double before_rad = q_rad;
    q_rad += step_s_ * dq_rad_s;
    if (!(std::abs(q_rad) < kLost_rad)) q_rad = std::copysign(kLost_rad, q_rad), dq_rad_s = 0.0;
    while (sample < place_of_sample_.size() && place_of_sample_[sample].step == k) {
      const double share = place_of_sample_[sample].share;
      seen(sample, actuator.reading_rad(before_rad + share * (q_rad - before_rad), share));
      ++sample;
    }
  }
}

std::vector<double> SingleJoint::rollout(const JointModel& model) const {
  std::vector<double> reading_rad(place_of_sample_.size());
  simulate(model, [&](std::size_t sample, double reading) { reading_rad[sample] = reading; });
  return reading_rad;
}

RolloutError SingleJoint::error(const JointModel& model) const {
  RolloutError error;
  simulate(model, [&](std::size_t sample, double reading) {
    if (!run_.recording.valid[sample]) return;
    ++error.samples;
    const double miss_rad = reading - run_.recording.q_rad[sample];
    error.sum_of_squares_rad2 += miss_rad * miss_rad;
    error.sum_of_absolutes_rad += std::abs(miss_rad);
  });
  return error;
}

}  // namespace pmg::calib
