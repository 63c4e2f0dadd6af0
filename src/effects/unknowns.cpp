#include "effects/unknowns.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "effects/period.hpp"
#include "effects/zero_slip.hpp"
#include "fitting/statistics.hpp"

namespace pmg::effects {

namespace {

using calib::JointModel;
using model::Quantity;

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

}  // namespace

double lowest_order(const BenchScale& scale) {
  return 2.0 * std::numbers::pi / std::max(0.1, scale.position_high_rad - scale.position_low_rad);
}

BenchScale scale_of(const bench::Bench& bench, const std::vector<calib::SingleJoint>& runs, const JointModel& model) {
  BenchScale scale;
  scale.law = bench.law;
  scale.recordings = runs.size();
  std::vector<double> torques, speeds, inertias, positions;
  constexpr double kSpan_s = 0.02;
  for (const calib::SingleJoint& joint : runs) {
    const bench::BenchRun& run = joint.run();
    const bench::Recording& r = run.recording;
    scale.bus_recorded = scale.bus_recorded || !r.bus_V.empty();
    scale.switches_off = scale.switches_off || std::ranges::find(r.enabled, false) != r.enabled.end();
    scale.temperature_recorded = scale.temperature_recorded || !r.temp_C.empty() || run.temp_C;
    scale.duration_s = std::max(scale.duration_s, r.t_s.empty() ? 0.0 : r.t_s.back() - r.t_s.front());
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
  scale.output = scale.torque_Nm / model.actuator.drive.torque_per_unit_Nm;
  if (bench.law == bench::DriveLaw::kServoVoltage) scale.output /= bench.supply_V;
  scale.speed_rad_s = std::max(1e-4, fitting::quantile(speeds, 0.98));
  scale.inertia_kg_m2 = std::max(1e-7, fitting::quantile(inertias, 0.5));
  const auto [least, most] = std::minmax_element(inertias.begin(), inertias.end());
  scale.several_loads = !inertias.empty() && *most > 1.05 * *least;
  scale.position_low_rad = fitting::quantile(positions, 0.01);
  scale.position_high_rad = fitting::quantile(positions, 0.99);
  scale.quantum_rad = quantum_of(runs);
  return scale;
}

Usual usual(Quantity quantity, const BenchScale& scale) {
  using enum Quantity;
  const double torque = scale.torque_Nm, peak = scale.torque_peak_Nm, speed = scale.speed_rad_s;
  const double damping = torque / speed, quadratic = torque / (speed * speed), square = torque * torque;
  const double per_energy = 1.0 / (torque * speed * scale.duration_s);
  switch (quantity) {
    case kTorque:
    case kSpringRate:
      return {torque, torque, 5.0 * peak};
    case kDamping:
      return {damping, damping, 10.0 * damping};
    case kQuadraticDamping:
      return {quadratic, quadratic, 10.0 * quadratic};
    case kPerTorque:
      return {0.3 / torque, 1.0 / peak};
    case kPerHeat:
      return {0.1 / square, 1.0 / square, 100.0 * (0.1 / square), -100.0 * (0.1 / square)};
    case kPerEnergy:
      return {per_energy, 1.0 / (0.1 * torque * speed * scale.duration_s), 100.0 * per_energy, -100.0 * per_energy};
    case kOutput:
      return {scale.output, scale.output, 5.0 * scale.output};
    case kOutputRate:
      return {1.0, scale.output, 1e3 * scale.output, scale.output};
    case kPower:
      return {1.0, peak * speed, 10.0 * peak * speed, 0.02 * torque * speed};
    case kSpeed:
      return {speed, speed, 10.0 * speed, 0.02 * speed};
    case kAcceleration:
      return {1.0, speed, 1e3 * speed, speed};
    case kPerKelvin:
      return {0.02};
    case kDelay:
    case kPeriod:
    case kLag:
      return {0.01, 1e-3};
    case kTimeConstant:
      return {0.01};
    case kAngle:
    case kQuantum:
      return {0.05 * (scale.position_high_rad - scale.position_low_rad)};
    case kOrder:
    case kPhase:
      return {1.0};
    default:
      return {0.3};
  }
}

calib::Unknown unknown(const std::string& name, const bench::Bench& bench, const BenchScale& scale) {
  calib::Unknown u = calib::unknown(name, bench);
  const Usual here = usual(u.quantity, scale);
  u.typical = here.typical;
  u.lower = std::min(u.lower, here.lowest);
  if (u.upper > 0.0) u.upper = std::max(u.upper, here.highest);
  // A source ten times as weak as the motor it feeds.
  if (u.quantity == Quantity::kPerTorque) u.upper = 10.0 / scale.torque_peak_Nm;
  constexpr double kFastSource_s = 0.01;  // quicker than a joint moves: a resistance
  if (name == "drive.supply_sag_time_s") u.lower = kFastSource_s;
  if (name == calib::kMoreInertia) u.typical = scale.inertia_kg_m2, u.upper = 5.0 * scale.inertia_kg_m2;
  if (name == "transmission.armature_kg_m2") u.lower = std::min(u.lower, 1e-4 * scale.inertia_kg_m2);
  // No scale from zero: most of these numbers are small beside their range, and their priors are normal.
  const bool logarithmic =
      u.quantity != Quantity::kOrder && calib::scale_of_range(u.lower, u.upper) == calib::Scale::kLogarithmic;
  u.scale = logarithmic ? calib::Scale::kLogarithmic : calib::Scale::kLinear;
  // With less than one period over the range of motion, a wave is a proxy for an offset or a slope.
  if (u.quantity == Quantity::kOrder) u.lower = std::max(u.lower, lowest_order(scale));
  if (u.quantity == Quantity::kPhase) u.lower = -10.0, u.upper = 10.0;
  return u;
}

bool is_order(const std::string& parameter) { return calib::quantity(parameter) == Quantity::kOrder; }

bool is_jagged(const std::string& parameter) {
  return is_period(parameter) || is_place(parameter) || calib::quantity(parameter) == Quantity::kQuantum;
}

}  // namespace pmg::effects
