// Generator::step with 31 joints against its floor: the same number of bare 31-vector multiply-adds (y += a x).
//
// The least work of the method in a tick with three velocity and three posture channels, in multiply-adds of a joint
// vector:
//   24  3 clips, cubic Hermite from 4 knot vectors each, for q and for dq/dphi: 3 x 2 x 4
//    3  dg/dt q_stand and (1 - sum g) q_stand, and the posture offset added into q_ref
//    6  3 posture channels, linear between 2 rows each
//    2  posture rate: difference over the tick, added into dq_ref
//    6  admissible set: the gains' largest excursions up and down, 3 clips
//   41
// Not counted in the floor, only the generator has them: comparisons (the admissible set, the last clamp), the limiter,
// gains, timing and contacts.
#include <benchmark/benchmark.h>

#include <array>

#include "generator_core/allocation_count.hpp"
#include "generator_core/synthetic_library.hpp"

namespace pmg::test {
namespace {

constexpr int kJoints = 31;
constexpr int kMultiplyAdds = 41;

/// All six channels active and moving back and forth.
Command sweep(int tick) {
  const double s = 0.5 + 0.3 * (tick % 200 < 100 ? tick % 100 : 100 - tick % 100) / 100.0;
  return make_command(0.3 * s, 0.1 * s, 0.2 * s, 0.3 * s, 0.1 * s, -0.1 * s);
}

void BM_generator_step(benchmark::State& state) {
  Generator generator(make_library(kJoints), make_options());
  int tick = 0;
  for (; tick < 1000; ++tick) generator.step(sweep(tick), kDt_s);
  const long before = allocation_count();
  for (auto _ : state) {
    double first = generator.step(sweep(tick++), kDt_s).q[0];
    benchmark::DoNotOptimize(first);
  }
  state.counters["allocations_per_call"] =
      benchmark::Counter(static_cast<double>(allocation_count() - before), benchmark::Counter::kAvgIterations);
}

void BM_generator_floor(benchmark::State& state) {
  std::array<JointVector, kMultiplyAdds> x;
  for (JointVector& v : x) v.setConstant(kJoints, 0.1);
  JointVector y = JointVector::Zero(kJoints);
  double a = 1e-9;
  for (auto _ : state) {
    benchmark::DoNotOptimize(a);
    for (const JointVector& v : x) {
      y.noalias() += a * v;
      benchmark::ClobberMemory();  // each one bare: reads y, writes y
    }
    benchmark::DoNotOptimize(y.data());
  }
}

// The median of many short repetitions: robust on a shared machine.
BENCHMARK(BM_generator_step)->Repetitions(31)->ReportAggregatesOnly()->MinTime(0.02);
BENCHMARK(BM_generator_floor)->Repetitions(31)->ReportAggregatesOnly()->MinTime(0.02);

}  // namespace
}  // namespace pmg::test

BENCHMARK_MAIN();
