// The folder of --out: results of an earlier command stay unless --overwrite is given.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "files/result_folder.hpp"

namespace pmg::apps {

/// What a command writes into its folder.
struct Results {
  std::string what;                ///< as in "a run"
  std::vector<std::string> names;  ///< of all its files: one of them is enough to refuse the folder
};

inline CLI::Option* add_overwrite(CLI::App& app, bool& overwrite) {
  return app.add_flag("--overwrite", overwrite, "replace the results that the folder holds");
}

/// Before the work. Throws files::ConfigError if the folder holds such results and they may not be replaced.
inline void expect_unused(const std::filesystem::path& folder, const Results& results, bool overwrite) {
  if (!overwrite) files::expect_unused(folder, results.what, results.names, "a new folder, or --overwrite");
}

/// The same, then makes the folder without such results: no file of an earlier command lies beside those to come.
inline void make_result_folder(const std::filesystem::path& folder, const Results& results, bool overwrite) {
  expect_unused(folder, results, overwrite);
  std::filesystem::create_directories(folder);
  for (const std::string& name : results.names) std::filesystem::remove(folder / name);
}

}  // namespace pmg::apps
