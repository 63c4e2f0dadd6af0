// A scripted operator: config/scenarios/*.yaml lists its commands and modes over time.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "control/mode.hpp"
#include "pmg/command.hpp"
#include "sil/hoist.hpp"

namespace pmg::sil {

/// One stretch of a scenario. The command ramps by itself: the generator limits its rates.
struct ScenarioStep {
  double start_s = 0.0;
  double duration_s = 0.0;
  std::string text;  ///< for people: progress line, video
  control::Mode mode = control::Mode::kStand;
  Command command;  ///< channels that the file doesn't name are zero
  /// The gantry carries the robot through this step unless a policy balances it.
  bool hoist_without_policy = false;
  bool steady_without_policy = false;  ///< or steadies it; hoisting goes before
  bool beyond_reach = false;           ///< asks for more than clips give together: evaluations report it apart
  double unjudged_s = 0.0;  ///< of duration_s, at its end: evaluations don't judge it (evaluation/phases.hpp)
  Support support_without_policy() const {
    return hoist_without_policy ? Support::kLifted : steady_without_policy ? Support::kSteady : Support::kNone;
  }
};

struct Scenario {
  std::string name;
  std::vector<ScenarioStep> steps;  ///< at least one, back to back from 0

  double duration_s() const;
  const ScenarioStep& at(double time_s) const;  ///< the last step stays in force at and after the end
};

/// Stand for as long as a joint of this name is excited, then damping.
Scenario bench_scenario(const std::string& joint, double excitation_s);
/// Names a run that operators drive until it is ended.
Scenario endless_scenario();

/// Reads a scenario (docs/reference/file-formats.md). mode and the gantry's part hold on until a later step changes
/// them; a command belongs to its step alone. Throws files::ConfigError with file, line and column.
Scenario load_scenario(const std::filesystem::path& file);

/// Speaks a scenario as an operator would: in every tick a fresh command and the mode it wants.
class ScenarioPlayer {
 public:
  explicit ScenarioPlayer(const Scenario& scenario);

  /// time_s counts from the scenario's start; now_ns is the run's clock.
  void step(double time_s, std::int64_t now_ns) noexcept;
  const ScenarioStep& current() const noexcept { return *current_; }
  std::size_t number() const noexcept;  ///< of the current step, from 1
  const control::DriveMessage& drive() const noexcept { return drive_; }
  const control::ModeRequest& request() const noexcept { return request_; }

 private:
  const Scenario& scenario_;
  const ScenarioStep* current_ = nullptr;
  control::DriveMessage drive_;
  control::ModeRequest request_;
};

}  // namespace pmg::sil
