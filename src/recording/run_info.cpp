#include "recording/run_info.hpp"

#include <cctype>

#include "software_version.hpp"

namespace pmg::recording {

std::filesystem::path other_log_folder(const RunInfo& run) {
  std::string name = "pmg-" + run.robot + "-" + std::to_string(run.session);
  for (char& letter : name) {
    if (!std::isalnum(static_cast<unsigned char>(letter)) && letter != '-' && letter != '_') letter = '_';
  }
  return std::filesystem::temp_directory_path() / name;
}

const char* software_version() noexcept { return PMG_SOFTWARE_VERSION; }

}  // namespace pmg::recording
