#include "effects/unknowns.hpp"

#include <algorithm>
#include <cmath>

#include "fitting/statistics.hpp"

namespace pmg::effects {

namespace {

using calib::JointModel;

/// Nominal drive torque at a recorded position, kp e clamped to the drive's limit, without delays; or the recorded
/// torque.
double wished_torque_Nm(const bench::BenchRun& run, std::size_t k, double supply, const JointModel& model) {
  const auto& drive = model.actuator.drive;
  const bench::Recording& r = run.recording;
  if (!r.enabled.empty() && !r.enabled[k]) return 0.0;
  if (!r.torque_Nm.empty()) return r.torque_Nm[k];
  const double output = std::clamp(drive.kp_scale * run.kp * (r.q_cmd_rad[k] - r.q_rad[k]), -drive.limit, drive.limit);
  return drive.torque_per_unit_Nm * supply * output;
}

/// The smallest step between distinct readings if all steps are multiples of it, else 0.
double quantum_of(const std::vector<calib::SingleJoint>& runs) {
  std::vector<double> values;
  for (const calib::SingleJoint& run : runs) {
    const auto& q_rad = run.run().recording.q_rad;
    values.insert(values.end(), q_rad.begin(), q_rad.end());
  }
  std::sort(values.begin(), values.end());
  double smallest = 0.0;
  for (std::size_t k = 1; k < values.size(); ++k) {
    const double step = values[k] - values[k - 1];
    if (step > 1e-5 && (smallest == 0.0 || step < smallest)) smallest = step;
  }
  if (smallest == 0.0) return 0.0;
  double off = 0.0;
  for (std::size_t k = 1; k < values.size(); ++k) {
    const double steps = (values[k] - values[k - 1]) / smallest;
    off = std::max(off, std::abs(steps - std::round(steps)));
  }
  return off < 0.1 ? smallest : 0.0;
}

/// Order of a wave with one period over the range of motion [1/turn].
double lowest_order(const BenchScale& scale) {
  return 2.0 * 3.141592653589793 / std::max(0.1, scale.position_high_rad - scale.position_low_rad);
}

}  // namespace

BenchScale scale_of(const bench::Bench& bench, const std::vector<calib::SingleJoint>& runs, const JointModel& model) {
  BenchScale scale;
  std::vector<double> torques, speeds, inertias, positions;
  constexpr double kSpan_s = 0.02;
  for (const calib::SingleJoint& joint : runs) {
    const bench::BenchRun& run = joint.run();
    const bench::Recording& r = run.recording;
    scale.bus_recorded = scale.bus_recorded || !r.bus_V.empty();
    inertias.push_back(run.load.inertia_kg_m2 + model.actuator.transmission.armature_kg_m2);
    const auto span = static_cast<std::size_t>(std::max(1.0, kSpan_s * bench.sample_rate_hz));
    for (std::size_t k = 0; k < r.t_s.size(); ++k) {
      if (!r.valid[k]) continue;
      positions.push_back(r.q_rad[k]);
      const bool servo = bench.law == bench::DriveLaw::kServoVoltage;
      const double supply = !servo ? 1.0 : r.bus_V.empty() ? bench.supply_V : r.bus_V[k];
      torques.push_back(std::abs(wished_torque_Nm(run, k, supply, model)));
      if (k < span || !r.valid[k - span]) continue;
      speeds.push_back(std::abs(r.q_rad[k] - r.q_rad[k - span]) / (r.t_s[k] - r.t_s[k - span]));
    }
  }
  double squares = 0.0;
  for (const double torque : torques) squares += torque * torque;
  scale.torque_Nm = std::max(1e-6, std::sqrt(squares / std::max(1.0, static_cast<double>(torques.size()))));
  scale.torque_peak_Nm = std::max(scale.torque_Nm, fitting::quantile(torques, 0.99));
  scale.speed_rad_s = std::max(1e-4, fitting::quantile(speeds, 0.98));
  scale.inertia_kg_m2 = std::max(1e-7, fitting::quantile(inertias, 0.5));
  scale.position_low_rad = fitting::quantile(positions, 0.01);
  scale.position_high_rad = fitting::quantile(positions, 0.99);
  scale.quantum_rad = quantum_of(runs);
  return scale;
}

double Unknown::coordinate(double value) const {
  const double inside = std::clamp(value, lower, upper);
  return logarithmic ? std::log(inside) : inside;
}

double Unknown::value(double coordinate) const {
  return std::clamp(logarithmic ? std::exp(coordinate) : coordinate, lower, upper);
}

// The differences are wide: a joint that sticks one sample earlier or later must not dominate the slope. A held command
// is delayed by whole simulation steps, so a smaller difference of the delay would change nothing.
fitting::Coordinate Unknown::range() const {
  constexpr double kDelayStep_s = 2.5e-3, kLogarithmStep = 1e-2, kShareOfTypical = 5e-3;
  const double step = name == "command.delay_s" ? kDelayStep_s
                      : logarithmic             ? kLogarithmStep
                                                : kShareOfTypical * typical;
  return {coordinate(lower), coordinate(upper), step, expected, deviation};
}

Unknown unknown(const std::string& name, const bench::Bench& bench, const BenchScale& scale) {
  Unknown u{calib::fit_parameter(name, bench)};
  const double torque = scale.torque_Nm, speed = scale.speed_rad_s;
  if (u.unit.starts_with("Nm s")) {
    u.typical = torque / speed;
    u.upper = std::max(u.upper, 10.0 * u.typical);
  } else if (u.unit == "Nm") {
    u.typical = torque;
    u.upper = std::max(u.upper, 5.0 * scale.torque_peak_Nm);
  } else if (u.unit.starts_with("1/(Nm^2")) {
    u.typical = 0.1 / (torque * torque);
    u.lower = std::min(u.lower, -10.0 * u.typical);
    u.upper = std::max(u.upper, 10.0 * u.typical);
  } else if (u.unit == "1/K") {
    u.typical = 0.02;
  } else if (u.unit == "1/Nm") {
    u.typical = 0.3 / torque;
    u.upper = 3.0 / scale.torque_peak_Nm;  // a source three times as weak as the motor it feeds
  } else if (u.unit == "s") {
    u.typical = 0.01;
  } else if (u.unit == "rad") {
    u.typical = 0.05 * (scale.position_high_rad - scale.position_low_rad);
  } else if (u.unit == "rad/s") {
    u.typical = speed;
    u.lower = std::min(u.lower, 0.02 * speed);
    u.upper = std::max(u.upper, 10.0 * speed);
  } else {
    u.typical = 0.3;
  }
  u.logarithmic = u.lower > 0.0 && u.upper / u.lower >= 10.0 && name != "ripple.order";
  // With less than one period over the range of motion, a wave is a proxy for an offset or a slope.
  if (name == "ripple.order") u.lower = std::max(u.lower, lowest_order(scale)), u.typical = 1.0;
  if (name == "ripple.phase_rad" || name == "sensor.eccentricity_phase_rad")
    u.lower = -10.0, u.upper = 10.0, u.typical = 1.0;
  if (name == "transmission.armature_kg_m2") u.lower = std::min(u.lower, 1e-4 * scale.inertia_kg_m2);
  return u;
}

bool is_jagged(const std::string& parameter) {
  return parameter == "command.hold_s" || parameter == "sensor.quantum_rad";
}

std::vector<std::vector<double>> starts(const Effect& effect, const JointModel& current, const BenchScale& scale) {
  const double torque = scale.torque_Nm, peak = scale.torque_peak_Nm, speed = scale.speed_rad_s;
  const auto& a = current.actuator;
  std::vector<std::vector<double>> found;
  const auto each = [&](std::initializer_list<double> values, double factor, double offset = 0.0) {
    for (const double v : values) found.push_back({offset + factor * v});
  };
  if (effect.name == "coulomb") {
    each({0.03, 0.1, 0.3, -0.05, -0.2}, torque, a.friction.coulomb_Nm);
    std::erase_if(found, [](const auto& v) { return v.front() < 0.0; });
  } else if (effect.name == "viscous") {
    each({0.03, 0.1, 0.3, -0.05, -0.2}, torque / speed, a.friction.viscous_Nm_s_per_rad);
    std::erase_if(found, [](const auto& v) { return v.front() < 0.0; });
  } else if (effect.name == "stribeck") {
    for (const double f : {-0.15, -0.05, 0.05, 0.15, 0.4}) {
      for (const double v : {0.02, 0.1, 0.4}) found.push_back({f * torque, v * speed});
    }
  } else if (effect.name == "load_friction") {
    found = {{0.1, 0.1}, {0.3, 0.3}, {0.7, 0.4}, {0.2, 0.0}, {0.0, 0.2}};
  } else if (effect.name == "direction_friction") {
    each({-0.2, 0.2}, 1.0);
  } else if (effect.name == "offset") {
    each({-0.2, -0.05, 0.05, 0.2}, torque);
  } else if (effect.name == "backlash" || effect.name == "compliance") {
    const double rotor = std::max(1e-6, a.transmission.armature_kg_m2);
    const double reduced = 1.0 / (1.0 / rotor + 1.0 / scale.inertia_kg_m2);
    for (const double bend_rad : {0.005, 0.02, 0.06}) {
      const double stiffness = std::max(peak / bend_rad, 5.0 * torque);
      const double damping = 0.1 * 2.0 * std::sqrt(stiffness * reduced);
      if (effect.name == "compliance") {
        found.push_back({stiffness, damping});
        continue;
      }
      for (const double play_rad : {0.005, 0.02, 0.06}) found.push_back({play_rad, stiffness, damping});
    }
  } else if (effect.name == "delay") {
    each({2.0, 5.0, 10.0, 20.0, 40.0}, 1e-3);
  } else if (effect.name == "rate_limit") {
    each({0.3, 0.5, 0.7, 0.85, 1.0, 1.3, 2.0}, speed);
  } else if (effect.name == "hold") {
    each({2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 15.0, 20.0, 25.0, 30.0, 40.0}, 1e-3);
  } else if (effect.name == "torque_speed") {
    for (const double stall : {0.5, 1.0, 1.8}) {
      for (const double no_load : {1.05, 1.4, 2.5}) found.push_back({stall * peak, no_load * speed});
    }
  } else if (effect.name == "supply_sag") {
    // Only voltage drives, which have back-EMF, feel the bus; the others regulate their current. A recorded bus voltage
    // is an input that already contains the sag.
    if (a.drive.back_emf_s_per_rad > 0.0 && !scale.bus_recorded) each({0.05, 0.2, 0.5, 1.0}, 1.0 / peak);
  } else if (effect.name == "gain") {
    each({0.6, 0.8, 0.9, 1.1, 1.25, 1.6}, a.drive.kp_scale);
  } else if (effect.name == "dead_band") {
    each({0.003, 0.01, 0.03}, 1.0);
  } else if (effect.name == "sensor_lag") {
    each({2.0, 5.0, 10.0, 20.0}, 1e-3);
  } else if (effect.name == "quantisation") {
    if (scale.quantum_rad > 0.0) found.push_back({scale.quantum_rad});
  } else if (effect.name == "zero_offset") {
    each({-0.05, -0.01, 0.01, 0.05}, 1.0);
  } else if (effect.name == "cogging") {
    const double lowest = lowest_order(scale);
    const double step = std::clamp(0.25 * lowest, 0.5, 4.0);  // a quarter of a period over the range
    for (double order = lowest; order <= 64.0; order += step) {
      found.push_back({0.1 * torque, order, 0.0});
    }
  } else if (effect.name == "hysteresis") {
    each({0.003, 0.01, 0.03}, 1.0);
  } else if (effect.name == "eccentricity") {
    found.push_back({0.02, 0.0});
  } else if (effect.name == "thermal_drift") {
    found = {{-0.02, 0.0}, {0.02, 0.0}, {0.0, -0.01}, {0.0, 0.01}};
  } else if (effect.name == "self_heating") {
    each({-0.2, 0.2}, 1.0 / (torque * torque));
  } else if (effect.name == "load") {
    found = {{0.8, 0.8}, {1.25, 1.25}, {1.2, 1.0}, {0.8, 1.0}, {1.0, 1.2}, {1.0, 0.8}};
  }
  return found;
}

}  // namespace pmg::effects
