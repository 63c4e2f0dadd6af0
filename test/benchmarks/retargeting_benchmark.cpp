// What a person's cycle costs on its way to a clip, on one core: retargeting, and the fits for blending after it.
#include <benchmark/benchmark.h>

#include "generator/static_clips.hpp"
#include "mocap/gait_cycle.hpp"
#include "mocap/synthetic_gait.hpp"
#include "retargeting/retargeting.hpp"

namespace pmg::test {
namespace {

/// One retargeting of a made-up walk a call. Counters: clip samples made a second of CPU time, of the file's reading to
/// a clip at full gain (as published retargeters count), and of the fits at full and half gain after it.
void BM_retargeting(benchmark::State& state) {
  const model::RobotModel robot = model::load_robot(model::find_robot("z1"));
  generator::Making making{robot, generator::find_joint_roles(robot), {}, {}};
  making.legs = generator::robot_legs(robot, making.roles);
  making.posture = {generator::make_bend(robot, making.roles, making.legs),
                    generator::make_lean(robot, making.roles, making.legs),
                    generator::make_squat(robot, making.roles, making.legs)};
  const mocap::Recording recording = mocap::test::walk({.leg_m = 0.85, .rate_hz = 100.0, .heading_rad = 1.0});
  const auto cycle = mocap::best_cycle(recording, mocap::find_steps(recording), 0.0, recording.duration_s());
  if (!cycle) {
    state.SkipWithError("the made-up walk has no cycle");
    return;
  }
  double retarget_s = 0.0, fit_s = 0.0;
  for (auto _ : state) {
    retargeting::RetargetedClip made = retargeting::retarget(making, recording, *cycle, kVx);
    retargeting::fit_full_gain(making, made);
    retargeting::fit_half_gain(making, {}, made);
    retarget_s += made.retarget_s;
    fit_s += made.fit_s;
  }
  const double samples = static_cast<double>(state.iterations()) * static_cast<double>(generator::kClipSamples);
  state.counters["samples_per_s"] = samples / retarget_s;
  state.counters["fitted_samples_per_s"] = samples / fit_s;
}
BENCHMARK(BM_retargeting)->Unit(benchmark::kMillisecond)->Repetitions(3)->ReportAggregatesOnly();

}  // namespace
}  // namespace pmg::test

BENCHMARK_MAIN();
