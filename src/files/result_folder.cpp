#include "files/result_folder.hpp"

#include <fmt/format.h>

#include "files/config_error.hpp"

namespace pmg::files {

void expect_unused(const std::filesystem::path& folder, const std::string& what, const std::vector<std::string>& names,
                   const std::string& expected) {
  for (const std::string& name : names) {
    std::error_code error;  // a folder that can't be looked into can't be written to either: said when it is made
    if (std::filesystem::exists(std::filesystem::symlink_status(folder / name, error)))
      raise({folder.string()}, "", fmt::format("holds {} already ({})", what, name), expected);
  }
}

}  // namespace pmg::files
