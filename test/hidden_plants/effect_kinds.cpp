#include "effect_kinds.hpp"

#include <cmath>
#include <numbers>

namespace pmg::hidden {

namespace {

using How = PlantedParameter::How;
using Parameters = std::vector<PlantedParameter>;

/// What the load weighs: torques are drawn in shares of it.
double weight_Nm(const Rig& rig) { return rig.loads.front().gravity_Nm; }

Parameters coulomb(Draw& draw, Rig& rig, PlantParameters& p) {
  const double more_Nm = draw.spread(0.05, 0.5) * weight_Nm(rig);
  p.friction.coulomb_Nm += more_Nm;
  return {{"friction.coulomb_Nm", How::kAdds, more_Nm}};
}

Parameters viscous(Draw& draw, Rig& rig, PlantParameters& p) {
  const double more = draw.spread(0.05, 0.5) * weight_Nm(rig) / 2.0;  // that torque at 2 rad/s
  p.friction.viscous_Nm_s_per_rad += more;
  return {{"friction.viscous_Nm_s_per_rad", How::kAdds, more}};
}

Parameters stribeck(Draw& draw, Rig& rig, PlantParameters& p) {
  const double more_Nm = draw.spread(0.05, 0.4) * weight_Nm(rig);
  p.friction.stribeck_Nm += more_Nm;
  if (p.friction.stribeck_Nm == more_Nm) p.friction.stribeck_rad_s = draw.spread(0.1, 0.6);
  return {{"friction.stribeck_Nm", How::kAdds, more_Nm},
          {"friction.stribeck_rad_s", How::kIs, p.friction.stribeck_rad_s}};
}

Parameters load_friction(Draw& draw, Rig&, PlantParameters& p) {
  const double efficiency = draw.uniform(0.55, 0.9);
  p.friction.load_driving = 1.0 / efficiency - 1.0;
  p.friction.load_backdriving = 1.0 - efficiency;
  return {{"friction.load_driving", How::kIs, p.friction.load_driving},
          {"friction.load_backdriving", How::kIs, p.friction.load_backdriving}};
}

Parameters direction_friction(Draw& draw, Rig&, PlantParameters& p) {
  p.friction.asymmetry = draw.sign() * draw.uniform(0.15, 0.5);
  return {{"friction.asymmetry", How::kIs, p.friction.asymmetry}};
}

Parameters offset(Draw& draw, Rig& rig, PlantParameters& p) {
  p.ripple.offset_Nm = draw.sign() * draw.spread(0.03, 0.3) * weight_Nm(rig);
  return {{"ripple.offset_Nm", How::kIs, p.ripple.offset_Nm}};
}

/// Damping of a shaft such that the rotor rings against a held load with this damping ratio.
double shaft_damping(const PlantParameters& p, double ratio) {
  return 2.0 * ratio * std::sqrt(p.transmission.stiffness_Nm_per_rad * p.body.rotor_inertia_kg_m2);
}

Parameters backlash(Draw& draw, Rig& rig, PlantParameters& p) {
  p.transmission.backlash_rad = draw.spread(0.01, 0.08);
  p.transmission.stiffness_Nm_per_rad = weight_Nm(rig) / draw.spread(0.002, 0.005);  // teeth hardly bend
  p.transmission.damping_Nm_s_per_rad = shaft_damping(p, draw.uniform(0.05, 0.2));
  return {{"transmission.backlash_rad", How::kIs, p.transmission.backlash_rad}};
}

Parameters compliance(Draw& draw, Rig& rig, PlantParameters& p) {
  p.transmission.stiffness_Nm_per_rad = weight_Nm(rig) / draw.spread(0.015, 0.1);
  p.transmission.damping_Nm_s_per_rad = shaft_damping(p, draw.uniform(0.03, 0.15));
  return {{"transmission.stiffness_Nm_per_rad", How::kIs, p.transmission.stiffness_Nm_per_rad}};
}

Parameters delay(Draw& draw, Rig&, PlantParameters& p) {
  const double more_s = draw.spread(0.004, 0.03);
  p.command.delay_s += more_s;
  return {{"command.delay_s", How::kAdds, more_s}};
}

Parameters rate_limit(Draw& draw, Rig&, PlantParameters& p) {
  p.command.rate_limit_rad_s = draw.spread(1.5, 8.0);
  return {{"command.rate_limit_rad_s", How::kIs, p.command.rate_limit_rad_s}};
}

Parameters torque_speed(Draw& draw, Rig& rig, PlantParameters& p) {
  p.drive.stall_torque_Nm = draw.spread(1.2, 2.5) * rig.loads.back().gravity_Nm;
  p.drive.no_load_rad_s = draw.spread(3.0, 10.0);
  return {{"drive.stall_torque_Nm", How::kIs, p.drive.stall_torque_Nm},
          {"drive.no_load_rad_s", How::kIs, p.drive.no_load_rad_s}};
}

Parameters supply_sag(Draw& draw, Rig&, PlantParameters& p) {
  p.drive.sag_per_Nm = draw.spread(0.04, 0.3);
  return {{"drive.supply_sag_per_Nm", How::kIs, p.drive.sag_per_Nm}};
}

/// A bench whose joint warms up a good deal, which the temperature column shows.
Parameters thermal_drift(Draw& draw, Rig& rig, PlantParameters& p) {
  rig.records_temperature = true;
  rig.warms_K = draw.uniform(30.0, 55.0);
  if (draw.chance(0.5)) {
    p.thermal.friction_per_K = -draw.uniform(0.01, 0.03);
    return {{"thermal.friction_per_K", How::kIs, p.thermal.friction_per_K}};
  }
  p.thermal.torque_per_K = -draw.uniform(0.002, 0.006);
  return {{"thermal.torque_per_K", How::kIs, p.thermal.torque_per_K}};
}

Parameters cogging(Draw& draw, Rig& rig, PlantParameters& p) {
  p.ripple.cogging_Nm = draw.spread(0.04, 0.4) * weight_Nm(rig);
  p.ripple.cogging_order = std::round(draw.uniform(4.0, 24.0));
  p.ripple.cogging_phase_rad = draw.uniform(-3.0, 3.0);
  return {{"ripple.amplitude_Nm", How::kIs, p.ripple.cogging_Nm}, {"ripple.order", How::kIs, p.ripple.cogging_order}};
}

Parameters eccentricity(Draw& draw, Rig&, PlantParameters& p) {
  p.sensor.eccentricity_rad = draw.spread(0.01, 0.08);
  p.sensor.eccentricity_phase_rad = draw.uniform(-3.0, 3.0);
  return {{"sensor.eccentricity_rad", How::kIs, p.sensor.eccentricity_rad}};
}

Parameters zero_offset(Draw& draw, Rig&, PlantParameters& p) {
  p.sensor.offset_rad = draw.sign() * draw.spread(0.02, 0.1);
  return {{"sensor.zero_offset_rad", How::kIs, p.sensor.offset_rad}};
}

/// Another mass, the mass elsewhere, or an arm that bench.yaml forgot.
Parameters load(Draw& draw, Rig&, PlantParameters& p) {
  const double change = draw.spread(0.06, 0.4), factor = draw.chance(0.7) ? 1.0 + change : 1.0 - 0.7 * change;
  const std::size_t which = draw.below(3);
  p.body.inertia_factor = which == 1 ? factor * factor : which == 2 ? 1.0 + 2.0 * change : factor;
  p.body.gravity_factor = which == 2 ? 1.0 : factor;
  Parameters planted = {{"load.inertia_scale", How::kScales, p.body.inertia_factor}};
  if (which != 2) planted.push_back({"load.gravity_scale", How::kScales, p.body.gravity_factor});
  return planted;
}

Parameters gain(Draw& draw, Rig&, PlantParameters& p) {
  const double factor = std::pow(draw.spread(1.08, 1.6), draw.sign());
  p.drive.kp_factor *= factor;
  return {{"drive.kp_scale", How::kScales, factor}};
}

Parameters hysteresis(Draw& draw, Rig&, PlantParameters& p) {
  p.sensor.play_rad = draw.spread(0.01, 0.06);
  return {{"sensor.hysteresis_rad", How::kIs, p.sensor.play_rad}};
}

Parameters sensor_lag(Draw& draw, Rig&, PlantParameters& p) {
  p.sensor.lag_s = draw.spread(0.004, 0.025);
  return {{"sensor.lag_s", How::kIs, p.sensor.lag_s}};
}

Parameters quantisation(Draw& draw, Rig&, PlantParameters& p) {
  p.sensor.quantum_rad = 2.0 * std::numbers::pi / std::pow(2.0, 7.0 + static_cast<double>(draw.below(3)));
  return {{"sensor.quantum_rad", How::kIs, p.sensor.quantum_rad}};
}

Parameters dead_band(Draw& draw, Rig&, PlantParameters& p) {
  p.drive.dead_band_rad = draw.spread(0.015, 0.08);
  return {{"drive.dead_band_rad", How::kIs, p.drive.dead_band_rad}};
}

constexpr EffectKind kKinds[] = {
    {"coulomb", RigKind::kAny, coulomb},
    {"viscous", RigKind::kAny, viscous},
    {"stribeck", RigKind::kAny, stribeck},
    {"load_friction", RigKind::kAny, load_friction},
    {"direction_friction", RigKind::kAny, direction_friction},
    {"offset", RigKind::kAny, offset},
    {"backlash", RigKind::kAny, backlash},
    {"compliance", RigKind::kAny, compliance},
    {"delay", RigKind::kAny, delay},
    {"rate_limit", RigKind::kAny, rate_limit},
    {"torque_speed", RigKind::kPositionPd, torque_speed},
    {"supply_sag", RigKind::kServo, supply_sag},
    {"thermal_drift", RigKind::kAny, thermal_drift},
    {"cogging", RigKind::kAny, cogging},
    {"eccentricity", RigKind::kAny, eccentricity},
    {"zero_offset", RigKind::kAny, zero_offset},
    {"load", RigKind::kAny, load},
    {"gain", RigKind::kAny, gain},
    {"hysteresis", RigKind::kAny, hysteresis},
    {"sensor_lag", RigKind::kAny, sensor_lag},
    {"quantisation", RigKind::kAny, quantisation},
    {"dead_band", RigKind::kAny, dead_band},
};

/// The healthy joint has the same Coulomb friction, and its calibration knows it; only how it sets in is strange.
void strange_friction(Draw& draw, Rig& rig, PlantParameters& p) {
  const double level_Nm = draw.uniform(0.15, 0.4) * weight_Nm(rig);
  for (PlantParameters* one : {&rig.healthy, &p}) {
    one->friction.coulomb_Nm = level_Nm;
    one->friction.load_driving = one->friction.load_backdriving = 0.0;
  }
}

Parameters lugre(Draw& draw, Rig& rig, PlantParameters& p) {
  strange_friction(draw, rig, p);
  p.strange.lugre_width_rad = draw.spread(0.03, 0.2);
  p.strange.lugre_damping_s = draw.spread(0.005, 0.05);
  return {};
}

Parameters maxwell_slip(Draw& draw, Rig& rig, PlantParameters& p) {
  strange_friction(draw, rig, p);
  p.strange.maxwell_width_rad = draw.spread(0.08, 0.6);
  return {};
}

Parameters rub(Draw& draw, Rig& rig, PlantParameters& p) {
  p.strange.rub_Nm = draw.spread(0.15, 0.8) * weight_Nm(rig);
  p.strange.rub_at_rad = draw.sign() * draw.uniform(0.0, 0.6);
  p.strange.rub_width_rad = draw.uniform(0.06, 0.25);
  return {};
}

Parameters cable(Draw& draw, Rig& rig, PlantParameters& p) {
  p.strange.cable_slack_rad = draw.uniform(0.2, 0.5);
  p.strange.cable_Nm_per_rad = draw.spread(0.3, 3.0) * weight_Nm(rig);
  return {};
}

constexpr EffectKind kStrangeKinds[] = {
    {"lugre", RigKind::kAny, lugre},
    {"maxwell_slip", RigKind::kAny, maxwell_slip},
    {"rub", RigKind::kAny, rub},
    {"cable", RigKind::kAny, cable},
};

}  // namespace

std::span<const EffectKind> effect_kinds() { return kKinds; }
std::span<const EffectKind> strange_kinds() { return kStrangeKinds; }

}  // namespace pmg::hidden
