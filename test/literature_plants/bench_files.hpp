// A plant's bench as files, as bench engineers have them; what is hidden isn't among them.
#pragma once

#include <filesystem>

#include "planting.hpp"

namespace pmg::literature {

/// Writes bench.yaml, runs.csv (its column `use` says fit or score) and runs/ of that machine on the plant's rig. take:
/// of which day; spoiled: with the plant's data faults in the files. Throws std::runtime_error when a file can't be
/// written.
void write_bench(const std::filesystem::path& folder, const LiteraturePlant& plant, const Machine& machine,
                 std::uint64_t take, bool spoiled);

}  // namespace pmg::literature
