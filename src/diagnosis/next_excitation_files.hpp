// Writes the next excitation as files that can be played.
#pragma once

#include <filesystem>

#include "diagnosis/diagnosis.hpp"

namespace pmg::diagnosis {

/// Before the work whose excitation comes there. Throws std::runtime_error if somebody recorded an earlier one there.
void expect_no_recordings(const std::filesystem::path& folder);

/// An earlier diagnosis' excitation is gone; what else somebody put there stays. Throws as expect_no_recordings.
void remove_next_excitation(const std::filesystem::path& folder);

/// Writes FOLDER/commands/TRAJECTORY.csv (t_s, q_cmd_rad; _m on a linear rig), FOLDER/runs.csv with the columns of the
/// bench's own, so that its rows can be appended to them, and a copy of the bench's bench.yaml. The folder is an
/// excitation (bench/excitation.hpp), and a bench once its runs/ are recorded. Repeats are 0, 2, 3, ...: the filter
/// `repeat != 1` fits them all and leaves repeat 1 for the score. Unknown columns stay empty. Removes the files of an
/// earlier diagnosis. Throws std::runtime_error if the folder holds recordings or a file can't be written.
void write_next_excitation(const std::filesystem::path& folder, const bench::Bench& bench, const NextExcitation& next);

}  // namespace pmg::diagnosis
