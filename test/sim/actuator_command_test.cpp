// A command's way to the drive: each effect acts as its name says, and does nothing when it is neutral.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "one_joint.hpp"

namespace pmg::test {
namespace {

TEST(ActuatorCommand, DelaysCommandsByFractionsOfAStep) {
  sim::ActuatorModel actuator(with([](auto& p) { p.command.delay_s = 0.007; }), kActuatorStep_s);
  std::vector<double> torque_Nm;
  for (int k = 0; k < 8; ++k) torque_Nm.push_back(actuator.step({.q_rad = 1.0, .kp = 1.0}, 0.0, 0.0).torque_Nm);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(torque_Nm[k], 0.0);
  EXPECT_NEAR(torque_Nm[3], 0.5, 1e-9) << "7 ms are three steps and a half";
  EXPECT_EQ(torque_Nm[4], 1.0);
}

TEST(ActuatorCommand, LimitsTheRateOfCommands) {
  sim::ActuatorModel actuator(with([](auto& p) { p.command.rate_limit_rad_s = 5.0; }), kActuatorStep_s);
  double torque_Nm = 0.0;
  for (int k = 0; k < 10; ++k) torque_Nm = actuator.step({.q_rad = 1.0, .kp = 1.0}, 0.0, 0.0).torque_Nm;
  EXPECT_NEAR(torque_Nm, 10 * 5.0 * kActuatorStep_s, 1e-12);
}

TEST(ActuatorCommand, IsSwitchedOffAtOnceHoweverLateItsCommandsAre) {
  sim::ActuatorModel actuator(with([](auto& p) { p.command.delay_s = 0.02; }), kActuatorStep_s);
  sim::ActuatorInput input{.q_rad = 1.0, .kp = 10.0};
  for (int k = 0; k < 20; ++k) actuator.step(input, 0.0, 0.0);
  EXPECT_EQ(actuator.step(input, 0.0, 0.0).torque_Nm, 10.0);
  input.enabled = false;
  EXPECT_EQ(actuator.step(input, 0.0, 0.0).torque_Nm, 0.0);
}

TEST(ActuatorCommand, IsTakenOnceInAnUpdatePeriod) {
  sim::ActuatorModel actuator(with([](auto& p) { p.command.update_s = 0.01; }), kActuatorStep_s);
  for (int k = 0; k < 13; ++k) {
    const int taken = k - k % 5;  // 10 ms are five steps
    EXPECT_EQ(actuator.step({.q_rad = 0.1 * k, .kp = 1.0}, 0.0, 0.0).torque_Nm, 0.1 * taken);
  }
}

TEST(ActuatorCommand, AcceleratesAndBrakesWithinItsProfile) {
  const double speed_rad_s = 2.0, acceleration_rad_s2 = 20.0;
  sim::ActuatorModel actuator(with([&](auto& p) {
                                p.command.rate_limit_rad_s = speed_rad_s;
                                p.command.acceleration_limit_rad_s2 = acceleration_rad_s2;
                              }),
                              kActuatorStep_s);
  double before_rad = 0.0, before_rad_s = 0.0, arrived_s = 0.0, fastest_rad_s = 0.0;
  for (int k = 0; k < 500; ++k) {
    const double at_rad = actuator.step({.q_rad = 1.0, .kp = 1.0}, 0.0, 0.0).torque_Nm;
    const double at_rad_s = (at_rad - before_rad) / kActuatorStep_s;
    EXPECT_LE(std::abs(at_rad_s), speed_rad_s * (1.0 + 1e-9));
    EXPECT_LE(std::abs(at_rad_s - before_rad_s), acceleration_rad_s2 * kActuatorStep_s * (1.0 + 1e-9));
    EXPECT_LE(at_rad, 1.0 + speed_rad_s * kActuatorStep_s) << "passes its target by a step at most";
    if (at_rad < 0.999) arrived_s = k * kActuatorStep_s;
    fastest_rad_s = std::max(fastest_rad_s, at_rad_s);
    before_rad = at_rad, before_rad_s = at_rad_s;
  }
  EXPECT_NEAR(fastest_rad_s, speed_rad_s, 1e-9);
  // 1 rad takes 0.5 s + 0.1 s, of which the last milliradian takes 0.01 s. Tolerance: it brakes in whole steps.
  EXPECT_NEAR(arrived_s, 1.0 / speed_rad_s + speed_rad_s / acceleration_rad_s2 - 0.01, 0.015);
  EXPECT_NEAR(before_rad, 1.0, 1e-3);
}

}  // namespace
}  // namespace pmg::test
