// model::LegKinematics (KDL chains of any robot) against the same leg written by hand for one robot.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <cstdlib>

#include "benchmarks/leg_chain_floor.hpp"
#include "benchmarks/walking_states.hpp"
#include "generator_core/allocation_count.hpp"
#include "model/leg_kinematics.hpp"

namespace pmg::test {
namespace {

void BM_leg_kinematics(benchmark::State& state) {
  const WalkingStates states;
  model::LegKinematics legs(states.robot);
  std::size_t tick = 0;
  const long before = allocation_count();
  for (auto _ : state) {
    const Reference& reference = states.at(tick++);
    benchmark::DoNotOptimize(legs.compute(reference.q, reference.dq).data());
    benchmark::ClobberMemory();
  }
  state.counters["allocations_per_call"] =
      benchmark::Counter(static_cast<double>(allocation_count() - before), benchmark::Counter::kAvgIterations);
}

void BM_leg_kinematics_floor(benchmark::State& state) {
  const WalkingStates states;
  PerFoot<LegChainFloor> legs = {LegChainFloor(states.robot, kLeft), LegChainFloor(states.robot, kRight)};
  std::size_t tick = 0;
  for (auto _ : state) {
    const Reference& reference = states.at(tick++);
    for (LegChainFloor& leg : legs) leg.compute(reference.q);
    benchmark::DoNotOptimize(legs.data());
    benchmark::ClobberMemory();
  }
}

/// The floor must compute the same result.
void require_equal_results() {
  const WalkingStates states;
  model::LegKinematics legs(states.robot);
  for (std::size_t i = 0; i < WalkingStates::kCount; ++i) {
    const Reference& reference = states.at(i);
    const auto& feet = legs.compute(reference.q, reference.dq);
    for (const Foot foot : {kLeft, kRight}) {
      LegChainFloor floor(states.robot, foot);
      floor.compute(reference.q);
      const double error =
          (floor.J - feet[foot].J).norm() + (floor.R - feet[foot].R_BF).norm() + (floor.p - feet[foot].p_BF).norm();
      if (error < 1e-12) continue;
      std::fprintf(stderr, "the floor's leg differs from KDL's by %g\n", error);
      std::exit(1);
    }
  }
}

// The median of many short repetitions: robust on a shared machine.
BENCHMARK(BM_leg_kinematics)->Repetitions(31)->ReportAggregatesOnly()->MinTime(0.02);
BENCHMARK(BM_leg_kinematics_floor)->Repetitions(31)->ReportAggregatesOnly()->MinTime(0.02);

}  // namespace
}  // namespace pmg::test

int main(int argc, char** argv) {
  pmg::test::require_equal_results();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
