// Side effects of an ONNX policy on a real-time thread: a constant number of heap allocations per call, and no thread.
#include <gtest/gtest.h>

#include <filesystem>
#include <iterator>

#include "generator_core/allocation_count.hpp"
#include "model/robots.hpp"
#include "policy/linear_policy.hpp"
#include "policy/observation.hpp"
#include "policy/onnx_policy.hpp"

namespace pmg::policy {
namespace {

using test::z1;

/// A standing robot whose inputs sway with the tick.
struct Swaying {
  Swaying() {
    state.q = reference.q = z1().q_stand();
    state.dq = reference.dq = JointVector::Zero(state.q.size());
  }
  void advance(int tick) {
    state.q = z1().q_stand().array() + 0.05 * std::sin(0.1 * tick);
    reference.phase = 0.01 * (tick % 100);
  }
  model::RobotState state;
  Reference reference;
};

long threads() {
  return std::distance(std::filesystem::directory_iterator("/proc/self/task"), std::filesystem::directory_iterator());
}

TEST(PolicyCost, EveryActAllocatesAsOftenAsTheFirst) {
  if (test::allocation_count() < 0) GTEST_SKIP() << "allocations can't be counted in this build";
  OnnxPolicy policy(test::kLinearPolicy, z1(), test::kNoClips);
  Swaying robot;
  JointVector q_des = robot.reference.q;
  long first = -1;
  for (int tick = 0; tick < 2000; ++tick) {
    robot.advance(tick);
    if (tick == 1000) policy.reset();
    const long before = test::allocation_count();
    ASSERT_EQ(policy.act(robot.state, robot.reference, Command{}, q_des), Status::kOk);
    const long spent = test::allocation_count() - before;
    if (first < 0) first = spent;
    ASSERT_EQ(spent, first) << "tick " << tick;
  }
  RecordProperty("allocations_per_act", static_cast<int>(first));
}

TEST(PolicyCost, AssemblingTheObservationAllocatesNothing) {
  if (test::allocation_count() < 0) GTEST_SKIP() << "allocations can't be counted in this build";
  Observation observation(z1());
  Swaying robot;
  const Eigen::VectorXf action = Eigen::VectorXf::Ones(12);
  const long before = test::allocation_count();
  for (int tick = 0; tick < 100; ++tick) {
    robot.advance(tick);
    observation.assemble(robot.state, robot.reference, Command{}, action);
  }
  EXPECT_EQ(test::allocation_count(), before);
}

TEST(PolicyCost, NeitherLoadingNorActingStartsAThread) {
  const long before = threads();
  OnnxPolicy policy(test::kLinearPolicy, z1(), test::kNoClips);
  EXPECT_EQ(threads(), before) << "a pool would keep a core spinning beside the real-time threads";
  Swaying robot;
  JointVector q_des = robot.reference.q;
  for (int tick = 0; tick < 100; ++tick) policy.act(robot.state, robot.reference, Command{}, q_des);
  EXPECT_EQ(threads(), before);
}

}  // namespace
}  // namespace pmg::policy
