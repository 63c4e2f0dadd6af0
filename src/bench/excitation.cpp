#include "bench/excitation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

namespace pmg::bench {

namespace {

constexpr double kRest_s = 0.5;  // at both ends of a trajectory
constexpr double kFade_s = 0.5;  // smooth segments begin and end with a ramp of this length
constexpr double kSweepFrom_Hz = 0.2, kSweepTo_Hz = 8.0;

/// Uniform random numbers that are the same with every standard library.
class UniformSource {
 public:
  explicit UniformSource(unsigned seed) : engine_(seed) {}
  double in(double lower, double upper) {
    return lower + (upper - lower) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }

 private:
  std::mt19937_64 engine_;
};

/// Commands between two rests, one per period, as shares of half the range, in [-1, 1].
class Drawing {
 public:
  Drawing(const ExcitationLimits& limits, unsigned seed)
      : limits_(limits),
        half_rad_(0.5 * (limits.upper_rad - limits.lower_rad)),
        most_per_s_(limits.speed_rad_s / half_rad_),
        random_(seed) {}

  void rest(double seconds) { hold(0.0, seconds); }

  void hold(double level, double seconds) { values_.insert(values_.end(), samples(seconds), level); }

  /// Alternates large steps to the other side and small steps: friction matters more in small steps.
  void steps(double seconds) {
    const std::size_t end = values_.size() + samples(seconds);
    double level = random_.in(-1.0, 1.0) < 0.0 ? 1e-9 : -1e-9;
    for (bool across = true; values_.size() < end; across = !across) {
      const double towards = level > 0.0 ? -1.0 : 1.0;
      level = across ? towards * random_.in(0.5, 1.0) : level + towards * random_.in(0.05, 0.3);
      hold(level, random_.in(0.3, 0.9));
    }
    values_.resize(end);
  }

  void sines(double seconds) {
    constexpr int kCount = 3;
    double frequency_Hz[kCount], share[kCount], phase[kCount];
    for (int i = 0; i < kCount; ++i) {
      frequency_Hz[i] = random_.in(0.25, 0.6) * std::pow(2.7, i);
      share[i] = random_.in(0.5, 1.0);
      phase[i] = random_.in(0.0, 2.0 * std::numbers::pi);
    }
    double height = 0.0, slope_per_s = 0.0;
    for (int i = 0; i < kCount; ++i) {
      height += share[i];
      slope_per_s += share[i] * (2.0 * std::numbers::pi * frequency_Hz[i] + 1.5 / kFade_s);
    }
    const double scale = std::min(1.0 / height, most_per_s_ / slope_per_s);
    smooth(seconds, [&](double t_s) {
      double sum = 0.0;
      for (int i = 0; i < kCount; ++i) {
        sum += share[i] * std::sin(2.0 * std::numbers::pi * frequency_Hz[i] * t_s + phase[i]);
      }
      return scale * sum;
    });
  }

  /// Full amplitude at low frequencies; at high frequencies the amplitude keeps to the speed limit.
  void sweep(double seconds) {
    const double growth = std::log(kSweepTo_Hz / kSweepFrom_Hz) / seconds;
    smooth(seconds, [&](double t_s) {
      const double frequency_Hz = kSweepFrom_Hz * std::exp(growth * t_s);
      const double turns = (frequency_Hz - kSweepFrom_Hz) / growth;
      // The slope of the envelope contributes to the speed.
      const double height =
          std::min(1.0, most_per_s_ / (2.0 * std::numbers::pi * frequency_Hz + growth + 1.5 / kFade_s));
      return height * std::sin(2.0 * std::numbers::pi * turns);
    });
  }

  /// Strokes to both sides at three speeds, the fastest first. Each speed gets a third of the time.
  void creep(double seconds) {
    constexpr double kSpeeds[] = {0.3, 0.1, 0.03};
    for (const double speed : kSpeeds) {
      const double way_per_s = speed * most_per_s_, third_s = seconds_of(samples(seconds / 3.0));
      const double reach = std::min(0.9, way_per_s * third_s / 4.0), quarter_s = reach / way_per_s;
      const std::size_t end = values_.size() + samples(third_s), start = values_.size();
      for (std::size_t k = 0; values_.size() < end; ++k) {
        const double quarters = std::fmod(seconds_of(k) / quarter_s, 4.0);
        values_.push_back(reach * (quarters < 1.0 ? quarters : quarters < 3.0 ? 2.0 - quarters : quarters - 4.0));
      }
      // Only whole strokes: the joint rests at the centre for the rest of the third.
      const double strokes_s = std::floor(third_s / (4.0 * quarter_s) + 1e-9) * 4.0 * quarter_s;
      const auto whole = static_cast<std::size_t>(std::ceil(strokes_s * limits_.rate_hz - 1e-9));
      std::fill(values_.begin() + static_cast<std::ptrdiff_t>(std::min(start + whole, end)), values_.end(), 0.0);
    }
  }

  double left_s() const { return std::max(0.0, limits_.seconds - kRest_s - seconds_of(values_.size())); }

  ExcitationTrajectory finished(const std::string& name) const {
    ExcitationTrajectory trajectory{name, {}};
    const double centre_rad = 0.5 * (limits_.lower_rad + limits_.upper_rad);
    for (const double value : values_) trajectory.q_cmd_rad.push_back(centre_rad + half_rad_ * value);
    return trajectory;
  }

