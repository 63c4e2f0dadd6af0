#include "control/limiter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "control/fixtures.hpp"

namespace pmg::control {
namespace {

using test::kTick_s;
constexpr double kExact = 1e-9;  // rounding of targets of a few rad, times gains of some hundred

double uniform(std::mt19937_64& random, double lower, double upper) {
  return lower + (upper - lower) * static_cast<double>(random() >> 11) * 0x1p-53;
}

/// With robot.yaml's gains.
Limiter limiter_of(const model::RobotModel& robot, const LimiterOptions& options) {
  JointVector kp(robot.joint_index.size()), kd = kp;
  for (Eigen::Index i = 0; i < kp.size(); ++i) {
    kp[i] = robot.joints[static_cast<std::size_t>(i)].kp_Nm_per_rad;
    kd[i] = robot.joints[static_cast<std::size_t>(i)].kd_Nm_s_per_rad;
  }
  return {robot, kp, kd, kTick_s, options};
}

JointVector at_rest() { return JointVector::Zero(test::z1().joint_index.size()); }

TEST(Limiter, LeavesAPlainTargetAlone) {
  const model::RobotModel& robot = test::z1();
  Limiter limiter = limiter_of(robot, {});
  model::RobotState state = test::standing_state(robot);
  JointVector q_des = state.q.array() + 0.01;
  const JointVector wanted = q_des;
  const LimitReport report = limiter.apply(state, at_rest(), q_des);
  EXPECT_EQ(q_des, wanted);
  EXPECT_EQ(report.position + report.rate + report.torque, 0);
}

TEST(Limiter, CountsTheTorqueOfACommandedSpeed) {
  const model::RobotModel& robot = test::z1();
  Limiter limiter = limiter_of(robot, {});
  model::RobotState state = test::standing_state(robot);
  limiter.start_from(state.q);
  const model::Joint& joint = robot.joints[3];
  JointVector q_des = state.q, dq_des = at_rest();
  state.dq[3] = dq_des[3] = 10.0 * joint.effort_limit_Nm / joint.kd_Nm_s_per_rad;  // it moves as it shall: no torque
  EXPECT_EQ(limiter.apply(state, dq_des, q_des).torque, 0);
  state.dq[3] = 0.0;  // it doesn't: ten times its torque
  LimitReport report = limiter.apply(state, dq_des, q_des);
  EXPECT_NE(report.by[3] & LimitReport::kTorque, 0);
  EXPECT_EQ(report.torque, 1);
}

TEST(Limiter, NamesTheJointsThatItLimitedAndWhy) {
  const model::RobotModel& robot = test::z1();
  Limiter limiter = limiter_of(robot, {});
  model::RobotState state = test::standing_state(robot);
  limiter.start_from(state.q);
  JointVector q_des = state.q;
  q_des[3] += 1.0;    // in one tick: too fast
  state.dq[7] = 1e3;  // needs more braking than any drive has
  const LimitReport report = limiter.apply(state, at_rest(), q_des);
  EXPECT_NE(report.by[3] & LimitReport::kSpeed, 0);
  EXPECT_NE(report.by[7] & LimitReport::kTorque, 0);
  int position = 0, rate = 0, torque = 0;
  for (const std::uint8_t by : report.by) {
    position += (by & LimitReport::kRange) != 0;
    rate += (by & LimitReport::kSpeed) != 0;
    torque += (by & LimitReport::kTorque) != 0;
  }
  EXPECT_EQ(position, report.position);
  EXPECT_EQ(rate, report.rate);
  EXPECT_EQ(torque, report.torque);
  EXPECT_EQ(report.by[0], 0);
}

TEST(Limiter, EveryPromiseHoldsForArbitraryTargets) {
  const model::RobotModel& robot = test::z1();
  const LimiterOptions options;
  Limiter limiter = limiter_of(robot, options);
  std::mt19937_64 random(20);
  model::RobotState state = test::standing_state(robot);
  limiter.start_from(state.q);
  for (int k = 0; k < 2000; ++k) {
    JointVector q_des = state.q;
    for (Eigen::Index i = 0; i < q_des.size(); ++i) {
      const model::Joint& joint = robot.joints[static_cast<std::size_t>(i)];
      state.q[i] = uniform(random, joint.lower_rad, joint.upper_rad);
      state.dq[i] = uniform(random, -5.0, 5.0);
      q_des[i] = uniform(random, -6.0, 6.0);
    }
    limiter.apply(state, at_rest(), q_des);
    for (Eigen::Index i = 0; i < q_des.size(); ++i) {
      const model::Joint& joint = robot.joints[static_cast<std::size_t>(i)];
      ASSERT_GE(q_des[i], joint.lower_rad);
      ASSERT_LE(q_des[i], joint.upper_rad);
      const double torque_Nm = joint.kp_Nm_per_rad * (q_des[i] - state.q[i]) - joint.kd_Nm_s_per_rad * state.dq[i];
      const bool at_range = q_des[i] == joint.lower_rad || q_des[i] == joint.upper_rad;
      ASSERT_TRUE(at_range || std::abs(torque_Nm) <= joint.effort_limit_Nm + kExact) << joint.name;
    }
  }
}

TEST(Limiter, TargetsMoveNoFasterThanAllowed) {
  const model::RobotModel& robot = test::z1();
  const LimiterOptions options;
  Limiter limiter = limiter_of(robot, options);
  model::RobotState state = test::standing_state(robot);
  limiter.start_from(state.q);
  const int joint = robot.joint_index.at("left_elbow");
  const double step_rad =
      robot.joints[static_cast<std::size_t>(joint)].velocity_limit_rad_s * 3.0 * kTick_s;  // docs/reference/safety.md
  JointVector q_des = state.q;
  q_des[joint] -= 10.0 * step_rad;
  const JointVector wanted = q_des;
  const LimitReport report = limiter.apply(state, at_rest(), q_des);
  EXPECT_EQ(report.rate, 1);
  EXPECT_GE(q_des[joint], state.q[joint] - step_rad - kExact);
  EXPECT_LT(q_des[joint], state.q[joint]);
  q_des = wanted;
  const double before_rad = state.q[joint] - step_rad;
  limiter.apply(state, at_rest(), q_des);
  EXPECT_GE(q_des[joint], before_rad - step_rad - kExact);
}

TEST(Limiter, SaysWhatItLimited) {
  const model::RobotModel& robot = test::z1();
  const int knee = robot.joint_index.at("left_knee"), elbow = robot.joint_index.at("right_elbow");
  const auto& knee_joint = robot.joints[static_cast<std::size_t>(knee)];
  model::RobotState state = test::standing_state(robot);

  Limiter fresh = limiter_of(robot, {.target_rate_factor = 1e6});
  JointVector q_des = state.q;
  q_des[knee] += 1.01 * knee_joint.effort_limit_Nm / knee_joint.kp_Nm_per_rad;
  LimitReport report = fresh.apply(state, at_rest(), q_des);
  EXPECT_EQ(report.torque, 1);
  EXPECT_EQ(report.position, 0);
  EXPECT_EQ(report.rate, 0);

  state.q[elbow] = robot.joints[static_cast<std::size_t>(elbow)].upper_rad;
  q_des = state.q;
  q_des[elbow] += 0.02;
  report = fresh.apply(state, at_rest(), q_des);
  EXPECT_EQ(report.position, 1);
  EXPECT_EQ(report.torque, 0);
}

TEST(Limiter, BrakingCountsAsTorque) {
  const model::RobotModel& robot = test::z1();
  const int knee = robot.joint_index.at("left_knee");
  const auto& joint = robot.joints[static_cast<std::size_t>(knee)];
  Limiter limiter = limiter_of(robot, {.target_rate_factor = 1e6});
  model::RobotState state = test::standing_state(robot);
  state.dq[knee] = 2.0;  // 2 rad/s times kd is torque, for which the position error must leave room
  JointVector q_des = state.q;
  q_des[knee] -= 0.999 * joint.effort_limit_Nm / joint.kp_Nm_per_rad;
  limiter.apply(state, at_rest(), q_des);
  const double torque_Nm = joint.kp_Nm_per_rad * (q_des[knee] - state.q[knee]) - joint.kd_Nm_s_per_rad * state.dq[knee];
  EXPECT_GE(torque_Nm, -joint.effort_limit_Nm - kExact);
}

}  // namespace
}  // namespace pmg::control
