// Files of made-up benches.
#pragma once

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

namespace pmg::literature {

/// The rows to fit and to score, in the column `use` of runs.csv.
inline constexpr const char* kFitFilter = "use == fit";
inline constexpr const char* kScoreFilter = "use == score";

/// Throws std::runtime_error when the file can't be written.
inline void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream stream(file);
  stream << text;
  stream.close();
  if (!stream) throw std::runtime_error(file.string() + " cannot be written");
}

}  // namespace pmg::literature
