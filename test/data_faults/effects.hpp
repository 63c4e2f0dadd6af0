// What a joint may do beyond its model, strong enough to be seen, and faults of the data as text.
#pragma once

#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "data_faults/data_fault.hpp"
#include "diagnosis/random_bench.hpp"

namespace pmg::test {

struct Effect {
  const char* name;
  std::function<void(model::ActuatorParameters& p, double weight_Nm)> set;
  Kind kind = Kind::kPendulum;
};
inline std::ostream& operator<<(std::ostream& out, const Effect& effect) { return out << effect.name; }

inline const std::vector<Effect>& effects() {
  static const std::vector<Effect> kEffects = {
      {"Nothing", [](auto&, double) {}},
      {"NothingOfAServo", [](auto&, double) {}, Kind::kServo},
      {"Backlash",
       [](auto& p, double weight_Nm) {
         p.transmission.stiffness_Nm_per_rad = 200.0 * weight_Nm;
         p.transmission.damping_Nm_s_per_rad = 0.2 * weight_Nm;
         p.transmission.backlash_rad = 0.08;
       }},
      {"Stribeck", [](auto& p, double weight_Nm) { p.friction.stribeck_Nm = 0.4 * weight_Nm; }},
      {"Coulomb", [](auto& p, double weight_Nm) { p.friction.coulomb_Nm += 0.5 * weight_Nm; }},
      {"Delay", [](auto& p, double) { p.command.delay_s = 0.035; }},
      {"RateLimit", [](auto& p, double) { p.command.rate_limit_rad_s = 1.5; }},
      {"TorqueSpeed",
       [](auto& p, double weight_Nm) { p.drive.stall_torque_Nm = 1.9 * weight_Nm, p.drive.no_load_rad_s = 3.0; }},
      {"ThermalDrift", [](auto& p, double) { p.thermal.torque_per_K = -0.006, p.thermal.friction_per_K = -0.03; }},
      {"SupplySag", [](auto& p, double weight_Nm) { p.drive.supply_sag_per_Nm = 0.3 / weight_Nm; }, Kind::kServo},
      {"SensorLag", [](auto& p, double) { p.sensor.lag_s = 0.02; }},
      {"ZeroOffset", [](auto& p, double) { p.sensor.zero_offset_rad = 0.1; }},
      {"DeadBand", [](auto& p, double) { p.drive.dead_band_rad = 0.08; }},
      {"Gain", [](auto& p, double) { p.drive.kp_scale = 1.6; }},
  };
  return kEffects;
}

inline std::string text(const std::vector<data_faults::DataFault>& faults) {
  std::string found;
  for (const data_faults::DataFault& fault : faults)
    found += fault.where + ": " + fault.correction + "; " + fault.evidence.back() + '\n';
  return found;
}

}  // namespace pmg::test
