#include "effects/catalogue.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace pmg::effects {

namespace {

const std::vector<Effect>& effects() {
  static const std::vector<Effect> kEffects = {
      {"coulomb",
       "Coulomb friction",
       {"friction.coulomb_Nm"},
       "stops short of the target by the same torque whatever the speed; a free swing's amplitude falls by a constant",
       "two gains, and motion that stops"},
      {"viscous",
       "viscous friction",
       {"friction.viscous_Nm_s_per_rad"},
       "the residual grows with speed",
       "slow and fast motion; two settings of kd, or a commanded speed"},
      {"stribeck",
       "Stribeck friction",
       {"friction.stribeck_Nm", "friction.stribeck_rad_s"},
       "sticks, then jumps; negative: friction grows with speed and levels off",
       "slow motion through rest",
       {"coulomb", "viscous"}},
      {"load_friction",
       "load-dependent friction",
       {"friction.load_driving", "friction.load_backdriving"},
       "stops shorter under more load; lifting needs more than holding",
       "two loads"},
      {"direction_friction",
       "direction-dependent friction",
       {"friction.asymmetry"},
       "one direction misses more than the other, in proportion to the friction",
       "motion in both directions"},
      {"offset",
       "constant torque (asymmetry)",
       {"ripple.offset_Nm"},
       "pushed to one side by the same torque always, at rest too",
       "two gains, and motion in both directions"},
      {"backlash",
       "backlash",
       {"transmission.backlash_rad", "transmission.stiffness_Nm_per_rad", "transmission.damping_Nm_s_per_rad"},
       "a dead spot at each reversal",
       "reversals with little load",
       {"compliance"}},
      {"compliance",
       "compliance",
       {"transmission.stiffness_Nm_per_rad", "transmission.damping_Nm_s_per_rad"},
       "rings at a frequency of its own; bends with load",
       "steps, and two loads"},
      {"delay", "delay", {"command.delay_s"}, "every step starts late by the same time", "steps or fast motion"},
      {"rate_limit",
       "command rate limit",
       {"command.rate_limit_rad_s"},
       "steps rise along a line, the steeper the higher the gain; fast sines become triangles",
       "large steps"},
      {"hold", "sample and hold", {"command.hold_s"}, "the output has steps of its own", "fast motion, fast recording"},
      {"torque_speed",
       "torque-speed limit",
       {"drive.stall_torque_Nm", "drive.no_load_rad_s"},
       "fast motion lags however high the gain",
       "large steps",
       {"viscous"}},
      {"supply_sag",
       "bus sag",
       {"drive.supply_sag_per_Nm"},
       "hard motion of a voltage servo is weaker than its gain says",
       "small and large steps"},
      {"gain",
       "wrong gain or unit",
       {"drive.kp_scale"},
       "all errors are too large, or too small, by a factor",
       "load, or steps"},
      {"dead_band",
       "dead band",
       {"drive.dead_band_rad"},
       "errors below a threshold give no output",
       "two gains: the error at rest is the same"},
      {"sensor_lag", "sensor lag", {"sensor.lag_s"}, "rings more than damping explains", "steps"},
      {"quantisation", "quantisation", {"sensor.quantum_rad"}, "readings are multiples of one number", "slow motion"},
      {"zero_offset",
       "zero offset",
       {"sensor.zero_offset_rad"},
       "misses by a constant where gravity differs",
       "a load that hangs"},
      {"cogging",
       "cogging",
       {"ripple.amplitude_Nm", "ripple.order", "ripple.phase_rad"},
       "misses with the joint's angle, several times a turn",
       "slow motion over a large part of a turn"},
      {"hysteresis",
       "sensor hysteresis",
       {"sensor.hysteresis_rad"},
       "the reading waits at each reversal though the joint moves",
       "reversals under load"},
      {"eccentricity",
       "sensor eccentricity",
       {"sensor.eccentricity_rad", "sensor.eccentricity_phase_rad"},
       "misses with the joint's angle, once a turn",
       "motion over a large part of a turn"},
      {"thermal_drift",
       "thermal drift",
       {"thermal.friction_per_K", "thermal.torque_per_K"},
       "runs of the same design differ with temperature",
       "a temperature column, and runs from cold to warm"},
      {"self_heating",
       "self-heating",
       {"thermal.friction_per_Nm2_s"},
       "friction changes along a run, the more the harder it works",
       "long runs of hard work"},
      {"load",
       "mass, centre of mass or inertia",
       {"load.inertia_scale", "load.gravity_scale"},
       "swings too slowly or too fast; sags more or less than the load says",
       "steps, and poses away from hanging"},
  };
  return kEffects;
}

}  // namespace

std::span<const Effect> catalogue() { return effects(); }

const Effect& effect(std::string_view name) {
  std::string names;
  for (const Effect& one : effects()) {
    if (one.name == name) return one;
    names += (names.empty() ? "" : ", ") + one.name;
  }
  throw std::invalid_argument(fmt::format("no effect is called '{}'; expected one of {}", name, names));
}

std::string title(const std::string& name) {
  for (const Effect& one : effects()) {
    if (one.name == name) return one.title;
  }
  return name;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace pmg::effects
