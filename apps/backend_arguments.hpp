// --hal NAME, and the options of every backend of this build.
#pragma once

#include <CLI/CLI.hpp>
#include <deque>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "hal/backend_factory.hpp"

namespace pmg::apps {

class BackendArguments {
 public:
  explicit BackendArguments(hal::BackendFactory factory) : factory_(std::move(factory)) {}

  void declare(CLI::App& app);

  const std::string& hal() const { return hal_; }
  /// Name of the backend. Throws std::invalid_argument if this build does not contain it.
  const hal::BackendKind& kind() const { return factory_.kind(hal_); }
  /// Values of all options of kind(), given or default. Throws std::invalid_argument if the command line has an option
  /// of another backend.
  hal::OptionValues values() const;

 private:
  struct Declared {
    std::string name;
    hal::OptionValue value;  // as given
    CLI::Option* option;
    std::vector<std::string> kinds;  // backends with this option
    std::string help;                // help of all these backends
  };
  void declare(CLI::App& app, const hal::BackendKind& kind, const hal::BackendOption& option);

  hal::BackendFactory factory_;
  std::string hal_;
  std::deque<Declared> declared_;  // CLI11 keeps addresses of the values: a deque does not move them
};

/// (values) => (values by name). Leaves out empty texts.
void add_to(nlohmann::ordered_json& json, const hal::OptionValues& values);

}  // namespace pmg::apps
