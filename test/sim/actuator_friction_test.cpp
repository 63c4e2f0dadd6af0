// Friction: each effect acts as its name says, and does nothing when it is neutral.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "one_joint.hpp"

namespace pmg::test {
namespace {

TEST(ActuatorFriction, HoldsAtRestAgainstLessThanItsDryFriction) {
  const auto parameters = with([](auto& p) { p.friction.coulomb_Nm = 1.0; });
  OneJoint held(parameters);
  held.run(1.0, kLimp, 0.95);
  const double settled_rad = held.q_rad;
  EXPECT_LT(std::abs(settled_rad), 0.01) << "a sudden load swings a little before it is held";
  held.run(10.0, kLimp, 0.95);
  EXPECT_NEAR(held.q_rad, settled_rad, 1e-9) << "doesn't creep";
  OneJoint pushed(parameters);
  pushed.run(1.0, kLimp, 1.5);
  EXPECT_NEAR(pushed.dq_rad_s, 0.5 / 0.05, 0.1) << "what is beyond friction accelerates";
}

TEST(ActuatorFriction, StopsASlidingJointAndKeepsItThere) {
  OneJoint joint(with([](auto& p) { p.friction.coulomb_Nm = 0.5; }));
  joint.dq_rad_s = 4.0;
  joint.run(0.39, kLimp);
  EXPECT_GT(joint.dq_rad_s, 0.05) << "0.5 Nm stop 0.05 kg m^2 at 4 rad/s in 0.4 s";
  joint.run(0.6, kLimp);
  EXPECT_NEAR(joint.q_rad, 0.8, 0.01) << "after 0.8 rad";
  EXPECT_LT(std::abs(joint.dq_rad_s), 1e-3);
}

TEST(ActuatorFriction, LosesMoreTorqueUnderMoreLoad) {
  // Driven at constant speed against an external torque: motor torque beyond it is friction.
  const auto friction_Nm = [](double load_Nm) {
    OneJoint joint(with([](auto& p) {
      p.friction.coulomb_Nm = 0.2;
      p.friction.load_driving = 0.3;
      p.transmission.armature_kg_m2 = 0.02;
    }));
    joint.run(3.0, {.dq_rad_s = 2.0, .kd = 50.0}, -load_Nm);
    const double motor_Nm = 50.0 * (2.0 - joint.dq_rad_s);
    return motor_Nm - load_Nm;
  };
  EXPECT_NEAR(friction_Nm(0.0), 0.2, 1e-3);
  EXPECT_NEAR(friction_Nm(2.0), 0.2 + 0.3 * 2.0, 1e-2);
}

TEST(ActuatorFriction, GrowsWithTheSquareOfSpeedAndDiffersByDirection) {
  const auto parameters = with([](auto& p) {
    p.friction.viscous_Nm_s_per_rad = 0.3;
    p.friction.viscous_quadratic_Nm_s2_per_rad2 = 0.2;
    p.friction.viscous_asymmetry = 0.25;
  });
  for (const double dq_rad_s : {2.0, -2.0, 0.5}) {
    const double speed = std::abs(dq_rad_s), direction = dq_rad_s > 0.0 ? 1.0 : -1.0;
    const double scale = 1.0 + 0.25 * direction;
    const sim::ActuatorTorque torque = sim::ActuatorModel(parameters, kActuatorStep_s).step(kLimp, 0.0, dq_rad_s);
    EXPECT_NEAR(torque.torque_Nm, -direction * (0.3 * speed + 0.2 * speed * speed) * scale, 1e-12);
    EXPECT_NEAR(torque.slope_Nm_s_per_rad, -(0.3 + 2.0 * 0.2 * speed) * scale, 1e-12) << "the integrator's derivative";
  }
}

TEST(ActuatorFriction, FallsWithSpeedByItsStribeckExponent) {
  for (const double exponent : {0.5, 1.0, 2.0}) {
    const auto parameters = with([&](auto& p) {
      p.friction.coulomb_Nm = 0.4;
      p.friction.stribeck_Nm = 1.0;
      p.friction.stribeck_rad_s = 2.0;
      p.friction.stribeck_exponent = exponent;
      p.friction.stribeck_asymmetry = 0.6;
    });
    for (const double dq_rad_s : {1.0, 8.0}) {  // so fast that the bristle slides in the first step
      const double curve = std::exp(-std::pow(dq_rad_s / 2.0, exponent));
      EXPECT_NEAR(first_torque_Nm(parameters, kLimp, dq_rad_s), -(0.4 + curve * 1.6), 1e-12);
      EXPECT_NEAR(first_torque_Nm(parameters, kLimp, -dq_rad_s), 0.4 + curve * 0.4, 1e-12);
    }
  }
}

TEST(ActuatorFriction, GrowsWithTheMotorsTorqueOrTheNetTorque) {
  const auto friction_Nm = [](double by_motor, double net, double motor_Nm, double external_Nm) {
    const auto parameters = with([&](auto& p) {
      p.friction.load_driving = 0.3, p.friction.load_backdriving = 0.1;
      p.friction.load_by_motor = by_motor, p.friction.load_net = net;
    });
    // In the first step nothing has been transmitted yet.
    const sim::ActuatorInput input{.feed_forward_Nm = motor_Nm, .external_Nm = external_Nm};
    return motor_Nm - first_torque_Nm(parameters, input, 2.0);
  };
  EXPECT_NEAR(friction_Nm(0.0, 0.0, 5.0, -3.0), 0.0, 1e-12);
  EXPECT_NEAR(friction_Nm(1.0, 0.0, 5.0, -3.0), 0.3 * 5.0, 1e-12);
  EXPECT_NEAR(friction_Nm(0.5, 0.0, 5.0, -3.0), 0.3 * 2.5, 1e-12);
  EXPECT_NEAR(friction_Nm(1.0, 0.0, -5.0, -3.0), 0.1 * 5.0, 1e-12) << "the load moves the motor";
  EXPECT_NEAR(friction_Nm(0.0, 1.0, 5.0, -3.0), 0.3 * 4.0, 1e-12) << "half of 5 Nm against 3 Nm";
  EXPECT_NEAR(friction_Nm(0.0, 1.0, 5.0, 5.0), 0.0, 1e-12) << "motor and load pull the same way: nothing is pressed";
  EXPECT_NEAR(friction_Nm(0.5, 0.5, 5.0, -3.0), 0.3 * 4.5, 1e-12);
}

}  // namespace
}  // namespace pmg::test
