// Diagnoses plants blind, one line of JSON a plant: the diagnosis sees the bench and the healthy joint's calibration,
// nothing else.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

namespace pmg::literature {

/// Even seeds are to develop on. Odd seeds are for the final report: nobody looks at them before it.
enum class Use { kDevelopment, kFinal };

/// The seeds from first to last that this use may see: the even ones, or the odd ones.
std::vector<std::uint64_t> seeds_for(Use use, std::uint64_t first, std::uint64_t last);

/// CPU time of this thread [s].
double thread_seconds();

/// Makes the plant of the seed in the folder and diagnoses it. The result has truth, diagnosis (verdict "refused" and
/// the reader's message as `error` where the bench can't be read), asked (the diagnosis with the recordings that an
/// ambiguous one asked for; null otherwise), seconds (of the first diagnosis) and prepared_s (of the plant's making
/// and calibration), both CPU time of this thread. keep: the folder stays.
nlohmann::json examine(std::uint64_t seed, const std::filesystem::path& folder, bool keep);

/// The results of a campaign's file, in the order of seeds; none without a file. A last line without its end is what a
/// killed campaign left: it is left out. Throws std::runtime_error on any other line that is no result.
std::vector<nlohmann::json> read_results(const std::filesystem::path& file);

struct Campaign {
  std::filesystem::path results;
  unsigned workers = 1;
  bool keep = false;
  std::function<bool()> interrupted{};
  std::function<void(const nlohmann::json&)> each{};  ///< called with every new result, one call at a time
};

/// Appends a line for each seed that has none yet. Throws std::invalid_argument if the file has seeds of the other use.
void run(const Campaign& campaign, const std::vector<std::uint64_t>& seeds);

}  // namespace pmg::literature
