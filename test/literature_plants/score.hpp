// The causes that a diagnosis named, against what was planted.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pmg::literature {

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
  std::string kind, verdict;
  bool strong = false;     ///< counts
  bool named = false;      ///< found it and nothing else; ambiguous with the truth among what can't be told apart
  bool ambiguous = false;  ///< as the verdict is
  bool settled = false;    ///< and the excitation it asked for was recorded and led to the truth
  bool accused = false;    ///< some effect that isn't there was named for certain
  std::vector<ScoredParameter> parameters;
  double seconds = 0.0;
};

/// result: truth (seed, kind, effects: [{effect, moves_floors, parameters, same_here}]), diagnosis and, where more was
/// asked for and recorded, asked (both as diagnosis.json), seconds.
Score score(const nlohmann::json& result);

}  // namespace pmg::literature
