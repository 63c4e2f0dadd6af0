#include "sil/sil_hal.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "../sim/robots.hpp"

namespace pmg {
namespace {

TEST(SilHal, OneExchangeIsOneBusCycle) {
  sim::World world(z1(), {});
  sil::SilHal hal(world);
  model::RobotState state;
  for (std::uint64_t k = 1; k <= 10; ++k) {
    EXPECT_EQ(hal.exchange(standing_command(z1()), state), hal::BusStatus::kOk);
    EXPECT_EQ(state.bus_sample, k);
    EXPECT_EQ(state.stamp_ns, static_cast<std::int64_t>(k) * 2'000'000);
  }
}

TEST(SilHal, CommandFromSampleKActsInTheStepToSampleKPlusOne) {
  sim::World world(z1(), {});
  sil::SilHal hal(world);
  model::JointCommand command = standing_command(z1());
  model::RobotState sample_k, next;
  for (int i = 0; i < 100; ++i) hal.exchange(command, sample_k);
  const int elbow = z1().joint_index.at("left_elbow");
  command.q[elbow] -= 0.1;
  hal.exchange(command, next);
  const double torque_Nm =
      command.kp[elbow] * (command.q[elbow] - sample_k.q[elbow]) - command.kd[elbow] * sample_k.dq[elbow];
  EXPECT_NEAR(next.tau[elbow], torque_Nm, 1e-9);
  EXPECT_LT(next.dq[elbow], sample_k.dq[elbow] - 0.01) << "and it moves at once";
}

TEST(SilHal, FillsEveryField) {
  sim::World world(z1(), {});
  sil::SilHal hal(world);
  model::RobotState state;
  hal.exchange(standing_command(z1()), state);
  const int n = z1().joint_index.size();
  ASSERT_EQ(state.q.size(), n);
  ASSERT_EQ(state.dq.size(), n);
  ASSERT_EQ(state.tau.size(), n);
  ASSERT_EQ(state.temperature_degC.size(), n);
  EXPECT_TRUE((state.temperature_degC.array() == 35.0).all());
  EXPECT_NEAR(state.orientation_WI.norm(), 1.0, 1e-9);
  EXPECT_GT(state.acceleration_m_s2.norm(), 1.0);
}

TEST(SilHal, DivergenceIsALostBusAndKeepsTheLastGoodState) {
  sim::World world(z1(), {});
  sil::SilHal hal(world);
  model::JointCommand command = standing_command(z1());
  model::RobotState state;
  hal.exchange(command, state);
  command.q[0] = std::numeric_limits<double>::quiet_NaN();
  hal::BusStatus status = hal::BusStatus::kOk;
  for (int i = 0; i < 3; ++i) status = hal.exchange(command, state);
  EXPECT_EQ(status, hal::BusStatus::kLost);
  EXPECT_TRUE(state.q.allFinite());
  EXPECT_GE(state.bus_sample, 1U);
}

}  // namespace
}  // namespace pmg
