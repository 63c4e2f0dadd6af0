// The search for data faults alone, over many plants: who has one, who is said to have one.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pmg::literature {

/// What the search for data faults says of one plant that `make` wrote.
struct ExaminedPlant {
  nlohmann::json truth;
  nlohmann::json data_faults;  ///< as in diagnosis.json
  bool counts = false;         ///< the fault moves the bench by two noise floors; always true without one
  bool named = false, placed = false, false_fault = false;  ///< as Judgement has them
  bool delay = false;  ///< an effect of the catalogue makes the same files: naming that is right, too
  double seconds = 0.0;
};

/// (folder of one plant: bench/, base.yaml, truth.json) => (what the search says).
ExaminedPlant examine_faults(const std::filesystem::path& folder);

/// One line of a plant, with every fault's place, correction and evidence.
std::string examined_text(const ExaminedPlant& plant);

/// Hits and misses for each kind of fault and law of drives; false alarms for each stratum and law. Markdown.
std::string fault_tables(const std::vector<ExaminedPlant>& plants);

}  // namespace pmg::literature
