// Diagnoses hidden plants blind: the diagnosis sees the bench and the healthy joint's calibration, nothing else.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>

namespace pmg::hidden {

/// Makes the plant of the seed, diagnoses it, and where the verdict is ambiguous records what was asked for with the
/// same plant and diagnoses again. What comes back: truth, diagnosis, asked (absent where nothing was asked for),
/// seconds (of the first diagnosis, CPU time). keep: the bench, truth.json and base.yaml stay in the folder.
nlohmann::json examine(std::uint64_t seed, const std::filesystem::path& folder, bool keep);

}  // namespace pmg::hidden
