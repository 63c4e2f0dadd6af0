// A hidden plant's bench as files, as bench engineers have them; what is hidden isn't among them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "recorder.hpp"

namespace pmg::hidden {

/// A recording that somebody asked for, to be fitted.
struct FurtherRun {
  PlantRun run;
  std::string trajectory;
  int repeat = 0;
};

/// Writes bench.yaml, runs.csv and runs/. plant: whose recordings; take: of which day. Throws std::runtime_error when a
/// file can't be written.
void write_bench(const std::filesystem::path& folder, const HiddenPlant& hidden, const PlantParameters& plant,
                 std::uint64_t take = 0, const std::vector<FurtherRun>& further = {});

}  // namespace pmg::hidden
