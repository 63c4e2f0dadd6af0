// Command line of pmg_eval: its subcommands and their options.
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

namespace pmg::apps {

struct EvalArguments {
  std::string robot = "z1";
  std::vector<std::string> policies;
  std::filesystem::path clips, out, scenario, variation = "variation", norms, plants = "table2";
  std::vector<double> strengths_N_s = {0.0, 10.0, 20.0, 30.0, 35.0, 40.0, 50.0};
  int seeds = 20, trials = 200, tasks = 100, jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  std::size_t first = 0;
  double speed_m_s = 0.8, duration_s = 60.0;
  bool gantry = false, nominal = false, video = false, json = false, overwrite = false;

  /// Makes the folder of --out. Throws files::ConfigError if it holds an evaluation and --overwrite isn't given.
  void make_folder() const;
  /// Declares all subcommands. The caller parses app afterwards.
  void declare(CLI::App& app);
  /// Name of the parsed subcommand. Fills in the defaults that differ between subcommands.
  std::string finish(const CLI::App& app);

  std::string ranges_file() const { return nominal ? "" : variation.string(); }
};

}  // namespace pmg::apps
