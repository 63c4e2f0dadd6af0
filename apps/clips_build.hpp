// pmg_clips build: a clip library from recordings of people.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <string>

#include "model/robot_model.hpp"

namespace pmg::apps {

struct BuildOptions {
  std::string robot = "z1";
  std::filesystem::path recipe, recordings, out;
  bool no_inverse = false;
  bool json = false;
};

/// The subcommand and its options.
CLI::App* add_build(CLI::App& app, BuildOptions& options);

/// Makes the clips; add_inverse(robot, folder) adds the inverse to those in the folder. Prints each clip's figures.
/// Throws files::ConfigError and work::Interrupted; then the folder `out` is as it was.
int build(const BuildOptions& options,
          const std::function<void(const model::RobotModel&, const std::filesystem::path&)>& add_inverse);

}  // namespace pmg::apps
