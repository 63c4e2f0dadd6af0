// The observation of another project's policy, element by element.
#include "policy/signal_history.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "model/robots.hpp"

namespace pmg::policy {
namespace {

using test::z1;

/// Knees alone, right before left; two frames of three terms.
PolicyDescriptor knees(HistoryOrder order) {
  PolicyDescriptor told;
  told.rate_Hz = 50.0;
  told.joints = {z1().joint_index.at("right_knee"), z1().joint_index.at("left_knee")};
  told.default_rad = {0.25, 0.5};
  told.order = order;
  told.observation = {{.signal = Signal::kCommandAngular, .size = 1, .scale = {10.0}, .history = 2},
                      {.signal = Signal::kJointPosition, .size = 2, .scale = {1.0, 2.0}, .clip = 5.0, .history = 2},
                      {.signal = Signal::kLastAction, .size = 2, .scale = {1.0, 1.0}, .history = 2}};
  told.observation_size = 10;
  return told;
}

/// In the k-th frame the right knee is at k + 0.25 rad, the left one at -k + 0.5, the command k, the actions 100 k.
std::vector<float> seen_after(int frames, SignalHistory& history) {
  Eigen::VectorXf seen;
  for (int k = 1; k <= frames; ++k) {
    model::RobotState state;
    state.q = state.dq = JointVector::Zero(z1().joint_index.size());
    state.q[z1().joint_index.at("right_knee")] = k + 0.25;
    state.q[z1().joint_index.at("left_knee")] = -k + 0.5;
    Command command;
    command[kOmega] = k;
    seen = history.assemble(state, command, Eigen::VectorXf::Constant(2, 100.0F * static_cast<float>(k)));
  }
  return {seen.data(), seen.data() + seen.size()};
}

using Floats = std::vector<float>;

TEST(SignalHistory, PutsFramesWhereTheDescriptorSays) {
  SignalHistory by_term(knees({.by_term = true, .oldest_first = true}), z1());
  EXPECT_EQ(seen_after(3, by_term), (Floats{20, 30, 2, -4, 3, -6, 200, 200, 300, 300}));
  SignalHistory newest(knees({.by_term = true, .oldest_first = false}), z1());
  EXPECT_EQ(seen_after(3, newest), (Floats{30, 20, 3, -6, 2, -4, 300, 300, 200, 200}));
  SignalHistory by_frame(knees({.by_term = false, .oldest_first = true}), z1());
  EXPECT_EQ(seen_after(3, by_frame), (Floats{20, 2, -4, 200, 200, 30, 3, -6, 300, 300}));
  SignalHistory last(knees({.by_term = false, .oldest_first = false}), z1());
  EXPECT_EQ(seen_after(3, last), (Floats{30, 3, -6, 300, 300, 20, 2, -4, 200, 200}));
}

TEST(SignalHistory, TheFirstFrameStandsForOlderOnesAlsoAfterAReset) {
  SignalHistory history(knees({}), z1());
  const Floats first = {10, 10, 1, -2, 1, -2, 100, 100, 100, 100};
  EXPECT_EQ(seen_after(1, history), first);
  seen_after(3, history);
  history.reset();
  EXPECT_EQ(seen_after(1, history), first);
}

TEST(SignalHistory, ClipsBeforeItScales) {
  SignalHistory history(knees({}), z1());
  const Floats seen = seen_after(8, history);
  EXPECT_EQ(seen[4], 5.0F);
  EXPECT_EQ(seen[5], -10.0F);
}

TEST(SignalHistory, RatesAndGravityAreTheBases) {
  PolicyDescriptor told = knees({});
  told.observation = {{.signal = Signal::kGyro, .size = 3, .scale = {1.0, 1.0, 1.0}},
                      {.signal = Signal::kGravityDirection, .size = 3, .scale = {1.0, 1.0, 1.0}}};
  told.observation_size = 6;
  model::RobotModel robot = z1();  // its IMU is turned by 90 degrees about z: its x is the base's y
  robot.imu.T_LI.linear() =
      Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitZ()).toRotationMatrix() * robot.imu.T_LI.linear();
  SignalHistory history(told, robot);
  model::RobotState state;
  state.q = state.dq = JointVector::Zero(robot.joint_index.size());
  state.gyro_rad_s = {1.0, 2.0, 3.0};
  state.orientation_WI = Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitX());  // the IMU's y is up
  const Eigen::VectorXf seen = history.assemble(state, {}, Eigen::VectorXf::Zero(2));
  const std::vector<float> expected = {-2.0F, 1.0F, 3.0F, 1.0F, 0.0F, 0.0F};
  for (Eigen::Index i = 0; i < seen.size(); ++i) EXPECT_NEAR(seen[i], expected[static_cast<std::size_t>(i)], 1e-6) << i;
}

TEST(SignalHistory, AClockThatRestsBeginsAgainWithTheNextCommand) {
  PolicyDescriptor told = knees({});
  const StepClock clock{.period_s = 0.08, .offsets_cycle = {0.0, 0.5}, .at_rest_cycle = 0.5};
  told.observation = {{.signal = Signal::kClockSin, .size = 2, .scale = {1.0, 1.0}, .clock = clock},
                      {.signal = Signal::kClockCos, .size = 2, .scale = {1.0, 1.0}, .clock = clock}};
  told.observation_size = 4;
  SignalHistory history(told, z1());
  model::RobotState state;
  state.q = state.dq = JointVector::Zero(z1().joint_index.size());
  Command walking;
  walking[kVx] = 0.3;
  const auto expect = [&](const Command& command, Floats expected) {
    const Eigen::VectorXf seen = history.assemble(state, command, Eigen::VectorXf::Zero(2));
    for (Eigen::Index i = 0; i < 4; ++i) EXPECT_NEAR(seen[i], expected[static_cast<std::size_t>(i)], 1e-6) << i;
  };
  for (int twice = 0; twice < 2; ++twice) {
    expect({}, {0, 0, -1, -1});
    expect({}, {0, 0, -1, -1});
    expect(walking, {0, 0, 1, -1});
    expect(walking, {1, -1, 0, 0});
    expect(walking, {0, 0, -1, 1});
  }
}

}  // namespace
}  // namespace pmg::policy
