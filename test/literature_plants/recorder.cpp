#include "recorder.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "joint.hpp"

namespace pmg::literature {

namespace {

constexpr double kPushStep_s = 1e-3;
constexpr double kMostDropouts = 0.01;  // of the samples
constexpr double kDropout_rad = 0.7;    // no joint moves by that within a sample
constexpr double kFurthest_rad = 2.6, kUsualMiss_rad = 0.6;
constexpr double kMains_hz = 50.0;

/// A torque that wanders: an Ornstein-Uhlenbeck process (1930).
class WanderingPush {
 public:
  WanderingPush(const Noise& noise, Draw draw) : noise_(noise), draw_(draw), push_Nm_(noise.push_Nm * draw_.normal()) {}
  double next(double h_s) {
    const double keeps = std::exp(-h_s / noise_.push_corner_s);
    push_Nm_ = keeps * push_Nm_ + std::sqrt(1.0 - keeps * keeps) * noise_.push_Nm * draw_.normal();
    return push_Nm_;
  }

 private:
  const Noise& noise_;
  Draw draw_;
  double push_Nm_;
};

class ReadingNoise {
 public:
  ReadingNoise(const Noise& noise, Draw draw) : noise_(noise), draw_(draw), phase_(draw_.uniform(0.0, 6.28)) {}
  double next(double t_s) {
    const double white = draw_.normal(), share = draw_.uniform(0.0, 1.0);
    switch (noise_.form) {
      case NoiseForm::kWhite:
        return noise_.sensor_rad * white;
      case NoiseForm::kLaplace:
        return noise_.sensor_rad / std::numbers::sqrt2 * std::copysign(std::log(1.0 - share), white);
      case NoiseForm::kHum:
        return noise_.sensor_rad * (0.7 * white + std::sin(2.0 * std::numbers::pi * kMains_hz * t_s + phase_));
      case NoiseForm::kWander:
        wander_ = 0.98 * wander_ + 0.2 * draw_.normal();
        return noise_.sensor_rad * (0.7 * white + 0.7 * wander_);
    }
    return 0.0;
  }

