// One table, a row for each form of an effect.
#include "effects/starts.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

namespace pmg::effects {

namespace {

using Values = std::vector<std::vector<double>>;

struct At {
  const model::ActuatorParameters& actuator;
  const BenchScale& scale;
  double torque = scale.torque_Nm, peak = scale.torque_peak_Nm, speed = scale.speed_rad_s;
  bool servo = scale.law == bench::DriveLaw::kServoVoltage;
  bool closes_loop = scale.law != bench::DriveLaw::kTorque;  ///< the drive has a position loop of its own
};

Values each(std::initializer_list<double> values, double factor, double offset = 0.0) {
  Values found;
  for (const double v : values) found.push_back({offset + factor * v});
  return found;
}

Values each_not_negative(std::initializer_list<double> values, double factor, double offset) {
  Values found = each(values, factor, offset);
  std::erase_if(found, [](const auto& v) { return v.front() < 0.0; });
  return found;
}

Values pairs(std::initializer_list<double> first, double first_factor, std::initializer_list<double> second,
             double second_factor) {
  Values found;
  for (const double a : first) {
    for (const double b : second) found.push_back({a * first_factor, b * second_factor});
  }
  return found;
}

/// The same starts with one more value, of the last parameter.
Values followed_by(double last, Values values) {
  for (std::vector<double>& one : values) one.push_back(last);
  return values;
}

/// Stiffness and damping of a shaft that bends by so much under the peak torque, rings damped by a tenth.
std::vector<double> shaft(const At& at, double bend_rad) {
  const double rotor = std::max(1e-6, at.actuator.transmission.armature_kg_m2);
  const double reduced = 1.0 / (1.0 / rotor + 1.0 / at.scale.inertia_kg_m2);
  const double stiffness = std::max(at.peak / bend_rad, 5.0 * at.torque);
  return {stiffness, 0.1 * 2.0 * std::sqrt(stiffness * reduced)};
}

Values shafts(const At& at) { return {shaft(at, 0.005), shaft(at, 0.02), shaft(at, 0.06)}; }

/// A hardening spring begins softer and carries half of the peak torque by its cube.
Values hardening_shafts(const At& at) {
  Values found;
  for (const double bend_rad : {0.02, 0.06}) {
    std::vector<double> one = shaft(at, bend_rad);
    one[0] *= 0.5;
    one.push_back(one[0] / (bend_rad * bend_rad));
    found.push_back(one);
  }
  return found;
}

Values plays(const At& at, std::initializer_list<double> bends_rad) {
  Values found;
  for (const double bend_rad : bends_rad) {
    const std::vector<double> one = shaft(at, bend_rad);
    for (const double play_rad : {0.005, 0.02, 0.06}) found.push_back({play_rad, one[0], one[1]});
  }
  return found;
}

/// Orders that lie so many periods over the range apart.
Values waves(const At& at, double amplitude, double periods, double highest) {
  Values found;
  const double lowest = lowest_order(at.scale), step = std::clamp(periods * lowest, 0.5, 4.0);
  for (double order = lowest; order <= highest; order += step) found.push_back({amplitude, order, 0.0});
  return found;
}

Values only_if(bool possible, Values values) { return possible ? std::move(values) : Values{}; }

/// Only voltage drives, which have back-EMF, feel the bus; the others regulate their current. A recorded bus voltage is
/// an input that already contains the sag.
bool feels_bus(const At& at) { return at.actuator.drive.back_emf_s_per_rad > 0.0 && !at.scale.bus_recorded; }

using StartsOf = std::function<Values(const At&)>;

/// By "effect" or "effect.form"; a form without starts of its own takes those of its effect.
const std::map<std::string, StartsOf>& table() {
  static const std::map<std::string, StartsOf> kTable = {
      {"coulomb",
       [](const At& at) {
         return each_not_negative({0.03, 0.1, 0.3, -0.05, -0.2}, at.torque, at.actuator.friction.coulomb_Nm);
       }},
      {"viscous.linear",
       [](const At& at) {
         return each_not_negative({0.03, 0.1, 0.3, -0.05, -0.2}, at.torque / at.speed,
                                  at.actuator.friction.viscous_Nm_s_per_rad);
       }},
      {"viscous.quadratic",
       [](const At& at) {
         return each({0.1, 0.4}, at.torque / (at.speed * at.speed));
       }},
      {"stribeck.exponent_2",
       [](const At& at) {
         return pairs({-0.15, -0.05, 0.05, 0.15, 0.4}, at.torque, {0.02, 0.1, 0.4}, at.speed);
       }},
      {"stribeck",
       [](const At& at) {
         return pairs({-0.15, 0.1, 0.3}, at.torque, {0.05, 0.2}, at.speed);
       }},
      {"load_friction.transmitted",
       [](const At&) {
         return Values{{0.1, 0.1}, {0.3, 0.3}, {0.7, 0.4}, {0.2, 0.0}, {0.0, 0.2}};
       }},
      {"load_friction",
       [](const At&) {
         return Values{{0.1, 0.1}, {0.3, 0.3}};
       }},
      {"direction_friction.dry",
       [](const At&) {
         return each({-0.2, 0.2}, 1.0);
       }},
      {"direction_friction.viscous",
       [](const At& at) {
         return only_if(at.actuator.friction.viscous_Nm_s_per_rad > 0.0, each({-0.5, 0.5}, 1.0));
       }},
      {"direction_friction.stribeck",
       [](const At& at) {
         return Values{{0.8, 0.1 * at.torque, 0.1 * at.speed}, {-0.8, 0.1 * at.torque, 0.1 * at.speed}};
       }},
      {"offset",
       [](const At& at) {
         return each({-0.2, -0.05, 0.05, 0.2}, at.torque);
       }},
      {"backlash.friction_before",
       [](const At& at) {
         return plays(at, {0.005, 0.02, 0.06});
       }},
      {"backlash.friction_behind", [](const At& at) { return plays(at, {0.005}); }},
      {"backlash.sensor_before", [](const At& at) { return only_if(at.closes_loop, plays(at, {0.005})); }},
      {"compliance", shafts},
      {"compliance.hardening", hardening_shafts},
      {"compliance.sensor_before", [](const At& at) { return only_if(at.closes_loop, shafts(at)); }},
      {"delay.commands",
       [](const At&) {
         return each({2.0, 5.0, 10.0, 20.0, 40.0}, 1e-3);
       }},
      {"delay",
       [](const At& at) {
         return only_if(at.closes_loop, each({3.0, 10.0}, 1e-3));
       }},
      {"rate_limit.command",
       [](const At& at) {
         return each({0.3, 0.5, 0.7, 0.85, 1.0, 1.3, 2.0}, at.speed);
       }},
      {"rate_limit.profile",
       [](const At& at) {
         return only_if(at.closes_loop, pairs({0.7, 1.0, 1.5}, at.speed, {5.0, 12.0}, at.speed));
       }},
      {"rate_limit.output",
       [](const At& at) {
         return only_if(at.closes_loop, each({5.0, 10.0, 20.0, 40.0}, at.scale.output));
       }},
      {"hold.output",
       [](const At&) {
         return each({2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 15.0, 20.0, 25.0, 30.0, 40.0}, 1e-3);
       }},
      {"hold.commands",
       [](const At& at) {
         return only_if(at.closes_loop, each({20.0, 30.0, 40.0, 50.0, 65.0, 80.0, 100.0}, 1e-3));
       }},
      {"hold.readings",
       [](const At& at) {
         return only_if(at.closes_loop, each({4.0, 8.0, 12.0, 16.0, 20.0, 25.0}, 1e-3));
       }},
      {"torque_speed.line",
       [](const At& at) {
         return pairs({0.5, 1.0, 1.8}, at.peak, {1.05, 1.4, 2.5}, at.speed);
       }},
      {"torque_speed.power",
       [](const At& at) {
         return only_if(!at.servo, each({0.15, 0.4, 0.8}, at.peak * at.speed));
       }},
      {"torque_speed.cut",
       [](const At& at) {
         return only_if(!at.servo, each({0.9, 1.05, 1.2}, at.speed));
       }},
      {"supply_sag.resistance",
       [](const At& at) {
         return only_if(feels_bus(at), each({0.05, 0.2, 0.5, 1.0}, 1.0 / at.peak));
       }},
      {"supply_sag.battery",
       [](const At& at) {
         return only_if(feels_bus(at), followed_by(0.5, pairs({0.2, 0.6}, 1.0 / at.peak, {0.2, 0.8}, 1.0)));
       }},
      {"supply_sag.limit",
       [](const At& at) {
         return only_if(feels_bus(at), each({0.2, 0.4, 0.7}, at.peak));
       }},
      {"gain.position",
       [](const At& at) {
         return each({0.6, 0.8, 0.9, 1.1, 1.25, 1.6}, at.actuator.drive.kp_scale);
       }},
      {"gain.torque",
       [](const At&) {
         return each({0.7, 0.9, 1.1, 1.4}, 1.0);
       }},
      {"gain.saturation",
       [](const At& at) {
         return each({0.05, 0.2}, 1.0 / at.torque);
       }},
      {"dead_band.jumps",
       [](const At&) {
         return each({0.003, 0.01, 0.03}, 1.0);
       }},
      {"dead_band.subtracts",
       [](const At& at) {
         return only_if(at.closes_loop, each({0.01, 0.03}, 1.0));
       }},
      {"dead_band.output",
       [](const At& at) {
         return each({0.05, 0.2}, at.scale.output);
       }},
      {"dead_band.wakes_later",
       [](const At& at) {
         return only_if(at.closes_loop, Values{{0.01, 0.01}, {0.03, 0.03}});
       }},
      {"sensor_lag",
       [](const At&) {
         return each({2.0, 5.0, 10.0, 20.0}, 1e-3);
       }},
      {"quantisation", [](const At& at) { return only_if(at.scale.quantum_rad > 0.0, {{at.scale.quantum_rad}}); }},
      {"zero_offset",
       [](const At&) {
         return each({-0.05, -0.01, 0.01, 0.05}, 1.0);
       }},
      {"cogging.sine", [](const At& at) { return waves(at, 0.1 * at.torque, 0.25, 64.0); }},
      {"cogging.current", [](const At& at) { return waves(at, 0.2, 0.5, 32.0); }},
      {"hysteresis",
       [](const At&) {
         return each({0.003, 0.01, 0.03}, 1.0);
       }},
      {"eccentricity",
       [](const At&) {
         return Values{{0.02, 0.0}};
       }},
      {"eccentricity.ellipse",
       [](const At&) {
         return Values{{0.02, 0.0, 0.01, 0.0}};
       }},
      {"eccentricity.motor_shaft", [](const At& at) { return waves(at, 0.005, 0.5, 32.0); }},
      {"thermal_drift.friction_and_torque",
       [](const At& at) {
         return only_if(at.scale.temperature_recorded, {{-0.02, 0.0}, {0.02, 0.0}, {0.0, -0.01}, {0.0, 0.01}});
       }},
      {"thermal_drift.viscous",
       [](const At& at) {
         return only_if(at.scale.temperature_recorded, each({-0.03, 0.02}, 1.0));
       }},
      {"thermal_drift.resistance",
       [](const At& at) { return only_if(at.scale.temperature_recorded && at.servo, each({0.004}, 1.0)); }},
      // Friction that falls along a run, and within a tenth of it.
      {"self_heating.friction_winding",
       [](const At& at) {
         return each({-0.2, 0.2, -2.0}, 1.0 / (at.torque * at.torque));
       }},
      {"self_heating.friction_own",
       [](const At& at) {
         return each({-0.3, 0.3, -3.0}, 1.0 / (0.1 * at.torque * at.speed * at.scale.duration_s));
       }},
      {"self_heating.torque_winding",
       [](const At& at) {
         return followed_by(10.0 * at.scale.duration_s,
                            each({-0.1, -0.4}, 1.0 / (at.torque * at.torque * at.scale.duration_s)));
       }},
      {"self_heating.torque_time",
       [](const At& at) {
         return pairs({0.15}, 1.0, {0.15, 0.5}, at.scale.duration_s);
       }},
      {"load", [](const At&) {
         return Values{{0.8, 0.8}, {1.25, 1.25}, {1.2, 1.0}, {0.8, 1.0}, {1.0, 1.2}, {1.0, 0.8}};
       }}};
  return kTable;
}

}  // namespace

std::vector<std::vector<double>> starts(const Effect& effect, const Form& form, const calib::JointModel& current,
                                        const BenchScale& scale) {
  auto found = table().find(effect.name + "." + form.name);
  if (found == table().end()) found = table().find(effect.name);
  return found == table().end() ? Values{} : found->second(At{.actuator = current.actuator, .scale = scale});
}

}  // namespace pmg::effects
