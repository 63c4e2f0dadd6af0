#include "prepared_plant.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <stdexcept>

#include "bench_files.hpp"
#include "calibration.hpp"
#include "files.hpp"
#include "files/config_error.hpp"
#include "sim/motor_file.hpp"

namespace pmg::literature {

namespace {

constexpr std::uint64_t kCalibrationTake = 1, kRepeatTake = 2;
constexpr int kIterations = 12;             // by then the worst of a hundred calibrations had settled
constexpr double kUnreadable_floors = 1e3;  // of files that the reader refuses

/// The rig's numbers as the actuator model has them: where a calibration begins.
model::ActuatorParameters nominal_model(const Rig& rig) {
  const Machine& m = rig.healthy;
  model::ActuatorParameters model;
  model.command.delay_s = m.command.delay_s;
  model.drive.limit = m.drive.limit;
  model.drive.torque_per_unit_Nm = m.drive.torque_per_unit;
  if (m.drive.law == Law::kServo) {
    model.drive.kp_scale = m.drive.kp_factor;
    model.drive.back_emf_s_per_rad = m.drive.back_emf;
  }
  if (m.drive.law == Law::kCascade) model.command.hold_s = 1.0 / rig.sample_rate_hz;
  if (m.drive.law == Law::kTorque) model.drive.limit = kNever;
  model.sensor.quantum_rad = m.sensor.quantum_rad;
  model.transmission.armature_kg_m2 = m.body.rotor_inertia_kg_m2;
  model.friction.coulomb_Nm = m.friction.coulomb_Nm;
  model.friction.viscous_Nm_s_per_rad = m.friction.viscous_Nm_s_per_rad;
  model.friction.stribeck_Nm = m.friction.stribeck_Nm;
  model.friction.stribeck_rad_s = m.friction.stribeck_rad_s;
  model.friction.load_driving = m.friction.load_driving;
  model.friction.load_backdriving = m.friction.load_backdriving;
  return model;
}

/// What a calibration of such a joint fits.
std::vector<CalibratedParameter> sought(const Rig& rig, const model::ActuatorParameters& nominal) {
  const Law law = rig.healthy.drive.law;
  std::vector<std::string> names = {"transmission.armature_kg_m2", "friction.coulomb_Nm"};
  if (law == Law::kServo || law == Law::kCascade) names.emplace_back("drive.torque_per_unit_Nm");
  if (law == Law::kServo) names.emplace_back("drive.back_emf_s_per_rad");
  if (law == Law::kPositionPd) names.insert(names.end(), {"drive.kp_scale", "drive.kd_scale"});
  if (law != Law::kServo) names.emplace_back("friction.viscous_Nm_s_per_rad");
  if (nominal.friction.stribeck_Nm > 0.0) {
    names.insert(names.end(), {"friction.stribeck_Nm", "friction.stribeck_rad_s"});
  }
  if (nominal.friction.load_driving > 0.0) {
    names.insert(names.end(), {"friction.load_driving", "friction.load_backdriving"});
  }
  std::vector<CalibratedParameter> found;
  for (const std::string& name : names) found.push_back({name, model::actuator_parameter(name).value(nominal)});
  if (law != Law::kCascade) found.push_back({"command.delay_s", 2e-3});
  found.push_back({"friction.presliding_rad", 5e-4});
  return found;
}

double in_motor_file(const PlantedParameter& planted, const model::ActuatorParameters& base) {
  const bool of_load = planted.name.starts_with("load.");
  const double before = of_load ? 1.0 : model::actuator_parameter(planted.name).value(base);
  switch (planted.how) {
    case PlantedParameter::How::kAdds:
      return before + planted.value;
    case PlantedParameter::How::kScales:
      return before * planted.value;
    case PlantedParameter::How::kIs:
      break;
  }
  return planted.value;
}

const char* name(Law law) {
  return law == Law::kServo     ? "servo_voltage"
         : law == Law::kCascade ? "cascade_pd"
         : law == Law::kTorque  ? "torque"
                                : "position_pd";
}

std::string file_of(std::size_t run) { return fmt::format("run{:02}.csv", run); }

/// By how many noise floors the fault moves the calibrated model's error over the runs that have it.
double fault_moves_floors(const DataFault& fault, const model::ActuatorParameters& base,
                          const std::filesystem::path& spoiled, const std::filesystem::path& sound, double floor_rad) {
  std::vector<std::string> files;
  for (const std::size_t run : fault.runs) files.push_back(file_of(run));
  const std::string filter = fmt::format("file in {}", fmt::join(files, ","));
  const double before_rad = rollout_error_rad(base, sound, filter);
  try {
    return (rollout_error_rad(base, spoiled, filter) - before_rad) / floor_rad;
  } catch (const files::ConfigError&) {
    return kUnreadable_floors;
  }
}

nlohmann::json effect_json(const PlantedEffect& effect, const PreparedPlant& prepared, double floor_rad) {
  nlohmann::json parameters = nlohmann::json::object();
  for (const PlantedParameter& p : effect.parameters) parameters[p.name] = in_motor_file(p, prepared.base);
  const double floors = moves_floors(prepared.plant, effect.without, floor_rad);
  nlohmann::json one = {{"effect", effect.form.effect}, {"form", effect.form.form}, {"source", effect.form.source}};
  one["moves_floors"] = floors;
  one["parameters"] = parameters;
  one["same_here"] = same_here(effect.form, prepared.plant.machine);
  one["besides"] = effect.form.besides;
  return one;
}

nlohmann::json fault_json(const DataFault& fault, double floors) {
  nlohmann::json files = nlohmann::json::array();
  for (const std::size_t run : fault.runs) files.push_back(file_of(run));
  return {{"kind", fault.kind},          {"column", fault.column},       {"runs", files},
          {"factor", fault.factor},      {"shift_samples", fault.shift}, {"moves_floors", floors},
          {"same_here", fault.same_here}};
}

}  // namespace

double moves_floors(const LiteraturePlant& plant, const Machine& without, double floor_rad) {
  double sum_rad = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < plant.rig.runs.size(); ++i) {
    if (!plant.rig.runs[i].scored) continue;
    sum_rad += mean_absolute_difference_rad(record(plant.machine, plant.rig, plant.seed, i),
                                            record(without, plant.rig, plant.seed, i));
    ++count;
  }
  return sum_rad / count / floor_rad;
}

