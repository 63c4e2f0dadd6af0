#include "base_model.hpp"

#include "blind_plants/calibration.hpp"

namespace pmg::hidden {

namespace {

constexpr int kIterations = 5;

std::vector<CalibratedParameter> unknowns(const Rig& rig, const model::ActuatorParameters& nominal) {
  std::vector<std::string> names = {"transmission.armature_kg_m2", "friction.coulomb_Nm"};
  if (rig.healthy.drive.servo)
    names.insert(names.end(), {"drive.torque_per_unit_Nm", "drive.back_emf_s_per_rad"});
  else
    names.insert(names.end(), {"drive.kp_scale", "drive.kd_scale", "friction.viscous_Nm_s_per_rad"});
  if (rig.healthy.friction.stribeck_Nm > 0.0)
    names.insert(names.end(), {"friction.stribeck_Nm", "friction.stribeck_rad_s"});
  if (rig.healthy.friction.load_driving > 0.0)
    names.insert(names.end(), {"friction.load_driving", "friction.load_backdriving"});
  std::vector<CalibratedParameter> found;
  for (const std::string& name : names) found.push_back({name, model::actuator_parameter(name).value(nominal)});
  found.push_back({"command.delay_s", 2e-3});
  found.push_back({"friction.presliding_rad", 5e-4});
  return found;
}

}  // namespace

model::ActuatorParameters nominal_model(const Rig& rig) {
  const PlantParameters& p = rig.healthy;
  model::ActuatorParameters model;
  model.command.delay_s = p.command.delay_s;
  if (p.drive.servo) {
    model.drive.limit = 1.0;
    model.drive.kp_scale = p.drive.kp_factor;
    model.drive.torque_per_unit_Nm = p.drive.torque_Nm_per_V;
    model.drive.back_emf_s_per_rad = p.drive.back_emf_V_s_per_rad;
    model.drive.supply_sag_per_Nm = p.drive.sag_per_Nm;
  } else {
    model.drive.limit = p.drive.limit;
  }
  model.sensor.quantum_rad = p.sensor.quantum_rad;
  model.transmission.armature_kg_m2 = p.body.rotor_inertia_kg_m2;
  model.friction.coulomb_Nm = p.friction.coulomb_Nm;
  model.friction.viscous_Nm_s_per_rad = p.friction.viscous_Nm_s_per_rad;
  model.friction.stribeck_Nm = p.friction.stribeck_Nm;
  model.friction.stribeck_rad_s = p.friction.stribeck_rad_s;
  model.friction.load_driving = p.friction.load_driving;
  model.friction.load_backdriving = p.friction.load_backdriving;
  return model;
}

model::ActuatorParameters calibrated_model(const Rig& rig, const std::filesystem::path& healthy_bench) {
  const model::ActuatorParameters nominal = nominal_model(rig);
  return calibrated(nominal, unknowns(rig, nominal), healthy_bench, kIterations);
}

}  // namespace pmg::hidden
