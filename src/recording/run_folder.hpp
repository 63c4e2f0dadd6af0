// One run, one folder.
#pragma once

#include <filesystem>

namespace pmg::recording {

/// (the folder that was asked for) => (itself, or FOLDER-2, FOLDER-3, ... where it has the log of another run, so that
/// no two runs are read as one). Makes nothing. Throws std::filesystem::filesystem_error when a folder can't be read.
std::filesystem::path run_folder(const std::filesystem::path& asked);

}  // namespace pmg::recording
