// The real-time threads use neither heap nor locks, in whatever mode and whatever goes wrong.
#include "runtime/realtime_trap.hpp"

#include <gtest/gtest.h>

#include "runtime/threaded_controller.hpp"

namespace pmg::runtime {
namespace {

using test::eventually;
using test::ThreadedRobot;

class RealtimeTrap : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::trap_available()) GTEST_SKIP() << "sanitizers replace malloc themselves";
  }
  void TearDown() override { test::disarm_trap(); }
  static void arm(const ThreadedRobot& run) {
    test::arm_trap({run.controller.bus_thread(), run.controller.control_thread()});
  }
  /// So many more ticks.
  static bool ticks(ThreadedRobot& run, std::int64_t count) {
    std::int64_t seen = 0;
    return eventually([&] {
      ControllerNews news;
      if (run.controller.news(news)) ++seen;
      return seen >= count;
    });
  }
};

TEST_F(RealtimeTrap, NoHeapAndNoLockInBusAndControlThreadThroughWalkingFaultsAndModes) {
  ThreadedRobot run(test::z1());
  run.controller.start([&] { run.speaker(); },
                       [&] {
                         TickRecord tick;
                         while (run.controller.outbox().records.pop(tick)) {
                         }
                       });
  ASSERT_TRUE(run.sees(Mode::kPassive));
  arm(run);
  ASSERT_TRUE(run.reach(Mode::kStand));
  ASSERT_TRUE(run.reach(Mode::kWalk));
  ASSERT_TRUE(ticks(run, 60));  // half a gait cycle and more
  run.bus.lost = true;
  ASSERT_TRUE(run.sees(Mode::kFault));
  run.bus.lost = false;
  ASSERT_TRUE(run.reach(Mode::kDamping, true));
  ASSERT_TRUE(run.reach(Mode::kPassive));
  ASSERT_TRUE(run.reach(Mode::kStand));
  ASSERT_TRUE(eventually([&] { return run.bus.last_kp_sum > 0.0; }));
  run.policy->freeze = true;
  ASSERT_TRUE(eventually([&] { return run.bus.last_kp_sum == 0.0; })) << "the bus damps a frozen control thread";
  run.policy->freeze = false;
  ASSERT_TRUE(run.sees(Mode::kFault));
  test::disarm_trap();
  EXPECT_EQ(test::trapped().heap, 0) << test::first_trapped();
  EXPECT_EQ(test::trapped().locks, 0) << test::first_trapped();
  EXPECT_TRUE(run.controller.stop());
}

TEST_F(RealtimeTrap, CatchesWhatItIsFor) {
  ThreadedRobot run(test::z1());
  run.controller.start([&] { run.speaker(); }, [] {});
  ASSERT_TRUE(run.reach(Mode::kStand));
  arm(run);
  run.policy->use_heap = true;
  ASSERT_TRUE(eventually([] { return test::trapped().heap > 10; }));
  EXPECT_EQ(test::trapped().locks, 0);
  run.policy->use_lock = true;
  EXPECT_TRUE(eventually([] { return test::trapped().locks > 10; }));
  EXPECT_NE(test::first_trapped(), "nothing");
  test::disarm_trap();
  EXPECT_TRUE(run.controller.stop());
}

}  // namespace
}  // namespace pmg::runtime
