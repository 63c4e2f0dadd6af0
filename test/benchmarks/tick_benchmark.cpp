// The whole control tick with a trained policy, walking through all channels in simulation: p50 and p99 of its stages
// in CPU time of the thread, and its heap allocations. Physics runs between the ticks, so caches are as cold as
// possible.
#include <benchmark/benchmark.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <string>

#include "benchmarks/trained_policy.hpp"
#include "folders.hpp"
#include "generator_core/allocation_count.hpp"
#include "model/clip_library_file.hpp"
#include "sil/lockstep.hpp"
#include "sil/sil_hal.hpp"
#include "sil/simulated_robot.hpp"

namespace pmg::test {
namespace {

/// CPU time of this thread: other programs don't count.
class ThreadCpuClock final : public io::Clock {
 public:
  std::int64_t now_ns() const noexcept override {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
  }
};

sil::Scenario walking() {
  sil::Scenario scenario;
  scenario.name = "benchmark";
  const std::array<Command, 4> commands = {Command{{0.5, 0.0, 0.0, 0.0, 0.0, 0.0}},
                                           Command{{0.3, 0.0, 0.4, 0.1, 0.0, 0.0}},
                                           Command{{0.2, 0.1, 0.2, 0.1, 0.05, -0.04}}, Command{}};
  for (const Command& command : commands) {
    sil::ScenarioStep step;
    step.duration_s = 3.0;
    step.start_s = step.duration_s * static_cast<double>(scenario.steps.size());
    step.text = "walk";
    step.mode = control::Mode::kWalk;
    step.command = command;
    scenario.steps.push_back(step);
  }
  return scenario;
}

/// Counted from tick to tick, so for the tick, its bus cycles, and the physics, which makes none.
class AllocationsPerTick {
 public:
  void tick(bool driving) {
    const long now = allocation_count();
    if (driving && was_driving_) {
      least = std::min(least, now - before_);
      most = std::max(most, now - before_);
    }
    was_driving_ = driving;
    before_ = now;
  }
  long least = 1L << 30, most = 0;

 private:
  long before_ = 0;
  bool was_driving_ = false;
};

/// On the gantry: the cost of a tick doesn't depend on how well the policy fits today's clips.
void BM_tick(benchmark::State& state) {
  const model::RobotModel robot = model::load_robot(pmg::test::project_folder() + "/config/robots/z1");
  const ClipLibrary library = model::load_clip_library(robot.directory / "clips", robot);
  const sil::Scenario played = walking();
  const ThreadCpuClock stopwatch;
  control::TickOptions options = control::tick_options(robot);
  options.action_monitor.persist_ticks = 1'000'000;  // feet without ground make the policy reach for it
  options.foot_load.lost_share = -2e9;               // the policy runs anyway
  options.foot_load.lost_walking_share = -2e9;
  options.foot_load.least_walking_share = -3e9;
  options.foot_load.found_share = -1e9;
  for (auto _ : state) {
    sim::World world(robot, sil::world_with_noise(1, true));
    control::Tick tick(robot, library, trained_policy(robot), stopwatch, options);
    sil::SilHal bus(world);
    sil::WorldPlant plant(world);
    sil::Lockstep lockstep(robot, bus, plant, tick, played, nullptr,
                           {.balanced_by_policy = true, .always_hoisted = true});
    AllocationsPerTick allocations;
    int walked = 0;
    lockstep.after_tick = [&](const sil::RunProgress& now) {
      const bool walks = now.result.mode == control::Mode::kWalk;
      walked += walks;
      allocations.tick(walks);
    };
    const sil::RunOutcome outcome = lockstep.run();
    if (walked < 1000) {
      state.SkipWithError(outcome.faults.empty() ? "the robot hardly walked" : to_string(outcome.faults[0].code));
      break;
    }
    const auto report = [&](const std::string& stage, std::int64_t control::StageTimes::*time) {
      const sil::Percentiles times = lockstep.timing().percentiles(time);
      state.counters[stage + "_p50_ns"] = 1e3 * times.p50_us;
      state.counters[stage + "_p99_ns"] = 1e3 * times.p99_us;
    };
    report("tick", &control::StageTimes::tick_ns);
    report("generator", &control::StageTimes::generator_ns);
    report("gco", &control::StageTimes::gco_ns);
    report("policy", &control::StageTimes::policy_ns);
    state.counters["allocations_per_call"] = static_cast<double>(allocations.most);
    state.counters["allocations_vary_by"] = static_cast<double>(allocations.most - allocations.least);
  }
}

BENCHMARK(BM_tick)->Iterations(1)->Repetitions(5)->ReportAggregatesOnly()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace pmg::test

BENCHMARK_MAIN();
