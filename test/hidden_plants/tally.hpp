// What the scores of many hidden plants amount to.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "blind_plants/promise.hpp"
#include "blind_plants/score.hpp"

namespace pmg::hidden {

struct Tally {
  std::vector<Score> scores;
  std::vector<Promise> promises;
  double median_width = 0.0;  ///< of the parameters' intervals, as a share of the truth
};

/// Reads the results of a campaign: every *.json of the folder. Throws std::runtime_error when there is none.
Tally tally(const std::filesystem::path& results);

/// The tables as Markdown.
std::string markdown(const Tally& tally);
/// The same for machines: promises, median width, and a row a plant.
nlohmann::ordered_json json(const Tally& tally);

}  // namespace pmg::hidden
