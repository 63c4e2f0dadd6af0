// Files that are complete or absent.
#pragma once

#include <filesystem>
#include <string>

namespace pmg::io {

/// Writes a file beside the old one and renames it, so an interruption keeps the old one. Throws std::runtime_error.
void write_whole_file(const std::filesystem::path& file, const std::string& text);

}  // namespace pmg::io
