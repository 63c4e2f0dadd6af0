// Reads and writes a clip library's command inverse (docs/reference/file-formats.md).
#pragma once

#include <filesystem>

#include "pmg/command_inverse.hpp"

namespace pmg::model {

/// DIRECTORY/inverse.csv.
std::filesystem::path command_inverse_file(const std::filesystem::path& directory);

/// One row a node of the grid, sorted by vx, vy, omega, height: the command, and what to add to it. Throws ConfigError
/// with file and line: unknown or missing columns, what isn't a finite number, rows that aren't the sorted full grid.
CommandInverse read_command_inverse(const std::filesystem::path& directory);

/// read_command_inverse reads back the same numbers. Throws ConfigError when the file can't be written.
void write_command_inverse(const std::filesystem::path& directory, const CommandInverse& inverse);

}  // namespace pmg::model
