#include "recording/run_folder.hpp"

#include <algorithm>
#include <string>

namespace pmg::recording {

namespace fs = std::filesystem;

namespace {

/// Logs, and the records of faults, end so (recorder.hpp, flight_recorder.hpp).
bool has_log(const fs::path& folder) {
  if (!fs::is_directory(folder)) return false;
  return std::ranges::any_of(fs::directory_iterator(folder),
                             [](const fs::directory_entry& entry) { return entry.path().extension() == ".lcm"; });
}

}  // namespace

fs::path run_folder(const fs::path& asked) {
  const fs::path named = asked.has_filename() ? asked : asked.parent_path();  // "out/first/" is out/first
  fs::path folder = named;
  for (int number = 2; has_log(folder); ++number) folder = named.string() + "-" + std::to_string(number);
  return folder;
}

}  // namespace pmg::recording