 private:
  const Noise& noise_;
  Draw draw_;
  double phase_, wander_ = 0.0;
};

/// Somebody else has the bus for a share of each period. The same in every run: what differed from repeat to repeat
/// would be noise to a bench.
bool lost(double share, double period_s, double t_s) {
  const double into = t_s / period_s - std::floor(t_s / period_s);
  return into > 1.0 - share;
}

/// What differs from run to run.
Machine machine_of_run(const Machine& machine, const Rig& rig, std::size_t index, Draw draw) {
  Machine m = machine;
  const RunDesign& design = rig.runs.at(index);
  const Load& load = rig.loads[design.load];
  m.body.load_inertia_kg_m2 = load.inertia_kg_m2 * rig.mass_factor[design.load];
  m.body.load_gravity_Nm = rig.horizontal ? 0.0 : load.gravity_Nm * rig.mass_factor[design.load];
  if (rig.horizontal) m.body.gravity_factor = m.body.more_gravity_Nm = 0.0;
  m.screw.length_m = load.length_m;
  const double homing = draw.normal(), grease = draw.normal();
  m.sensor.offset_rad += m.sensor.offset_spread_rad * homing;
  if (static_cast<double>(index) >= m.sensor.slip_at * rig.session_runs()) {
    m.sensor.offset_rad += m.sensor.slip_rad;
  }
  m.friction.coulomb_Nm *= std::max(0.1, 1.0 + m.friction.coulomb_spread * grease);
  return m;
}

/// How much of the session is over before the run: all of it before one that was asked for.
double share_of_session(const Rig& rig, std::size_t index) {
  return std::min(1.0, static_cast<double>(index) / rig.session_runs());
}

double temperature_C(const Rig& rig, std::size_t index) {
  return kReference_C + rig.warms_K * (1.0 - std::exp(-3.0 * share_of_session(rig, index)));
}

Recording commands(const Rig& rig, const Trajectory& t, const Load& load, double bus_V, Draw& draw) {
  Recording r;
  r.q_cmd_rad = t.q_rad;
  r.dq_cmd_rad_s = t.dq_rad_s;
  r.feed_forward = feed_forward(rig, t, load);
  for (std::size_t k = 0; k < t.q_rad.size(); ++k) {
    const double late = k == 0 ? 0.0 : draw.uniform(-0.5, 0.5) * rig.noise.jitter;
    r.t_s.push_back(1e-6 * std::round(1e6 * (static_cast<double>(k) + late) / rig.sample_rate_hz));
    r.bus_V.push_back(bus_V);
  }
  const double released_s = r.t_s.back() - t.released_s;
  for (const double t_s : r.t_s) r.enabled.push_back(t.released_s == 0.0 || t_s < released_s);
  return r;
}

Command command_at(const Rig& rig, const Recording& r, const Gains& gains, std::size_t k) {
  return {.q_rad = r.q_cmd_rad[k],
          .dq_rad_s = rig.commands_speed ? r.dq_cmd_rad_s[k] : 0.0,
          .feed_forward = r.feed_forward[k],
          .kp = gains.kp,
          .kd = gains.kd,
          .bus_V = r.bus_V[k],
          .enabled = r.enabled[k]};
}

void drop_out(const Rig& rig, Draw draw, std::vector<double>& q_rad) {
  const double each = std::min(kMostDropouts, rig.noise.dropouts_per_s / rig.sample_rate_hz);
  for (std::size_t k = 2; k + 2 < q_rad.size(); ++k) {
    if (!draw.chance(each)) continue;
    q_rad[k] += draw.sign() * draw.uniform(0.8, 2.0);
    k += 3;
  }
}

}  // namespace

Recording record(const Machine& machine, const Rig& rig, std::uint64_t seed, std::size_t index, std::uint64_t take) {
  // Each disturbance has a stream of its own: two machines meet the same, however differently they move.
  const std::uint64_t stream = 100000 + 1000 * take + 10 * index;
  const auto drawn = [&](std::uint64_t what) { return Draw(seed, stream + what); };
  const RunDesign& design = rig.runs.at(index);
  const Gains& gains = rig.gains[design.gains];
  Draw times = drawn(0), start = drawn(1);
  Recording r = commands(rig, rig.trajectories[design.trajectory], rig.loads[design.load],
                         rig.bus_V * (1.0 - rig.bus_fall * share_of_session(rig, index)), times);
  Joint joint(machine_of_run(machine, rig, index, drawn(2)), seed * 1009 + stream);
  joint.reset(rig.noise.start_rad * start.normal(), command_at(rig, r, gains, 0), temperature_C(rig, index));
  WanderingPush push(rig.noise, drawn(3));
  ReadingNoise noise(rig.noise, drawn(4));
  Draw thermometer = drawn(5);
  Command before = command_at(rig, r, gains, 0);
  for (std::size_t k = 0; k < r.t_s.size(); ++k) {
    const double reading = joint.reading_rad(noise.next(r.t_s[k]));
    const bool stale = k > 0 && lost(machine.sensor.loss, machine.sensor.loss_period_s, r.t_s[k]);
    r.q_rad.push_back(stale ? r.q_rad.back() : reading);
    r.temp_C.push_back(0.1 * std::round(10.0 * (temperature_C(rig, index) + 0.1 * thermometer.normal())));
    if (k + 1 == r.t_s.size()) break;
    Command command = command_at(rig, r, gains, k);
    if (lost(machine.command.loss, machine.command.loss_period_s, r.t_s[k])) {
      command.q_rad = before.q_rad;
      command.dq_rad_s = before.dq_rad_s;
    }
    joint.tell(command);
    before = command;
    const double period_s = (r.t_s[k + 1] - r.t_s[k]) * (1.0 - rig.noise.clock_share);
    const int pieces = std::max(1, static_cast<int>(std::round(period_s / kPushStep_s)));
    for (int i = 0; i < pieces; ++i) joint.advance(period_s / pieces, push.next(period_s / pieces));
  }
  drop_out(rig, drawn(6), r.q_rad);
  return r;
}

bool follows_its_commands(const Machine& machine, const Rig& rig, std::uint64_t seed) try {
  for (std::size_t i = 0; i < rig.runs.size(); ++i) {
    if (rig.runs[i].repeat > 0) continue;
    const Recording r = record(machine, rig, seed, i);
    double missed_rad = 0.0;
    for (std::size_t k = 0; k < r.q_rad.size(); ++k) {
      if (!(std::abs(r.q_rad[k]) < kFurthest_rad + 2.0)) return false;  // dropouts leap by 2
      missed_rad += std::abs(r.q_rad[k] - r.q_cmd_rad[k]);
    }
    if (missed_rad / static_cast<double>(r.q_rad.size()) > kUsualMiss_rad) return false;
  }
  return true;
} catch (const DoesNotConverge&) {
  return false;
}

double mean_absolute_difference_rad(const Recording& a, const Recording& b) {
  if (a.q_rad.size() != b.q_rad.size()) throw std::invalid_argument("recordings of different commands");
  double sum_rad = 0.0;
  for (std::size_t k = 0; k < a.q_rad.size(); ++k) {
    const double apart_rad = std::abs(a.q_rad[k] - b.q_rad[k]);
    if (apart_rad < kDropout_rad) sum_rad += apart_rad;
  }
  return sum_rad / static_cast<double>(a.q_rad.size());
}

}  // namespace pmg::literature
