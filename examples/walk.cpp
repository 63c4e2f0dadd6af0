// Z1 stands up and walks for five seconds in MuJoCo, balanced by its policy, as fast as this computer can: prints time,
// mode and place twice a second.
#include <cstdio>

#include "control/control_setup.hpp"
#include "io/clock.hpp"
#include "sil/lockstep.hpp"
#include "sil/sil_hal.hpp"
#include "sim/world.hpp"

int main() {
  using namespace pmg;
  control::ControlSetup setup;
  setup.robot = "z1";
  setup.policy = "pmg";
  control::LoadedControl loaded = control::load_control(setup);
  const io::WallClock stopwatch;
  const auto tick = control::make_tick(loaded, stopwatch);  // 100 Hz: generator, ground-aware command, policy, limits
  sim::World world(loaded.robot, {});
  sil::SilHal bus(world);
  sil::WorldPlant plant(world);

  sil::ScenarioStep stand, walk;
  stand.duration_s = walk.start_s = 2.0;
  walk.duration_s = 5.0;
  walk.mode = control::Mode::kWalk;
  walk.command[kVx] = 0.5;     // m/s
  walk.command[kOmega] = 0.2;  // rad/s
  sil::Scenario scenario;
  scenario.steps = {stand, walk};

  sil::Lockstep run(loaded.robot, bus, plant, *tick, scenario, nullptr, {.balanced_by_policy = true});
  int ticks = 0;
  run.after_tick = [&](const sil::RunProgress& progress) {
    if (++ticks % 50 != 0) return;
    const model::GroundTruth truth = world.truth();
    std::printf("%4.1f s  %s  x %5.2f m  y %5.2f m\n", progress.time_s, control::to_string(progress.result.mode),
                truth.p_WB.x(), truth.p_WB.y());
  };
  const sil::RunOutcome outcome = run.run();
  std::printf("%s\n", outcome.fell ? "it fell" : "it stands");
  return outcome.fell ? 1 : 0;
}
