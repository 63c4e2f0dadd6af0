// Z1 with a policy of its own in MuJoCo, in lockstep; mass, friction, motors and sensor noise are drawn by a seed.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>

#include "control/control_setup.hpp"
#include "control/fixtures.hpp"
#include "folders.hpp"
#include "sil/lockstep.hpp"
#include "sil/sil_hal.hpp"
#include "sil/simulated_robot.hpp"
#include "sim/variation.hpp"

namespace pmg::test {

/// seed 0: the nominal robot; else drawn from config/evaluation/variation.yaml.
inline sim::WorldOptions varied_world(const model::RobotModel& robot, std::uint64_t seed) {
  sim::WorldOptions options = sil::world_with_noise(seed, false);
  static const sim::VariationRanges ranges = sim::load_variation_ranges(
      std::filesystem::path(pmg::test::project_folder()) / "config/evaluation/variation.yaml");
  if (seed > 0) sim::vary(options, ranges, robot, seed);
  return options;
}

class VariedRobot {
 public:
  using WrapPolicy = std::function<std::unique_ptr<policy::Policy>(std::unique_ptr<policy::Policy>)>;
  using ChangeOptions = std::function<void(control::TickOptions&)>;

  explicit VariedRobot(
      std::uint64_t seed, const std::string& policy = "pmg", const WrapPolicy& wrap = [](auto own) { return own; },
      const ChangeOptions& change = [](auto&) {})
      : loaded(loaded_with(policy, wrap, change)),
        robot(loaded.robot),
        world(robot, varied_world(robot, seed)),
        drives(world),
        plant(world),
        tick(control::make_tick(loaded, stopwatch)) {}

  control::LoadedControl loaded;
  const model::RobotModel& robot;
  sim::World world;
  sil::SilHal drives;
  sil::WorldPlant plant;
  io::SimulationClock stopwatch;
  std::unique_ptr<control::Tick> tick;

 private:
  static control::LoadedControl loaded_with(const std::string& policy, const WrapPolicy& wrap,
                                            const ChangeOptions& change) {
    control::ControlSetup setup;
    setup.policy = policy;
    control::LoadedControl loaded = control::load_control(setup);
    loaded.policy = wrap(std::move(loaded.policy));
    change(loaded.options);
    return loaded;
  }
};

/// Back-to-back steps of a scenario.
class ScriptedOperator {
 public:
  ScriptedOperator& then(double duration_s, control::Mode mode, const Command& command = {}) {
    sil::ScenarioStep step;
    step.start_s = scenario.steps.empty() ? 0.0 : scenario.duration_s();
    step.duration_s = duration_s;
    step.mode = mode;
    step.command = command;
    scenario.steps.push_back(step);
    return *this;
  }
  sil::Scenario scenario{.name = "scripted", .steps = {}};
};

/// How many robots a campaign takes: the variable PMG_CAMPAIGN_ROBOTS, or the few that a test has time for.
inline std::uint64_t campaign_robots(std::uint64_t few) {
  const char* asked = std::getenv("PMG_CAMPAIGN_ROBOTS");
  return asked == nullptr ? few : std::strtoull(asked, nullptr, 10);
}

/// The seed of a campaign's first robot: the variable PMG_CAMPAIGN_FIRST, or 1.
inline std::uint64_t campaign_first() {
  const char* asked = std::getenv("PMG_CAMPAIGN_FIRST");
  return asked == nullptr ? 1 : std::strtoull(asked, nullptr, 10);
}

}  // namespace pmg::test
