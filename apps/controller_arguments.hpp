// Command line of pmg_controller, and the resulting configuration.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>

#include "backend_arguments.hpp"
#include "control/control_setup.hpp"
#include "controller_excitation.hpp"
#include "runtime/controller.hpp"

namespace pmg::apps {

struct ControllerArguments {
  explicit ControllerArguments(hal::BackendFactory backends) : backend(std::move(backends)) {}

  BackendArguments backend;
  control::ControlSetup control;
  std::string name, lcm_url, keys;
  std::filesystem::path log, excitation, bench_out, inject;
  std::string bench, excite;
  bool insecure = false;  ///< a network without keys
  bool no_log = false, no_realtime = false, despite_doctor = false, print_config = false, json = false;
  std::optional<double> duration_s;
  runtime::ControllerOptions threads;

  void declare(CLI::App& app);
  bool benching() const { return !bench.empty(); }
  bool exciting() const { return !excite.empty(); }  ///< the whole robot
};

/// (arguments, control, backend, what is excited) => (configuration in force).
nlohmann::ordered_json config_json(const ControllerArguments& arguments, const control::LoadedControl& loaded,
                                   const hal::Backend& backend, const ControllerExcitation& excitation);

}  // namespace pmg::apps
