#include "fault_examination.hpp"

#include <fmt/format.h>

#include <fstream>
#include <map>

#include "bench/bench.hpp"
#include "campaign.hpp"
#include "data_faults/data_faults_report.hpp"
#include "files.hpp"
#include "files/config_error.hpp"
#include "judgement.hpp"
#include "score.hpp"
#include "sim/motor_file.hpp"

namespace pmg::literature {

namespace {

using nlohmann::json;

std::string kind_of(const ExaminedPlant& plant) {
  if (plant.truth.at("faults").empty()) return plant.truth.at("kind").get<std::string>();
  const json& fault = plant.truth.at("faults").at(0);
  return fault.at("kind").get<std::string>() + (plant.delay ? ", the same as a delay" : "");
}

struct Count {
  int of = 0, kept = 0;
  std::string text() const { return of == 0 ? "" : fmt::format("{}/{}", kept, of); }
};

std::string table(const std::string& title, const std::vector<ExaminedPlant>& plants, bool faulty) {
  std::map<std::string, std::map<std::string, Count>> counts;
  const std::vector<std::string> laws = {"position_pd", "servo_voltage", "cascade_pd", "torque", "all"};
  for (const ExaminedPlant& plant : plants) {
    if (plant.truth.at("faults").empty() == faulty || !plant.counts) continue;
    const bool kept = faulty ? plant.named : plant.false_fault;
    for (const std::string& kind : {kind_of(plant), std::string("sum")}) {
      for (const std::string& law : {plant.truth.at("law").get<std::string>(), std::string("all")}) {
        Count& count = counts[kind][law];
        ++count.of;
        count.kept += kept ? 1 : 0;
      }
    }
  }
  std::string text = "| " + title;
  for (const std::string& law : laws) text += " | " + law;
  text += " |\n|---|---|---|---|---|---|\n";
  for (auto& [kind, of_laws] : counts) {
    text += "| " + kind;
    for (const std::string& law : laws) text += " | " + of_laws[law].text();
    text += " |\n";
  }
  return text;
}

}  // namespace

ExaminedPlant examine_faults(const std::filesystem::path& folder) {
  ExaminedPlant plant;
  std::ifstream(folder / "truth.json") >> plant.truth;
  const double begin_s = thread_seconds();
  nlohmann::ordered_json said;
  try {
    data_faults::add_to(said, data_faults::examine(bench::read_bench(folder / "bench"), {kFitFilter, kScoreFilter},
                                                   sim::read_motor_file(folder / "base.yaml").at("bench"), {}, 1));
  } catch (const files::ConfigError& error) {
    said["data_faults"] = json::array();
  }
  plant.seconds = thread_seconds() - begin_s;
  plant.data_faults = said.at("data_faults");
  const FaultJudgement judgement = judge_faults(plant.truth, {{"data_faults", plant.data_faults}});
  plant.named = judgement.named, plant.placed = judgement.placed, plant.false_fault = judgement.false_fault;
  plant.counts = true;
  for (const json& fault : plant.truth.at("faults")) {
    plant.counts = plant.counts && fault.at("moves_floors").get<double>() >= kStrong_floors;
    plant.delay = plant.delay || !fault.at("same_here").empty();
  }
  return plant;
}

std::string examined_text(const ExaminedPlant& plant) {
  std::string said;
  for (const json& fault : plant.data_faults) {
    said += fmt::format("\n    {}: {}: {}", fault.at("kind").get<std::string>(), fault.at("where").get<std::string>(),
                        fault.at("correction").get<std::string>());
    for (const json& evidence : fault.at("evidence")) said += "\n      " + evidence.get<std::string>();
  }
  const bool faulty = !plant.truth.at("faults").empty();
  const std::string judged = plant.false_fault ? "FALSE"
                             : !faulty         ? "right"
                             : plant.named     ? plant.placed ? "right" : "right, misplaced"
                             : !plant.counts   ? "weak"
                             : plant.delay     ? "left to physics"
                                               : "MISSED";
  return fmt::format("{:3} {:7} {:13} {:.1f} s: {}: planted {}{}", plant.truth.at("seed").get<int>(),
                     plant.truth.at("kind").get<std::string>(), plant.truth.at("law").get<std::string>(), plant.seconds,
                     judged, planted_text(plant.truth), said);
}

std::string fault_tables(const std::vector<ExaminedPlant>& plants) {
  return table("data faults named", plants, true) + "\n" + table("false alarms", plants, false);
}

}  // namespace pmg::literature
