// Command line of pmg_controller, and the resulting configuration.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "backend_arguments.hpp"
#include "backends.hpp"
#include "control/control_setup.hpp"
#include "runtime/bench_session.hpp"
#include "runtime/controller.hpp"

namespace pmg::apps {

struct ControllerArguments {
  BackendArguments backend{backends()};
  control::ControlSetup control;
  std::string name, lcm_url, keys;
  std::filesystem::path log, excitation, bench_out, inject;
  std::string bench;
  bool insecure = false;  ///< a network without keys
  bool no_log = false, no_realtime = false, print_config = false, json = false;
  std::optional<double> duration_s;
  runtime::ControllerOptions threads;

  void declare(CLI::App& app);
  bool benching() const { return !bench.empty(); }
};

/// (arguments, control, backend) => (configuration in force). bench: null without --bench.
nlohmann::ordered_json config_json(const ControllerArguments& arguments, const control::LoadedControl& loaded,
                                   const hal::Backend& backend, const runtime::BenchSession* bench);

}  // namespace pmg::apps