double noise_floor_rad(const LiteraturePlant& plant) {
  double sum_rad = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < plant.rig.runs.size(); ++i) {
    if (!plant.rig.runs[i].scored) continue;
    sum_rad += mean_absolute_difference_rad(record(plant.machine, plant.rig, plant.seed, i),
                                            record(plant.machine, plant.rig, plant.seed, i, kRepeatTake));
    ++count;
  }
  return sum_rad / count;
}

PreparedPlant prepare(std::uint64_t seed, const std::filesystem::path& folder) {
  PreparedPlant prepared{plant_of(seed), {}, {}, folder / "bench"};
  const LiteraturePlant& plant = prepared.plant;
  const auto healthy = folder / "healthy", sound = folder / "sound";
  write_bench(healthy, plant, plant.rig.healthy, kCalibrationTake, false);
  write_bench(prepared.bench, plant, plant.machine, 0, true);
  const model::ActuatorParameters nominal = nominal_model(plant.rig);
  prepared.base = calibrated(nominal, sought(plant.rig, nominal), healthy, kIterations);

  const double floor_rad = noise_floor_rad(plant);
  nlohmann::json effects = nlohmann::json::array(), faults = nlohmann::json::array();
  for (const PlantedEffect& effect : plant.effects) effects.push_back(effect_json(effect, prepared, floor_rad));
  for (const DataFault& fault : plant.faults) {
    write_bench(sound, plant, plant.sound_machine, 0, false);
    faults.push_back(fault_json(fault, fault_moves_floors(fault, prepared.base, prepared.bench, sound, floor_rad)));
  }
  prepared.truth = {{"seed", seed},
                    {"kind", name(plant.stratum)},
                    {"law", name(plant.rig.healthy.drive.law)},
                    {"horizontal", plant.rig.horizontal},
                    {"effects", effects},
                    {"faults", faults},
                    {"noise_floor_rad", floor_rad},
                    {"healthy_error_rad", rollout_error_rad(prepared.base, healthy, kScoreFilter)},
                    {"warms_K", plant.rig.warms_K},
                    {"records_temperature", plant.rig.records_temperature}};
  std::filesystem::remove_all(healthy);
  std::filesystem::remove_all(sound);
  write_text(folder / "base.yaml", sim::motor_yaml({{"bench", prepared.base}}, {"the healthy joint, calibrated"}));
  write_text(folder / "truth.json", prepared.truth.dump(2) + "\n");
  return prepared;
}

}  // namespace pmg::literature
