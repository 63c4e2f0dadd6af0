#include "hal/command_guard.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "../sim/robots.hpp"

namespace pmg::hal {
namespace {

constexpr GuardOptions kOptions;

class Guard : public testing::Test {
 protected:
  ControlOutput standing() const {
    ControlOutput output;
    output.joints = standing_command(z1());
    output.trips_seen = guard_.trips();
    return output;
  }
  static bool damps(const model::JointCommand& command) {
    return command.kp.cwiseAbs().maxCoeff() == 0.0 && command.kd.minCoeff() > 0.0;
  }
  const model::JointCommand& next(const ControlOutput& output, std::uint32_t pulls = 0) {
    return guard_.next(&output, pulls);
  }
  const model::JointCommand& silence(int cycles, std::uint32_t pulls = 0) {
    for (int k = 1; k < cycles; ++k) guard_.next(nullptr, pulls);
    return guard_.next(nullptr, pulls);
  }

  CommandGuard guard_{z1(), kOptions};
};

TEST_F(Guard, BeforeTheFirstCommandThereIsNoTorqueHoweverLongItTakes) {
  for (int k = 0; k < 1000; ++k) {
    const model::JointCommand& command = silence(1, k > 500 ? 1 : 0);
    EXPECT_EQ(command.kp.sum() + command.kd.sum() + command.tau_ff.cwiseAbs().sum(), 0.0);
  }
  EXPECT_EQ(guard_.trips(), 0u);
}

TEST_F(Guard, HoldsACommandForItsCyclesAndThenDampsUntilTheAuthorKnows) {
  const ControlOutput output = standing();
  next(output);
  EXPECT_EQ(silence(kOptions.hold_cycles).kp, output.joints.kp);
  EXPECT_TRUE(damps(silence(1)));
  EXPECT_EQ(guard_.trips(), 1u);
  EXPECT_EQ(guard_.cause(), TripCause::kControlFrozen);
  EXPECT_TRUE(damps(silence(10'000)));
  EXPECT_EQ(guard_.trips(), 1u) << "one silence, one trip";
  EXPECT_TRUE(damps(next(output))) << "computed before its author knew";
  EXPECT_FALSE(damps(next(standing())));
}

TEST_F(Guard, WhatIsNotFiniteOrOfAnotherLengthNeverPasses) {
  constexpr double kBad[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()};
  for (JointVector model::JointCommand::*values :
       {&model::JointCommand::q, &model::JointCommand::dq, &model::JointCommand::kp, &model::JointCommand::kd,
        &model::JointCommand::tau_ff}) {
    for (const double bad : kBad) {
      ASSERT_FALSE(damps(next(standing())));
      ControlOutput output = standing();
      (output.joints.*values)[3] = bad;
      EXPECT_TRUE(damps(next(output)));
      EXPECT_EQ(guard_.cause(), TripCause::kCommandNotFinite);
    }
    ASSERT_FALSE(damps(next(standing())));
    ControlOutput output = standing();
    (output.joints.*values).conservativeResize(7);
    EXPECT_TRUE(damps(next(output)));
  }
}

TEST_F(Guard, AStopBrakesAtOnceAndUntilItsAuthorHasSeenEveryPull) {
  ControlOutput output = standing();
  next(output);
  EXPECT_TRUE(damps(silence(1, 1)));
  EXPECT_TRUE(damps(next(output, 1)));
  output.stops_seen = 1;
  EXPECT_TRUE(damps(next(output, 2))) << "pulled again meanwhile";
  output.stops_seen = 2;
  EXPECT_FALSE(damps(next(output, 2)));
  EXPECT_EQ(guard_.trips(), 0u) << "a stop is no fault";
}

TEST_F(Guard, ClampsWhatIsFiniteToTheRobotsLimits) {
  ControlOutput output = standing();
  const Eigen::Index n = output.joints.q.size();
  for (const double sign : {1.0, -1.0}) {
    for (JointVector* values :
         {&output.joints.q, &output.joints.dq, &output.joints.kp, &output.joints.kd, &output.joints.tau_ff}) {
      values->setConstant(n, sign * 1e9);
    }
    const model::JointCommand& command = next(output);
    for (Eigen::Index i = 0; i < n; ++i) {
      const model::Joint& joint = z1().joints[static_cast<std::size_t>(i)];
      EXPECT_EQ(command.q[i], sign > 0.0 ? joint.upper_rad : joint.lower_rad);
      EXPECT_EQ(command.dq[i], sign * joint.velocity_limit_rad_s);
      EXPECT_EQ(command.kp[i], sign > 0.0 ? 2000.0 : 0.0);  // docs/reference/safety.md
      EXPECT_EQ(command.kd[i], sign > 0.0 ? 100.0 : 0.0);
      EXPECT_EQ(command.tau_ff[i], sign * joint.effort_limit_Nm);
    }
  }
  EXPECT_EQ(guard_.trips(), 0u);
}

}  // namespace
}  // namespace pmg::hal
