#include "prepared_plant.hpp"

#include <cmath>

#include "base_model.hpp"
#include "bench_files.hpp"
#include "blind_plants/calibration.hpp"
#include "blind_plants/files.hpp"
#include "calib/fit_problem.hpp"
#include "sim/motor_file.hpp"

namespace pmg::hidden {

namespace {

constexpr std::uint64_t kCalibrationTake = 1, kRepeatTake = 2;

/// Dropouts aren't noise that anybody has to model.
double noise_floor_rad(const HiddenPlant& hidden) {
  Rig rig = hidden.rig;
  rig.noise.dropouts_per_s = 0.0;
  double sum_rad = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < rig.runs.size(); ++i) {
    if (!rig.runs[i].scored) continue;
    PlantRun again = run_of(hidden, i, kRepeatTake);
    const PlantRecording first = record(hidden.plant, rig, hidden.seed, run_of(hidden, i));
    sum_rad += mean_absolute_difference_rad(first, record(hidden.plant, rig, hidden.seed, again));
    ++count;
  }
  return sum_rad / count;
}

double in_motor_file(const PlantedParameter& planted, const model::ActuatorParameters& base) {
  const double before = calib::value({.actuator = base}, planted.name);
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

/// Dry friction c (1 + a) one way and c (1 - a) the other is friction c both ways and a constant torque -a c, whether
/// the joint slides or sticks. Another effect it is only where c varies: with speed, load or temperature.
std::vector<std::string> same_here(const std::string& effect, const PlantParameters& plant) {
  const PlantParameters::Friction& f = plant.friction;
  const bool varies =
      f.stribeck_Nm != 0.0 || f.load_driving != 0.0 || f.load_backdriving != 0.0 || plant.thermal.friction_per_K != 0.0;
  if (varies) return {};
  if (effect == "direction_friction") return {"offset"};
  if (effect == "offset" && std::abs(plant.ripple.offset_Nm) < f.coulomb_Nm) return {"direction_friction"};
  return {};
}

}  // namespace

nlohmann::json json(const PlantedTruth& truth) {
  nlohmann::json effects = nlohmann::json::array();
  for (const PlantedTruth::Effect& effect : truth.effects) {
    nlohmann::json parameters = nlohmann::json::object();
    for (const auto& [name, value] : effect.parameters) parameters[name] = value;
    effects.push_back({{"effect", effect.name},
                       {"moves_floors", effect.moves_floors},
                       {"parameters", parameters},
                       {"same_here", effect.same_here}});
  }
  return {{"seed", truth.seed},
          {"kind", name(truth.kind)},
          {"effects", effects},
          {"noise_floor_rad", truth.floor_rad},
          {"healthy_error_rad", truth.healthy_error_rad},
          {"error_rad", truth.error_rad}};
}

PreparedPlant prepare(std::uint64_t seed, const std::filesystem::path& folder) {
  PreparedPlant prepared{hide(seed), {}, {}, folder / "bench"};
  const HiddenPlant& hidden = prepared.hidden;
  const auto healthy = folder / "healthy", without = folder / "without";
  write_bench(healthy, hidden, hidden.rig.healthy, kCalibrationTake);
  write_bench(prepared.bench, hidden, hidden.plant);
  prepared.base = calibrated_model(hidden.rig, healthy);

  PlantedTruth& truth = prepared.truth;
  truth.seed = seed;
  truth.kind = hidden.kind;
  truth.floor_rad = noise_floor_rad(hidden);
  truth.healthy_error_rad = rollout_error_rad(prepared.base, healthy, kScoreFilter);
  truth.error_rad = rollout_error_rad(prepared.base, prepared.bench, kScoreFilter);
  for (const PlantedEffect& effect : hidden.effects) {
    double without_rad = truth.healthy_error_rad;
    if (hidden.effects.size() > 1) {
      write_bench(without, hidden, effect.plant_without, kCalibrationTake);
      without_rad = rollout_error_rad(prepared.base, without, kScoreFilter);
    }
    PlantedTruth::Effect planted{effect.name, (truth.error_rad - without_rad) / truth.floor_rad, {}, {}};
    planted.same_here = same_here(effect.name, hidden.plant);
    for (const PlantedParameter& p : effect.parameters) {
      planted.parameters.emplace_back(p.name, in_motor_file(p, prepared.base));
    }
    truth.effects.push_back(planted);
  }
  std::filesystem::remove_all(healthy);
  std::filesystem::remove_all(without);
  write_text(folder / "base.yaml", sim::motor_yaml({{"bench", prepared.base}}, {"the healthy joint, calibrated"}));
  write_text(folder / "truth.json", json(truth).dump(2) + "\n");
  return prepared;
}

}  // namespace pmg::hidden
