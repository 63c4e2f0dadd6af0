// pmg_clips inspect: what a recording of a human holds.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>

namespace pmg::apps {

struct InspectOptions {
  std::filesystem::path file, names, skeleton, rest_pose;
  std::optional<double> rate_hz, unit_m;
  std::string up;
  bool json = false;
};

/// The subcommand and its options.
CLI::App* add_inspect(CLI::App& app, InspectOptions& options);

/// Prints what the recording holds. Throws files::ConfigError.
int inspect(const InspectOptions& options);

}  // namespace pmg::apps
