// The bus cycle over network interfaces: the kernel's packet sockets and a cable that test/ethercat/cablerun makes.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <optional>
#include <thread>
#include <vector>

#include "ethercat/cable_wire.hpp"
#include "ethercat/cabled_drives.hpp"
#include "ethercat/noting_cable.hpp"
#include "model/robots.hpp"
#include "runtime/periodic_thread.hpp"
#include "runtime/realtime_trap.hpp"
#include "sim/robots.hpp"

namespace pmg::ethercat {
namespace {

constexpr const char* kNoCable = "NOT RUN: expected test/ethercat/cablerun around it (network namespaces, veth)";

model::RobotState standing_robot() {
  model::RobotState truth;
  truth.q = test::z1().q_stand();
  truth.dq = truth.tau = JointVector::Zero(truth.q.size());
  return truth;
}

TEST(EthercatCable, ABusCycleTakesNeitherHeapNorLock) {
  if (!test::over_cable()) GTEST_SKIP() << kNoCable;
  if (!test::trap_available()) GTEST_SKIP() << "a sanitizer replaces the same functions";
  test::CabledDrives cabled(test::z1());
  cabled.feel(standing_robot());
  test::CableWire wire(cabled.wire);
  const io::SimulationClock clock;
  EthercatHal hal(cabled.cable, cabled.setup, test::z1(), clock, wire, [&] { cabled.drives->serve(); }, {});
  model::JointCommand limp = standing_command(test::z1()), acting = limp;
  limp.kp.setZero();
  limp.kd.setZero();
  model::RobotState state;
  const auto cycle = [&](const model::JointCommand& command) {
    const hal::BusStatus status = hal.exchange(command, state);
    cabled.drives->serve();
    cabled.drives->tick(acting);
    cabled.tick_slaves();
    return status;
  };
  for (int k = 0; k < 10; ++k) cycle(limp);
  const model::JointCommand standing = standing_command(test::z1());
  const std::vector<pid_t> watched = {gettid()};
  hal.take_news();
  test::arm_trap(watched);
  for (int k = 0; k < 200; ++k) {
    if (cycle(standing) != hal::BusStatus::kOk) break;
  }
  test::disarm_trap();
  const test::Trapped trapped = test::trapped();
  EXPECT_EQ(hal.take_news(), "");
  EXPECT_EQ(hal.misses(), 0u);
  EXPECT_EQ(trapped.heap, 0) << test::first_trapped();
  EXPECT_EQ(trapped.locks, 0) << test::first_trapped();
}

// Campaign of docs/how-to/hal.md: 31 motors at 500 Hz for a minute (PMG_SECONDS in the environment: another time).
// --gtest_also_run_disabled_tests. Both ends are on one computer: a cycle in which the host woke a thread of one of
// them over 2 ms late is counted apart; with a number of its own, one in which it held a thread or a frame up for less.
TEST(EthercatCable, DISABLED_AMinuteLosesNoFrame) {
  if (!test::over_cable()) GTEST_SKIP() << kNoCable;
  test::CabledDrives cabled(test::z1());
  cabled.cable.interface = "ecat0";
  cabled.feel(standing_robot());
  Passed passed;
  FarEnd far(cabled, passed);
  HostEnd wire("ecat0", passed);
  const io::WallClock clock;
  EthercatHal hal(cabled.cable, cabled.setup, test::z1(), clock, wire, can::sleeping(), {});
  model::JointCommand limp = standing_command(test::z1());
  limp.kp.setZero();
  limp.kd.setZero();
  const model::JointCommand standing = standing_command(test::z1());
  const char* given = std::getenv("PMG_SECONDS");
  const int cycles = 500 * (given != nullptr ? std::atoi(given) : 60);
  std::vector<std::int64_t> costs_ns(static_cast<std::size_t>(cycles)), delays_ns(static_cast<std::size_t>(cycles));
  int count = 0, late = 0;
  bool cable_lost = false;
  std::vector<Span> missed, late_cycles;  // cycles with the one before
  missed.reserve(costs_ns.size());
  late_cycles.reserve(costs_ns.size());
  double cpu_s = 0.0;
  std::atomic<bool> done{false};
  model::RobotState state;
  const auto cpu = [] {
    rusage used{};
    getrusage(RUSAGE_THREAD, &used);
    return static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
           1e-6 * static_cast<double>(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
  };
  double first_s = 0.0;
  runtime::PeriodicThread bus(
      {.name = "bus", .priority = 80}, Master::kPeriod_ns, [&](const control::CycleTiming& timing) {
        if (count >= cycles) return;
        if (count == 0) first_s = cpu();
        const std::uint64_t misses_before = hal.misses();
        // Slaves that left "operational" are called back only under damping, as a controller gives it then.
        cable_lost = hal.exchange(count < 50 || cable_lost ? limp : standing, state) == hal::BusStatus::kLost;
        const std::int64_t done_ns = clock.now_ns();
        costs_ns[static_cast<std::size_t>(count)] = done_ns - timing.woke_ns;
        delays_ns[static_cast<std::size_t>(count)] = timing.woke_ns - timing.planned_ns;
        const bool is_late = timing.woke_ns - timing.planned_ns > Master::kPeriod_ns;
        late += is_late ? 1 : 0;
        if (is_late) late_cycles.push_back({timing.planned_ns, done_ns});
        if (hal.misses() > misses_before) missed.push_back({timing.woke_ns - Master::kPeriod_ns, done_ns});
        if (++count == cycles) {
          cpu_s = cpu() - first_s;
          done = true;
        }
      });
  const std::int64_t begin_ns = clock.now_ns();
  bus.start(begin_ns);
  while (!done) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    if (const std::string news = hal.take_news(); !news.empty())
      fmt::print("{:.2f} s: {}\n", 1e-9 * static_cast<double>(clock.now_ns() - begin_ns), news);
  }
  const double took_s = 1e-9 * static_cast<double>(clock.now_ns() - begin_ns);
  bus.stop();
  std::vector<Span> held_up = far.stop();
  held_up.insert(held_up.end(), wire.stalls().begin(), wire.stalls().end());
  int misses = 0, by_waking = 0, by_host = 0, by_host_short = 0, after = 0;
  std::int64_t apart_until_ns = 0;
  for (const Span& cycle : missed) {
    const std::int64_t held_up_ns = longest_beside(held_up, cycle);
    const bool waking = longest_beside(late_cycles, cycle) > 0;
    const bool follows = cycle.begin_ns < apart_until_ns;
    ++(waking                            ? by_waking
       : held_up_ns > Master::kPeriod_ns ? by_host
       : held_up_ns > 0                  ? by_host_short
       : follows                         ? after
                                         : misses);
    if (waking || held_up_ns > 0 || follows) apart_until_ns = cycle.end_ns;
  }
  std::uint64_t sent = 0, received = 0, not_sent = 0, lost = 0;
  for (std::size_t b = 0; b < cabled.setup.buses.size(); ++b) {
    const can::LinkCounts& counts = hal.can().link(b).counts();
    sent += counts.sent;
    received += counts.received;
    not_sent += counts.not_sent;
    for (std::size_t m = 0; m < cabled.setup.buses[b].motors.size(); ++m) lost += hal.can().motor(b, m).lost();
  }
  std::ranges::sort(costs_ns);
  std::ranges::sort(delays_ns);
  const auto at = [&](const std::vector<std::int64_t>& sorted, double share) {
    return 1e-3 * static_cast<double>(sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))]);
  };
  fmt::print("{} cycles in {:.1f} s ({}); {} woken over 2 ms late\n", cycles, took_s,
             bus.refused().empty() ? "SCHED_FIFO" : "ordinary scheduling", late);
  fmt::print(
      "misses: {}; counted apart: {} where the bus thread woke over 2 ms late, {} where a thread or a frame was held "
      "up "
      "over 2 ms, {} where {} us to 2 ms, {} right after one of these\n",
      misses, by_waking, by_host, by_host_short, kHeldUp_ns / 1000, after);
  fmt::print(
      "cycle cost p50 {:.1f} us, p99 {:.1f} us; woken late by p50 {:.1f} us, p99 {:.1f} us; CPU {:.1f} % of one core\n",
      at(costs_ns, 0.5), at(costs_ns, 0.99), at(delays_ns, 0.5), at(delays_ns, 0.99), 100.0 * cpu_s / took_s);
  fmt::print("CAN frames in process data: {} sent, {} received, {} not sent, {} answers lost\n", sent, received,
             not_sent, lost);
  EXPECT_EQ(misses, 0);
  EXPECT_EQ(not_sent, 0u);
  if (missed.empty()) {
    EXPECT_EQ(lost, 0u);
  }
}

}  // namespace
}  // namespace pmg::ethercat
