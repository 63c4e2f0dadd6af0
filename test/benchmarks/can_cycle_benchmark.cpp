// A bus cycle of Z1's 31 motors in each dialect, and with drives of both protocols, over memory: p50 and p99 of what
// the bus thread computes, in CPU time of the thread, the share of a core at 500 Hz, and its heap allocations. What a
// kernel takes for its sockets is not in it.
#include <benchmark/benchmark.h>
#include <time.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "can/can_hal.hpp"
#include "can/canopen_setup.hpp"
#include "can/emulated_drives.hpp"
#include "can/memory_link.hpp"
#include "can/mixed_drives.hpp"
#include "drive_protocols/damiao.hpp"
#include "drive_protocols/mini_cheetah.hpp"
#include "drive_protocols/robstride.hpp"
#include "folders.hpp"
#include "generator_core/allocation_count.hpp"

namespace pmg::test {
namespace {

/// CPU time of this thread: other programs don't count.
std::int64_t cpu_ns() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

const model::RobotModel& z1() {
  static const model::RobotModel robot = model::load_robot(project_folder() + "/config/robots/z1");
  return robot;
}

template <typename Drive>
can::DriveSetup speaking() {
  can::DriveSetup setup = can::load_drives(z1());
  for (can::BusSetup& bus : setup.buses) {
    for (drives::MotorSetup& motor : bus.motors)
      motor.drive = std::make_shared<Drive>(drives::as_mit(motor.drive)->ranges());
  }
  return setup;
}

model::JointCommand standing(double stiffness) {
  model::JointCommand command;
  command.q = z1().q_stand();
  const Eigen::Index n = command.q.size();
  command.dq = command.tau_ff = command.kp = command.kd = JointVector::Zero(n);
  for (Eigen::Index j = 0; j < n; ++j) {
    command.kp[j] = stiffness * z1().joints[static_cast<std::size_t>(j)].kp_Nm_per_rad;
    command.kd[j] = stiffness * z1().joints[static_cast<std::size_t>(j)].kd_Nm_s_per_rad;
  }
  return command;
}

void cycles(benchmark::State& state, const can::DriveSetup& setup) {
  constexpr std::size_t kCycles = 10'000;
  constexpr std::int64_t kPeriod_ns = 2'000'000;
  for (auto _ : state) {
    std::vector<std::unique_ptr<can::Link>> here, there;
    for (std::size_t b = 0; b < setup.buses.size(); ++b) {
      auto [near, far] = MemoryLink::pair();
      here.push_back(std::move(near));
      there.push_back(std::move(far));
    }
    EmulatedDrives drives(setup, std::move(there));
    model::RobotState truth, sample;
    truth.q = z1().q_stand();
    truth.dq = truth.tau = JointVector::Zero(truth.q.size());
    drives.feel(truth);
    can::set_up_nodes(setup, here, [&drives] { drives.answer(); }, {});
    io::SimulationClock clock;
    can::CanHal hal(setup, z1(), clock, std::move(here));
    const model::JointCommand limp = standing(0.0), stiff = standing(1.0);
    model::JointCommand acting = limp;
    std::vector<std::int64_t> costs_ns;
    costs_ns.reserve(kCycles);
    long heap = 0;
    std::size_t good = 0;
    for (std::size_t k = 0; k < kCycles; ++k) {
      clock.advance_to(static_cast<std::int64_t>(k + 1) * kPeriod_ns);
      drives.feel(truth);
      const long heap_before = allocation_count();
      const std::int64_t begin_ns = cpu_ns();
      hal.send(k < 20 ? limp : stiff);
      const std::int64_t sent_ns = cpu_ns();
      drives.serve();
      const std::int64_t served_ns = cpu_ns();
      good += hal.receive(sample) == hal::BusStatus::kOk ? 1 : 0;
      costs_ns.push_back(cpu_ns() - served_ns + sent_ns - begin_ns);
      heap = std::max(heap, allocation_count() - heap_before);
      drives.answer();
      drives.tick(acting);
    }
    if (good + 20 < kCycles) {
      state.SkipWithError(describe(hal.trouble(), setup).c_str());
      break;
    }
    double sum_ns = 0.0;
    for (const std::int64_t cost_ns : costs_ns) sum_ns += static_cast<double>(cost_ns);
    std::ranges::sort(costs_ns);
    state.counters["cycle_p50_ns"] = static_cast<double>(costs_ns[kCycles / 2]);
    state.counters["cycle_p99_ns"] = static_cast<double>(costs_ns[kCycles * 99 / 100]);
    state.counters["core_percent"] = 100.0 * sum_ns / static_cast<double>(kCycles) / static_cast<double>(kPeriod_ns);
    state.counters["allocations_per_call"] = static_cast<double>(heap);
  }
}

void BM_can_cubemars(benchmark::State& state) { cycles(state, can::load_drives(z1())); }
void BM_can_damiao(benchmark::State& state) { cycles(state, speaking<drives::DamiaoDrive>()); }
void BM_can_mini_cheetah(benchmark::State& state) { cycles(state, speaking<drives::MiniCheetahDrive>()); }
void BM_can_robstride(benchmark::State& state) { cycles(state, speaking<drives::RobstrideDrive>()); }
void BM_can_cia402_and_mit(benchmark::State& state) { cycles(state, mixed_drives(z1())); }

BENCHMARK(BM_can_cubemars)->Iterations(1)->Repetitions(5)->ReportAggregatesOnly();
BENCHMARK(BM_can_damiao)->Iterations(1)->Repetitions(5)->ReportAggregatesOnly();
BENCHMARK(BM_can_mini_cheetah)->Iterations(1)->Repetitions(5)->ReportAggregatesOnly();
BENCHMARK(BM_can_robstride)->Iterations(1)->Repetitions(5)->ReportAggregatesOnly();
BENCHMARK(BM_can_cia402_and_mit)->Iterations(1)->Repetitions(5)->ReportAggregatesOnly();

}  // namespace
}  // namespace pmg::test

BENCHMARK_MAIN();
