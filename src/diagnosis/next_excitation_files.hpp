// What to record next, as files that can be played.
#pragma once

#include <filesystem>

#include "diagnosis/diagnosis.hpp"

namespace pmg::diagnosis {

/// Writes FOLDER/commands/TRAJECTORY.csv (t_s, q_cmd_rad; _m on a linear rig), FOLDER/runs.csv with the columns of the
/// bench's own, so that its rows can be appended to them, and a copy of the bench's bench.yaml: an excitation
/// (calib/excitation.hpp), and a bench once its runs/ are recorded. Repeats are 0, 2, 3, ...: `repeat != 1` fits
/// them all and leaves the usual score. Columns that the diagnosis knows nothing of stay empty. What an earlier
/// diagnosis left in the folder is removed, unless something was recorded there: that throws std::runtime_error, as
/// does a file that can't be written.
void write_next_excitation(const std::filesystem::path& folder, const bench::Bench& bench, const NextExcitation& next);

}  // namespace pmg::diagnosis