 private:
  std::size_t samples(double seconds) const { return static_cast<std::size_t>(std::lround(seconds * limits_.rate_hz)); }
  double seconds_of(std::size_t count) const { return static_cast<double>(count) / limits_.rate_hz; }

  template <typename Value>
  void smooth(double seconds, Value&& value) {
    const std::size_t count = samples(seconds);
    for (std::size_t k = 0; k < count; ++k) {
      const double t_s = seconds_of(k), edge = std::clamp(std::min(t_s, seconds - t_s) / kFade_s, 0.0, 1.0);
      values_.push_back(edge * edge * (3.0 - 2.0 * edge) * value(t_s));
    }
  }

  ExcitationLimits limits_;
  double half_rad_, most_per_s_;
  UniformSource random_;
  std::vector<double> values_;
};

void expect(bool holds, const std::string& text) {
  if (!holds) throw std::invalid_argument("excitation: " + text);
}

void check(const ExcitationLimits& limits, const std::vector<ExcitationGains>& gains, int repeats) {
  expect(limits.lower_rad < limits.upper_rad,
         fmt::format("angles from {} to {} rad; expected a range that grows", limits.lower_rad, limits.upper_rad));
  expect(limits.speed_rad_s > 0.0, fmt::format("a speed of {} rad/s; expected one above 0", limits.speed_rad_s));
  expect(limits.rate_hz >= 20.0 && limits.rate_hz <= 10000.0,
         fmt::format("{} commands a second; expected 20 to 10000", limits.rate_hz));
  expect(limits.seconds >= 4.0 && limits.seconds <= 600.0,
         fmt::format("trajectories of {} s; expected 4 to 600", limits.seconds));
  expect(repeats >= 1, fmt::format("{} repeats; expected at least 1", repeats));
  expect(!gains.empty(), "no gains; expected at least one pair of kp and kd");
  for (const ExcitationGains& pair : gains) {
    expect(
        pair.kp_Nm_per_rad > 0.0 && pair.kd_Nm_s_per_rad >= 0.0,
        fmt::format("gains {},{}; expected kp above 0 and kd of at least 0", pair.kp_Nm_per_rad, pair.kd_Nm_s_per_rad));
  }
}

}  // namespace

const ExcitationTrajectory& Excitation::trajectory(const std::string& name) const {
  const auto found =
      std::find_if(trajectories.begin(), trajectories.end(), [&](const auto& t) { return t.name == name; });
  if (found == trajectories.end()) throw std::invalid_argument("excitation: no trajectory '" + name + "'");
  return *found;
}

ExcitationLimits excitation_limits(const model::Joint& joint, const ExcitationLimits& rate_and_seconds) {
  const double nearer_rad = std::min(joint.stand_rad - joint.lower_rad, joint.upper_rad - joint.stand_rad);
  const double reach_rad = std::min(0.5, 0.5 * nearer_rad);
  ExcitationLimits limits = rate_and_seconds;
  limits.lower_rad = joint.stand_rad - reach_rad;
  limits.upper_rad = joint.stand_rad + reach_rad;
  limits.speed_rad_s = joint.velocity_limit_rad_s / 3.0;
  return limits;
}

std::vector<ExcitationGains> excitation_gains(const model::Joint& joint) {
  const double kp = joint.kp_Nm_per_rad, kd = joint.kd_Nm_s_per_rad;
  return {{kp, kd}, {0.5 * kp, kd}, {0.5 * kp, 0.5 * kd}};
}

Excitation make_excitation(const ExcitationLimits& limits, const std::vector<ExcitationGains>& gains, int repeats,
                           unsigned seed) {
  check(limits, gains, repeats);
  Excitation excitation;
  excitation.rate_hz = limits.rate_hz;
  const auto add = [&](const char* name, auto&& draw) {
    Drawing drawing(limits, seed + 1000U * static_cast<unsigned>(excitation.trajectories.size()));
    drawing.rest(kRest_s);
    draw(drawing);
    drawing.rest(drawing.left_s() + kRest_s);
    excitation.trajectories.push_back(drawing.finished(name));
  };
  add("steps", [](Drawing& d) { d.steps(d.left_s()); });
  add("sines", [](Drawing& d) { d.sines(d.left_s()); });
  add("sweep", [](Drawing& d) { d.sweep(d.left_s()); });
  add("slow", [](Drawing& d) { d.creep(d.left_s()); });
  add("mixed", [](Drawing& d) {
    d.steps(0.5 * d.left_s());
    d.sines(d.left_s());
  });
  for (int repeat = 0; repeat < repeats; ++repeat) {
    for (const ExcitationGains& pair : gains) {
      for (const ExcitationTrajectory& trajectory : excitation.trajectories) {
        excitation.rows.push_back(
            {fmt::format("{}_kp{:g}_kd{:g}_r{}.csv", trajectory.name, pair.kp_Nm_per_rad, pair.kd_Nm_s_per_rad, repeat),
             trajectory.name, repeat, pair});
      }
    }
  }
  return excitation;
}

}  // namespace pmg::bench
