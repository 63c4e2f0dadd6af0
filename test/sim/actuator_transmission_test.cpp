// Shafts: each effect acts as its name says, and does nothing when it is neutral.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "one_joint.hpp"

namespace pmg::test {
namespace {

TEST(ActuatorTransmission, LeavesAJointFreeWithinItsBacklash) {
  const auto parameters = with([](auto& p) {
    p.transmission = {
        .armature_kg_m2 = 0.02, .stiffness_Nm_per_rad = 500.0, .damping_Nm_s_per_rad = 0.5, .backlash_rad = 0.04};
  });
  OneJoint inside(parameters);
  inside.q_rad = 0.015;
  inside.step(kLimp);
  EXPECT_EQ(inside.torque.torque_Nm, 0.0);
  OneJoint beyond(parameters);
  beyond.q_rad = 0.03;
  beyond.step(kLimp);
  EXPECT_LT(beyond.torque.torque_Nm, -2.0) << "wound by 10 mrad of 500 Nm/rad, less what the rotor gives way";
  EXPECT_EQ(beyond.actuator.joint_armature_kg_m2(), 0.0) << "the rotor turns on its own";
}

TEST(ActuatorTransmission, StaysStableBehindAStiffShaft) {
  OneJoint joint(with([](auto& p) {
    p.transmission = {.armature_kg_m2 = 1e-3, .stiffness_Nm_per_rad = 5e4, .damping_Nm_s_per_rad = 1.0};
  }));
  joint.dq_rad_s = 1.0;
  joint.run(2.0, {.kp = 20.0, .kd = 1.0});
  EXPECT_LT(std::abs(joint.q_rad), 0.05);
  EXPECT_LT(std::abs(joint.dq_rad_s), 1.0);
}

/// Where a joint stands while its motor is held and a slow push passes 2 Nm on its way to 4 Nm, and 1 Nm on its way
/// back.
std::pair<double, double> pushed_rad(double friction_on_joint) {
  OneJoint joint(with([&](auto& p) {
    p.sensor.on_motor = 1.0;
    p.transmission.armature_kg_m2 = 0.05;
    p.transmission.stiffness_Nm_per_rad = 100.0;
    p.transmission.damping_Nm_s_per_rad = 2.0;
    p.transmission.friction_on_joint = friction_on_joint;
    p.friction.coulomb_Nm = 1.0;
  }));
  std::pair<double, double> at_rad;
  constexpr int kSteps = 8000;
  for (int k = 0; k < kSteps; ++k) {
    joint.step({.kp = 5000.0, .kd = 50.0}, 4.0 - std::abs(4.0 - 8.0 * k / kSteps));
    if (k == kSteps / 4) at_rad.first = joint.q_rad;
    if (k == kSteps * 7 / 8) at_rad.second = joint.q_rad;
  }
  return at_rad;
}

TEST(ActuatorTransmission, HasHysteresisOnTheSideOfTheSpringWhereItsFrictionIs) {
  // 1 Nm winds the shaft by 10 mrad; the held motor gives way by 0.8 mrad at most.
  const auto [motor_rad, motor_back_rad] = pushed_rad(0.0);
  EXPECT_NEAR(motor_rad, 0.02, 0.001);
  EXPECT_NEAR(motor_back_rad, 0.01, 0.001) << "friction beside a held motor holds no joint";
  const auto [joint_rad, joint_back_rad] = pushed_rad(1.0);
  EXPECT_NEAR(joint_rad, 0.02 - 0.01, 0.001) << "friction carries 1 Nm of the push";
  EXPECT_NEAR(joint_back_rad, 0.01 + 0.01, 0.001) << "and holds 1 Nm on the way back";
  const auto [half_rad, half_back_rad] = pushed_rad(0.5);
  EXPECT_NEAR(half_rad, 0.02 - 0.005, 0.001);
  EXPECT_NEAR(half_back_rad, 0.01 + 0.005, 0.001);
}

TEST(ActuatorTransmission, HardensWithTheCubeOfItsTwist) {
  const auto parameters = with([](auto& p) {
    p.sensor.on_motor = 1.0;
    p.transmission.armature_kg_m2 = 0.05;
    p.transmission.stiffness_Nm_per_rad = 50.0;
    p.transmission.hardening_Nm_per_rad3 = 2e5;
    p.transmission.damping_Nm_s_per_rad = 1.0;
  });
  // 50 * 0.02 + 2e5 * 0.02^3 = 2.6 Nm
  for (const double push_Nm : {2.6, -2.6}) {
    OneJoint joint(parameters);
    joint.run(3.0, {.kp = 2000.0, .kd = 20.0}, push_Nm);
    EXPECT_NEAR(joint.q_rad - joint.reading_rad(), std::copysign(0.02, push_Nm), 1e-6);
    EXPECT_NEAR(sim::ActuatorModel::joint_rad(parameters, 0.0, -push_Nm), std::copysign(0.02, push_Nm), 1e-12);
  }
}

/// A belt whose hysteresis has levelled off carries stiffness ((1 - share) x + share hysteresis) on the way out, and as
/// much less on the way back.
TEST(ActuatorTransmission, ABeltGivesWayOtherwiseOnTheWayBack) {
  const auto parameters = with([](auto& p) {
    p.sensor.on_motor = 1.0;
    p.transmission.armature_kg_m2 = 0.05;
    p.transmission.stiffness_Nm_per_rad = 50.0;
    p.transmission.hysteretic_share = 0.6;
    p.transmission.hysteresis_rad = 0.004;
    p.transmission.damping_Nm_s_per_rad = 1.0;
  });
  OneJoint joint(parameters);
  double out_rad = 0.0, back_rad = 0.0;
  constexpr int kSteps = 20000;
  for (int k = 0; k < kSteps; ++k) {
    joint.step({.kp = 5000.0, .kd = 50.0}, 2.0 - std::abs(2.0 - 4.0 * k / kSteps));
    if (k == kSteps / 4) out_rad = joint.q_rad - joint.reading_rad();
    if (k == kSteps * 3 / 4) back_rad = joint.q_rad - joint.reading_rad();
  }
  // 50 (0.4 x +- 0.6 * 0.004) Nm is 1 Nm
  EXPECT_NEAR(out_rad, (1.0 - 0.12) / 20.0, 5e-4);
  EXPECT_NEAR(back_rad, (1.0 + 0.12) / 20.0, 5e-4);
  EXPECT_NEAR(sim::ActuatorModel::joint_rad(parameters, 0.0, -1.0), (1.0 - 0.12) / 20.0, 1e-6);
}

}  // namespace
}  // namespace pmg::test
