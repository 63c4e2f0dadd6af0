// Reads and writes a clip library's command inverse (docs/reference/file-formats.md).
#pragma once

#include <filesystem>

#include "pmg/command_inverse.hpp"

namespace pmg::model {

/// DIRECTORY/inverse.csv.
std::filesystem::path command_inverse_file(const std::filesystem::path& directory);

/// One row per node of the grid, sorted by vx, vy, omega, height: the command, then its correction. Throws ConfigError
/// with file and line: unknown or missing columns, cells that aren't finite numbers, rows that aren't the sorted full
/// grid.
CommandInverse read_command_inverse(const std::filesystem::path& directory);

/// read_command_inverse reads the same numbers back. Throws ConfigError when the file can't be written.
void write_command_inverse(const std::filesystem::path& directory, const CommandInverse& inverse);

}  // namespace pmg::model
