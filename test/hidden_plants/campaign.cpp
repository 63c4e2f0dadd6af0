#include "campaign.hpp"

#include <ctime>

#include "bench_files.hpp"
#include "diagnosis/diagnose.hpp"
#include "diagnosis/diagnosis_json.hpp"
#include "prepared_plant.hpp"

namespace pmg::hidden {

namespace {

constexpr std::uint64_t kFurtherStream = 500000;
constexpr int kTimesRecorded = 2;

diagnosis::Diagnosis diagnose(const std::filesystem::path& bench, const sim::ActuatorParameters& base) {
  diagnosis::DiagnoseOptions options;
  options.fit = kFitFilter;
  options.score = kScoreFilter;
  options.model = base;
  return diagnosis::diagnose(calib::read_bench(bench), options);
}

/// The rig's load that is meant, with what its scales didn't see.
std::pair<RigLoad, double> load_asked_for(const Rig& rig, const diagnosis::NextExcitation& asked) {
  std::size_t nearest = 0;
  const auto away = [&](std::size_t i) {
    return std::abs(rig.loads[i].mass_kg - asked.load_mass_kg) + std::abs(rig.loads[i].length_m - asked.load_length_m);
  };
  for (std::size_t i = 1; i < rig.loads.size(); ++i) {
    if (away(i) < away(nearest)) nearest = i;
  }
  return {rig.loads[nearest], rig.mass_factor[nearest]};
}

/// The command at the rig's own sample times, held in between.
std::vector<double> resampled(const diagnosis::NextExcitation& asked, double rate_hz) {
  std::vector<double> q_rad;
  std::size_t at = 0;
  for (std::size_t k = 0; static_cast<double>(k) / rate_hz <= asked.t_s.back() - asked.t_s.front() + 1e-9; ++k) {
    const double t_s = asked.t_s.front() + static_cast<double>(k) / rate_hz + 1e-9;
    while (at + 1 < asked.t_s.size() && asked.t_s[at + 1] <= t_s) ++at;
    q_rad.push_back(asked.q_cmd_rad[at]);
  }
  return q_rad;
}

std::vector<FurtherRun> record_asked_for(const HiddenPlant& hidden, const diagnosis::NextExcitation& asked) {
  const auto [load, mass_factor] = load_asked_for(hidden.rig, asked);
  std::vector<FurtherRun> further;
  for (int repeat = 0; repeat < kTimesRecorded; ++repeat) {
    const PlantRun run{.kp = asked.kp,
                       .kd = asked.kd,
                       .load = load,
                       .mass_factor = mass_factor,
                       .command = {"asked", resampled(asked, hidden.rig.sample_rate_hz), 0.0},
                       .temperature_C = 25.0 + hidden.rig.warms_K,
                       .stream = kFurtherStream + static_cast<std::uint64_t>(repeat)};
    further.push_back({run, "asked", repeat});
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
  if (found.verdict == diagnosis::Verdict::kAmbiguous && found.next_excitation && !found.next_excitation->t_s.empty()) {
    const auto again = folder / "asked";
    write_bench(again, plant.hidden, plant.hidden.plant, 0, record_asked_for(plant.hidden, *found.next_excitation));
    result["asked"] = diagnosis::diagnosis_json(diagnose(again, plant.base));
    result["asked"].erase("rejected");
  }
  for (const char* one : {"diagnosis", "asked"}) {  // what was asked for is long, and the plant's seed brings it back
    if (result.contains(one) && result[one].contains("next_excitation") && result[one]["next_excitation"].is_object()) {
      for (const char* column : {"t_s", "q_cmd_rad", "q_cmd_m"}) result[one]["next_excitation"].erase(column);
    }
  }
  if (!keep) std::filesystem::remove_all(folder);
  return result;
}

}  // namespace pmg::hidden
