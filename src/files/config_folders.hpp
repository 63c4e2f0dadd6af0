// Where the project's own configuration lies.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace pmg::files {

/// The folders of one kind ("robots", "scenarios", "gamepads"), the first one before the others: below the folder that
/// the environment's PMG_CONFIG names, then beside the running binary (bin/../share/pmg/KIND: an installed prefix and a
/// build tree have it). They need not exist, but PMG_CONFIG's must: throws ConfigError.
std::vector<std::filesystem::path> config_folders(const std::string& kind);

/// The YAML file that a person typed: a name ("tour") is one below config_folders(kind), anything with a folder or an
/// ending is a file. Throws ConfigError for an unknown name, with the nearest known one; what: the word for such a
/// file.
std::filesystem::path config_file(const std::string& kind, const std::string& what, const std::string& typed);

}  // namespace pmg::files
