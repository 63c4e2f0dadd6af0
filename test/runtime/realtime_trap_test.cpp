// The real-time threads use neither heap nor locks, in every mode and every failure.
#include "runtime/realtime_trap.hpp"

#include <gtest/gtest.h>

#include "policy/linear_policy.hpp"
#include "policy/onnx_policy.hpp"
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
  /// True after this many more ticks.
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
  std::atomic<bool> led{false};
  run.controller.start([&] { run.speaker(); },
                       [&] {
                         control::TickRecord tick;
                         while (run.controller.outbox().records.pop(tick)) {
                           if (control::led(tick.result.arms)) led = true;
                         }
                       });
  ASSERT_TRUE(run.sees(control::Mode::kPassive));
  arm(run);
  ASSERT_TRUE(run.reach(control::Mode::kStand));
  ASSERT_TRUE(run.reach(control::Mode::kWalk));
  ASSERT_TRUE(ticks(run, 60));  // more than half a gait cycle
  EXPECT_TRUE(eventually([&] { return led.load(); })) << "the arms move meanwhile";
  run.bus.lost = true;
  ASSERT_TRUE(run.sees(control::Mode::kFault));
  run.bus.lost = false;
  ASSERT_TRUE(run.reach(control::Mode::kDamping, true));
  ASSERT_TRUE(run.reach(control::Mode::kPassive));
  ASSERT_TRUE(run.reach(control::Mode::kStand));
  ASSERT_TRUE(eventually([&] { return run.bus.last_kp_sum > 0.0; }));
  run.policy->freeze = true;
  ASSERT_TRUE(eventually([&] { return run.bus.last_kp_sum == 0.0; })) << "the bus damps a frozen control thread";
  run.policy->freeze = false;
  ASSERT_TRUE(run.sees(control::Mode::kFault));
  test::disarm_trap();
  EXPECT_EQ(test::trapped().heap, 0) << test::first_trapped();
  EXPECT_EQ(test::trapped().locks, 0) << test::first_trapped();
  EXPECT_TRUE(run.controller.stop());
}

/// An ONNX policy; the calls inside each act() are counted separately.
class CountedOnnxPolicy final : public policy::Policy {
 public:
  explicit CountedOnnxPolicy(const model::RobotModel& robot) {
    const std::filesystem::path clips = robot.directory / "clips";
    const test::LinearPolicyFile file(clips, Variant::kPmg);
    onnx_ = std::make_unique<policy::OnnxPolicy>(file.file(), robot, model::clip_library_sha256(clips));
  }
  std::optional<policy::DriveGains> gains() const override { return onnx_->gains(); }
  std::optional<double> action_bound_rad() const override { return onnx_->action_bound_rad(); }
  void reset() noexcept override { onnx_->reset(); }
  void unsent() noexcept override { onnx_->unsent(); }
  bool needs_ground() const override { return false; }  // the robot walks on the gantry
  policy::Status act(const model::RobotState& state, const Reference& reference, const Command& observed,
                     JointVector& q_des) noexcept override {
    const test::CountedApart counted;
    const policy::Status status = onnx_->act(state, reference, observed, q_des);
    const test::Trapped now = counted.so_far();
    if (counting) {
      least_heap = std::min<long>(least_heap, now.heap);
      most_heap = std::max<long>(most_heap, now.heap);
      locks += now.locks;
      ++acts;
    }
    return status;
  }
  std::atomic<bool> counting{false};
  std::atomic<long> least_heap{1L << 30}, most_heap{0}, locks{0}, acts{0};

 private:
  std::unique_ptr<policy::OnnxPolicy> onnx_;
};

TEST_F(RealtimeTrap, AnOnnxPolicyTakesNoLockAndAsManyAllocationsInEveryTickAndNothingElseTakesAny) {
  auto own = std::make_unique<CountedOnnxPolicy>(test::z1());
  CountedOnnxPolicy& onnx = *own;
  ThreadedRobot run(test::z1(), {}, std::move(own));
  run.controller.start([&] { run.speaker(); },
                       [&] {
                         control::TickRecord tick;
                         while (run.controller.outbox().records.pop(tick)) {
                         }
                       });
  ASSERT_TRUE(run.sees(control::Mode::kPassive));
  arm(run);
  onnx.counting = true;
  ASSERT_TRUE(run.reach(control::Mode::kStand));
  ASSERT_TRUE(run.reach(control::Mode::kWalk));
  ASSERT_TRUE(ticks(run, 200));
  ASSERT_TRUE(run.reach(control::Mode::kDamping));
  ASSERT_TRUE(run.reach(control::Mode::kStand));
  ASSERT_TRUE(ticks(run, 20));
  onnx.counting = false;
  test::disarm_trap();
  EXPECT_EQ(test::trapped().heap, 0) << test::first_trapped();
  EXPECT_EQ(test::trapped().locks, 0) << test::first_trapped();
  EXPECT_GT(onnx.acts, 200);
  EXPECT_EQ(onnx.locks, 0);
  EXPECT_GT(onnx.least_heap, 0) << "ONNX Runtime can't do without: the count must see it";
  EXPECT_EQ(onnx.least_heap, onnx.most_heap) << "as many in every tick";
  RecordProperty("heap_calls_per_tick", static_cast<int>(onnx.most_heap));
  EXPECT_TRUE(run.controller.stop());
}

TEST_F(RealtimeTrap, CatchesWhatItIsFor) {
  ThreadedRobot run(test::z1());
  run.controller.start([&] { run.speaker(); }, [] {});
  ASSERT_TRUE(run.reach(control::Mode::kStand));
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
