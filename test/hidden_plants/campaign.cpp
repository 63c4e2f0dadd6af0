#include "campaign.hpp"

#include <cmath>
#include <ctime>

#include "bench_files.hpp"
#include "blind_plants/files.hpp"
#include "diagnosis/diagnose.hpp"
#include "diagnosis/diagnosis_json.hpp"
#include "prepared_plant.hpp"

namespace pmg::hidden {

namespace {

constexpr std::uint64_t kFurtherStream = 500000;

diagnosis::Diagnosis diagnose(const std::filesystem::path& bench, const model::ActuatorParameters& base) {
  diagnosis::DiagnoseOptions options;
  options.fit = kFitFilter;
  options.score = kScoreFilter;
  options.model = base;
  return diagnosis::diagnose(bench::read_bench(bench), options);
}

/// The rig's load that is meant, with what its scales didn't see.
std::pair<RigLoad, double> load_asked_for(const Rig& rig, const diagnosis::NextRun& asked) {
  std::size_t nearest = 0;
  const auto away = [&](std::size_t i) {
    return std::abs(rig.loads[i].mass_kg - asked.load_mass_kg) + std::abs(rig.loads[i].length_m - asked.load_length_m);
  };
  for (std::size_t i = 1; i < rig.loads.size(); ++i) {
    if (away(i) < away(nearest)) nearest = i;
  }
  return {rig.loads[nearest], rig.mass_factor[nearest]};
}

std::vector<FurtherRun> record_asked_for(const HiddenPlant& hidden, const diagnosis::NextExcitation& asked) {
  std::vector<FurtherRun> further;
  std::uint64_t stream = kFurtherStream;
  for (const diagnosis::NextRun& one : asked.runs) {
    const auto [load, mass_factor] = load_asked_for(hidden.rig, one);
    for (int repeat = 0; repeat < one.times; ++repeat) {
      const PlantRun run{.kp = one.kp,
                         .kd = one.kd,
                         .load = load,
                         .mass_factor = mass_factor,
                         .command = {one.name, one.q_cmd_rad, 0.0},
                         .temperature_C = 25.0 + hidden.rig.warms_K,
                         .stream = stream++};
      further.push_back({run, one.name, repeat});
    }
  }
  return further;
}

}  // namespace

nlohmann::json examine(std::uint64_t seed, const std::filesystem::path& folder, bool keep) {
  const PreparedPlant plant = prepare(seed, folder);
  const std::clock_t begin = std::clock();
  const diagnosis::Diagnosis found = diagnose(plant.bench, plant.base);
  nlohmann::json result = {
      {"truth", json(plant.truth)},
      {"diagnosis", diagnosis::diagnosis_json(found)},
      {"seconds", static_cast<double>(std::clock() - begin) / static_cast<double>(CLOCKS_PER_SEC)}};
  result["diagnosis"].erase("rejected");
  if (found.verdict == evidence::Verdict::kAmbiguous && found.next_excitation) {
    const auto again = folder / "asked";
    write_bench(again, plant.hidden, plant.hidden.plant, 0, record_asked_for(plant.hidden, *found.next_excitation));
    result["asked"] = diagnosis::diagnosis_json(diagnose(again, plant.base));
    result["asked"].erase("rejected");
  }
  if (!keep) std::filesystem::remove_all(folder);
  return result;
}

}  // namespace pmg::hidden
