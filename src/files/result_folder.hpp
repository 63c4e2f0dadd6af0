// One command, one folder: what an earlier command wrote stays, unless the user says otherwise.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace pmg::files {

/// Throws ConfigError if the folder has a file or folder of one of these names. what: the results that these are, as in
/// "a run"; expected: the end of the error.
void expect_unused(const std::filesystem::path& folder, const std::string& what, const std::vector<std::string>& names,
                   const std::string& expected = "a new folder");

}  // namespace pmg::files
