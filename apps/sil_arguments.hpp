// Command line of pmg_sil, and the resulting configuration.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "control/control_setup.hpp"
#include "runtime/bench_session.hpp"

namespace pmg::apps {

struct SilArguments {
  control::ControlSetup control;
  std::filesystem::path scenario, out, export_mjcf, motor, vary, excitation, inject;
  std::string bench, lcm_url;
  std::uint64_t seed = 0;
  bool gantry = false, realtime = false, video = false, viewer = false, json = false, print_config = false,
       overwrite = false;

  void declare(CLI::App& app);
  bool by_operators() const { return realtime && scenario.empty(); }
};

/// (arguments, control) => (configuration in force). bench: null without --bench.
nlohmann::ordered_json config_json(const SilArguments& arguments, const control::LoadedControl& loaded,
                                   const runtime::BenchSession* bench);

}  // namespace pmg::apps
