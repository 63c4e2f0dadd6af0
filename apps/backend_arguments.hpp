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
  /// Throws std::invalid_argument when this build doesn't contain it.
  const hal::BackendKind& kind() const { return factory_.kind(hal_); }
  /// Every option of kind(), given or not. Throws std::invalid_argument when an option of another backend was given.
  hal::OptionValues values() const;

 private:
  struct Declared {
    std::string name;
    hal::OptionValue value;  // as given
    CLI::Option* option;
    std::vector<std::string> kinds;  // that have it
    std::string help;                // of all of them
  };
  void declare(CLI::App& app, const hal::BackendKind& kind, const hal::BackendOption& option);

  hal::BackendFactory factory_;
  std::string hal_;
  std::deque<Declared> declared_;  // CLI11 keeps addresses of the values
};

/// Each value under its name; empty texts are left out.
void add_to(nlohmann::ordered_json& json, const hal::OptionValues& values);

}  // namespace pmg::apps
