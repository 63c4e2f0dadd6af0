// The threaded controller: the guarantees of its threads to each other and to the robot, also in every failure.
#include "runtime/controller.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

#include "runtime/threaded_controller.hpp"

namespace pmg::runtime {
namespace {

using test::BreakableBus;
using test::eventually;
using test::ThreadedRobot;
using testing::HasSubstr;

void rest() { std::this_thread::sleep_for(std::chrono::milliseconds(5)); }

TEST(Controller, ClimbsWalksFaultsIsResetAndEndsDamping) {
  ThreadedRobot run(test::z1());
  std::vector<std::int64_t> indices;
  std::vector<control::Mode> modes;
  std::int64_t bus_cycles = 0;
  const auto record = [&] {
    control::TickRecord tick;
    while (run.controller.outbox().records.pop(tick)) {
      indices.push_back(tick.tick);
      if (modes.empty() || modes.back() != tick.result.mode) modes.push_back(tick.result.mode);
      EXPECT_GT(tick.state.bus_sample, 0u) << "control starts when the drives have answered";
      EXPECT_GE(tick.timing.woke_ns, tick.timing.planned_ns);
      EXPECT_GE(tick.timing.done_ns, tick.timing.woke_ns);
    }
    control::CycleTiming cycle;
    while (run.controller.outbox().bus_cycles.pop(cycle)) ++bus_cycles;
  };
  run.controller.start([&] { run.speaker(); }, record);
  ASSERT_TRUE(run.sees(control::Mode::kPassive));
  ASSERT_TRUE(run.reach(control::Mode::kStand));
  ASSERT_TRUE(run.reach(control::Mode::kWalk));
  run.bus.lost = true;
  ASSERT_TRUE(run.sees(control::Mode::kFault));
  EXPECT_EQ(run.news.fault.code, faults::FaultCode::kBusLost);
  run.bus.lost = false;
  ASSERT_TRUE(run.reach(control::Mode::kDamping, true));
  ASSERT_TRUE(run.reach(control::Mode::kStand));
  EXPECT_TRUE(run.controller.stop());

  EXPECT_EQ(run.bus.last_kp_sum, 0.0) << "the drives' last command is damping";
  EXPECT_GT(run.bus.last_kd_sum, 0.0);
  EXPECT_EQ(modes.front(), control::Mode::kPassive);
  EXPECT_EQ(modes.back(), control::Mode::kDamping);
  EXPECT_EQ(run.controller.outbox().dropped().records, 0);
  EXPECT_EQ(run.controller.outbox().dropped().bus_cycles, 0);
  EXPECT_EQ(bus_cycles, run.controller.bus_statistics().cycles());
  ASSERT_EQ(static_cast<std::int64_t>(indices.size()), run.controller.control_statistics().cycles());
  for (std::size_t i = 1; i < indices.size(); ++i) ASSERT_EQ(indices[i], indices[i - 1] + 1);
}

TEST(Controller, ThreadsHaveTheKernelsWordForTheirScheduling) {
  ThreadedRobot run(test::z1());
  const KernelSchedule bus = kernel_schedule(run.controller.bus_thread());
  const KernelSchedule control = kernel_schedule(run.controller.control_thread());
  if (run.controller.refused().empty()) {
    EXPECT_EQ(bus.policy, SCHED_FIFO);
    EXPECT_EQ(control.policy, SCHED_FIFO);
    EXPECT_GT(bus.priority, control.priority);
  } else {
    EXPECT_THAT(testing::PrintToString(run.controller.refused()),
                testing::AnyOf(HasSubstr("SCHED_FIFO"), HasSubstr("mlockall")));
  }
}

TEST(Controller, WithoutRealTimeItRunsAndSaysSo) {
  ThreadedRobot run(test::z1(), {.realtime = false});
  EXPECT_EQ(kernel_schedule(run.controller.bus_thread()).policy, SCHED_OTHER);
  ASSERT_EQ(run.controller.refused().size(), 1u);
  EXPECT_THAT(run.controller.refused()[0], HasSubstr("not asked for"));
  run.controller.start(rest, [] {});
  EXPECT_TRUE(run.sees(control::Mode::kPassive));
  EXPECT_TRUE(run.controller.stop());
}

TEST(Controller, DrivesThatNeverAnswerEndTheStartWithOneLine) {
  ThreadedRobot run(test::z1(), {.first_sample_within_s = 0.05});
  run.bus.lost = true;
  try {
    run.controller.start(rest, [] {});
    FAIL() << "it started";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("the drives did not answer within 0.1 s"));
  }
  ControllerNews news;
  EXPECT_FALSE(run.controller.news(news)) << "control never ran";
}

TEST(Controller, AThrowInAnOrdinaryThreadDampsAndIsTold) {
  ThreadedRobot run(test::z1());
  std::atomic<bool> broken{false};
  run.controller.start([&] { run.speaker(); },
                       [&] {
                         if (broken) throw std::runtime_error("no paper");
                       });
  ASSERT_TRUE(run.reach(control::Mode::kStand));
  EXPECT_EQ(run.controller.failure(), "");
  ASSERT_TRUE(eventually([&] { return run.bus.last_kp_sum > 0.0; }));
  broken = true;
  EXPECT_TRUE(run.sees(control::Mode::kDamping));
  EXPECT_TRUE(eventually([&] { return run.bus.last_kp_sum == 0.0; }));
  EXPECT_TRUE(eventually([&] { return !run.controller.failure().empty(); }));
  EXPECT_EQ(run.controller.failure(), "thread recorder: no paper");
  EXPECT_TRUE(run.controller.stop());
}

TEST(Controller, TheBusGuardHasTheTicksOptions) {
  const model::RobotModel& robot = test::z1();
  const io::WallClock clock;
  control::TickOptions options = control::tick_options(robot);
  options.guard = {.hold_cycles = 7, .max_kp_Nm_per_rad = 1500.0, .max_kd_Nm_s_per_rad = 90.0};
  control::Tick tick(robot, test::clips(robot), std::make_unique<policy::ReferencePolicy>(), clock, options);
  test::IdealBus bus(robot);
  const Controller controller(robot, bus, tick, {.realtime = false});
  EXPECT_EQ(controller.bus_cycle().guard().options().hold_cycles, 7);
  EXPECT_EQ(controller.bus_cycle().guard().options().max_kp_Nm_per_rad, 1500.0);
}

TEST(Controller, AFrozenControlThreadIsDampedByTheBus) {
  ThreadedRobot run(test::z1());
  run.controller.start([&] { run.speaker(); }, [] {});
  ASSERT_TRUE(run.reach(control::Mode::kStand));
  ASSERT_TRUE(eventually([&] { return run.bus.last_kp_sum > 0.0; }));
  run.policy->freeze = true;
  // Without any request: the bus alone finds that no command comes.
  EXPECT_TRUE(eventually([&] { return run.bus.last_kp_sum == 0.0 && run.bus.last_kd_sum > 0.0; }));
  run.policy->freeze = false;
  EXPECT_TRUE(run.sees(control::Mode::kFault)) << "it does not go on as if nothing had been";
  EXPECT_EQ(run.news.fault.code, faults::FaultCode::kControlFrozen);
  EXPECT_TRUE(run.controller.stop());
  EXPECT_EQ(run.bus.last_kp_sum, 0.0);
  EXPECT_GE(run.controller.bus_cycle().guard().trips(), 1u);
}

/// What a simulation that waits does while its control thread is late three times by 120 ms.
struct LateControl {
  std::int64_t lost_ns = 0;
  std::uint64_t trips = 0;             ///< of the bus guard
  std::vector<std::uint64_t> samples;  ///< bus sample of each tick
};

LateControl late_control() {
  LateControl found;
  ThreadedRobot run(test::z1(), {.waits = true});
  run.controller.start([&] { run.speaker(); },
                       [&] {
                         control::TickRecord tick;
                         while (run.controller.outbox().records.pop(tick))
                           found.samples.push_back(tick.state.bus_sample);
                       });
  EXPECT_TRUE(run.reach(control::Mode::kStand));
  for (int k = 0; k < 3; ++k) {
    run.policy->freeze = true;
    std::this_thread::sleep_for(std::chrono::milliseconds(120));
    run.policy->freeze = false;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  found.lost_ns = run.controller.turns()->lost_ns();
  EXPECT_TRUE(run.controller.stop());
  found.trips = run.controller.bus_cycle().guard().trips();
  return found;
}

TEST(Controller, ASimulationThatWaitsRunsFiveBusCyclesATickHoweverLateItsControlThreadIs) {
  LateControl found = late_control();
  // A computer that gives one of the threads no time for half a second disturbs an attempt; without the waiting the
  // guard trips in every one.
  for (int attempt = 1; attempt < 5 && found.trips > 0; ++attempt) found = late_control();
  EXPECT_EQ(found.trips, 0u);
  EXPECT_GT(found.lost_ns, 200'000'000) << "of 360 ms";
  ASSERT_GT(found.samples.size(), 10u);
  for (std::size_t i = 2; i < found.samples.size(); ++i) ASSERT_EQ(found.samples[i], found.samples[i - 1] + 5) << i;
}

TEST(Controller, ASimulationThatWaitsDampsAControlThreadThatIsFrozenForGood) {
  ThreadedRobot run(test::z1(), {.waits = true});
  run.controller.start([&] { run.speaker(); }, [] {});
  ASSERT_TRUE(run.reach(control::Mode::kStand));
  ASSERT_TRUE(eventually([&] { return run.bus.last_kp_sum > 0.0; }));
  run.policy->freeze = true;
  EXPECT_TRUE(eventually([&] { return run.bus.last_kp_sum == 0.0 && run.bus.last_kd_sum > 0.0; }));
  run.policy->freeze = false;
  EXPECT_TRUE(run.sees(control::Mode::kFault));
  EXPECT_EQ(run.news.fault.code, faults::FaultCode::kControlFrozen);
  EXPECT_TRUE(run.controller.stop());
}

}  // namespace
}  // namespace pmg::runtime
