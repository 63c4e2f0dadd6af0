// Files that are there whole or not at all.
#pragma once

#include <filesystem>
#include <string>

namespace pmg::io {

/// Writes beside the file and renames: an interruption leaves what was there. Throws std::runtime_error.
void write_whole_file(const std::filesystem::path& file, const std::string& text);

}  // namespace pmg::io
