// What a diagnosis said of a hidden plant, against what was planted; and what many of these amount to.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pmg::hidden {

/// Effects that move the held-out error by at least so many noise floors have to be found; weaker ones may be.
inline constexpr double kStrong_floors = 2.0;

/// One planted parameter that the diagnosis has an interval for.
struct ScoredParameter {
  std::string name;
  double truth = 0.0, low = 0.0, high = 0.0;
  bool inside() const { return low <= truth && truth <= high; }
  double width() const { return (high - low) / std::abs(truth); }
};

/// One plant's row of the table.
struct Score {
  std::uint64_t seed = 0;
  std::string kind, planted, said;  ///< texts for people
  std::string verdict;
  bool strong = false;     ///< counts
  bool named = false;      ///< found it and nothing else; ambiguous with the truth among what can't be told apart
  bool ambiguous = false;  ///< as the verdict is
  bool settled = false;    ///< and the excitation it asked for was recorded and led to the truth
  bool accused = false;    ///< some effect that isn't there was named for certain
  std::vector<ScoredParameter> parameters;
  double seconds = 0.0;
};

/// truth: PlantedTruth as json; diagnosis, settled: as diagnosis.json, the second null where nothing was asked for.
Score score(const nlohmann::json& result);

/// A share that is promised, and how many of how many kept it.
struct Promise {
  std::string what;
  bool at_least = true;
  double promised = 0.0;
  int kept = 0, of = 0;
  double share() const { return of == 0 ? 0.0 : static_cast<double>(kept) / of; }
  bool holds() const { return of == 0 || (at_least ? share() >= promised : share() <= promised); }
  /// The probability of no better a count than this if the promise just held: below a few per cent it doesn't.
  double chance() const;
};

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
