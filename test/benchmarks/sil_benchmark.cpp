// All of pmg_sil, headless and with its log, against bare mj_step calls on the same model: the share of the
// simulation's speed that the controller leaves. CPU time of the thread, so the load of other programs doesn't count.
#include <benchmark/benchmark.h>
#include <mujoco/mujoco.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include "benchmarks/trained_policy.hpp"
#include "folders.hpp"
#include "generator_core/allocation_count.hpp"
#include "io/clock.hpp"
#include "io/log_writer.hpp"
#include "model/clip_library_file.hpp"
#include "model/robot_model.hpp"
#include "policy/policy.hpp"
#include "recording/tick_log.hpp"
#include "sil/lockstep.hpp"
#include "sil/sil_hal.hpp"
#include "sim/robots.hpp"
#include "sim/world.hpp"

namespace pmg::test {
namespace {

constexpr double kDuration_s = 2.0;

double thread_cpu_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Walk mode on the ground, where contacts cost the most; every part of the tick works.
sil::Scenario scenario() {
  sil::ScenarioStep step;
  step.duration_s = kDuration_s;
  step.text = "crouch and bend";
  step.mode = control::Mode::kWalk;
  step.command[kHeight] = -0.05;
  step.command[kPitch] = 0.1;
  sil::Scenario scenario;
  scenario.name = "benchmark";
  scenario.steps = {step};
  return scenario;
}

using MakePolicy = std::unique_ptr<policy::Policy> (*)(const model::RobotModel&);

void sil(benchmark::State& state, MakePolicy make_policy) {
  const model::RobotModel robot = model::load_robot(pmg::test::project_folder() + "/config/robots/z1");
  const ClipLibrary library = model::load_clip_library(robot.directory / "clips", robot);
  const sil::Scenario played = scenario();
  const control::TickOptions options = control::tick_options(robot);
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "pmg_sil_benchmark.lcm";
  const io::WallClock clock;
  constexpr int kSettledTicks = 100;
  long least = 1L << 30, most = 0;
  for (auto _ : state) {
    sim::World world(robot, {});
    control::Tick tick(robot, library, make_policy(robot), clock, options);
    sil::SilHal bus(world);
    sil::WorldPlant plant(world);
    io::LogWriter writer(file);
    recording::TickLog log(writer, robot, {.robot = robot.name}, 1.0 / options.dt_s);
    sil::Lockstep lockstep(robot, bus, plant, tick, played, &log, {});
    int ticks = 0;
    long before = 0;
    lockstep.after_tick = [&](const sil::RunProgress&) {
      const long now = allocation_count();
      if (++ticks > kSettledTicks) {
        least = std::min(least, now - before);
        most = std::max(most, now - before);
      }
      before = now;
    };
    const double start_s = thread_cpu_s();
    const sil::RunOutcome outcome = lockstep.run();
    state.SetIterationTime(thread_cpu_s() - start_s);
    if (outcome.fell || outcome.diverged) state.SkipWithError("the robot fell");
  }
  state.counters["allocations_per_call"] = static_cast<double>(most);  // per tick: a call is one tick
  state.counters["allocations_vary_by"] = static_cast<double>(most - least);
  std::filesystem::remove(file);
}

void BM_sil(benchmark::State& state) {
  sil(state, [](const model::RobotModel&) -> std::unique_ptr<policy::Policy> {
    return std::make_unique<policy::ReferencePolicy>();
  });
}
void BM_sil_policy(benchmark::State& state) {
  sil(state, [](const model::RobotModel& robot) -> std::unique_ptr<policy::Policy> { return trained_policy(robot); });
}

/// The world's own model, which has no friction constraints, on MuJoCo's position servos with robot.yaml's gains.
void BM_sil_floor(benchmark::State& state) {
  const model::RobotModel robot = model::load_robot(pmg::test::project_folder() + "/config/robots/z1");
  const sim::WorldOptions options;
  for (auto _ : state) {
    sim::World world(robot, options);
    const std::unique_ptr<mjModel, decltype(&mj_deleteModel)> bare(mj_copyModel(nullptr, world.mj_model()),
                                                                   mj_deleteModel);
    mjData* data = world.mj_data();
    for (int j = 0; j < bare->nu; ++j) {
      const model::Joint& joint = robot.joints[static_cast<std::size_t>(j)];
      mjtNum* bias = bare->actuator_biasprm + j * mjNBIAS;
      bare->actuator_gainprm[j * mjNGAIN] = joint.kp_Nm_per_rad;
      bias[1] = -joint.kp_Nm_per_rad;
      bias[2] = -joint.kd_Nm_s_per_rad;
      data->ctrl[j] = joint.stand_rad;
    }
    const int steps = static_cast<int>(kDuration_s / options.timestep_s);
    const double start_s = thread_cpu_s();
    for (int i = 0; i < steps; ++i) mj_step(bare.get(), data);
    state.SetIterationTime(thread_cpu_s() - start_s);
    if (std::abs(data->qpos[2] - robot.standing_height_m) > 0.03) state.SkipWithError("the robot fell");
  }
}

BENCHMARK(BM_sil)->UseManualTime()->Iterations(1)->Repetitions(9)->ReportAggregatesOnly()->Unit(
    benchmark::kMillisecond);
BENCHMARK(BM_sil_policy)
    ->UseManualTime()
    ->Iterations(1)
    ->Repetitions(9)
    ->ReportAggregatesOnly()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(BM_sil_floor)
    ->UseManualTime()
    ->Iterations(1)
    ->Repetitions(9)
    ->ReportAggregatesOnly()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace pmg::test

BENCHMARK_MAIN();
