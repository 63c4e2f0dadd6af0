#include "files/config_folders.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <system_error>

#include "files/config_error.hpp"
#include "files/nearest_name.hpp"

namespace pmg::files {
namespace fs = std::filesystem;

std::vector<fs::path> config_folders(const std::string& kind) {
  std::vector<fs::path> folders;
  if (const char* named = std::getenv("PMG_CONFIG"); named != nullptr && *named != '\0') {
    if (!fs::is_directory(named)) {
      throw ConfigError(std::string("PMG_CONFIG: '") + named + "' isn't a folder; expected the one with robots/");
    }
    folders.push_back(fs::path(named) / kind);
  }
  std::error_code error;
  const fs::path binary = fs::read_symlink("/proc/self/exe", error);
  // Canonical: in a build tree share/pmg is a link to config/, whose name logs and messages show.
  const fs::path prefix = error ? fs::path("/usr") : binary.parent_path().parent_path();
  folders.push_back(fs::weakly_canonical(prefix / "share" / "pmg") / kind);
  return folders;
}

fs::path config_file(const std::string& kind, const std::string& what, const std::string& typed) {
  if (typed.find('/') != std::string::npos || fs::path(typed).has_extension() || fs::is_regular_file(typed))
    return typed;
  std::vector<std::string> known;
  for (const fs::path& folder : config_folders(kind)) {
    if (fs::exists(folder / (typed + ".yaml"))) return folder / (typed + ".yaml");
    if (!fs::is_directory(folder)) continue;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
      if (entry.path().extension() == ".yaml") known.push_back(entry.path().stem().string());
  }
  std::ranges::sort(known);
  throw ConfigError(fmt::format("{} '{}' is neither known nor a file; {}", what, typed, expected_name(typed, known)));
}

}  // namespace pmg::files
