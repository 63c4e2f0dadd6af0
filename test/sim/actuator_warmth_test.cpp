// Temperature, heat and time: each effect acts as its name says, and does nothing when it is neutral.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "one_joint.hpp"

namespace pmg::test {
namespace {

TEST(ActuatorWarmth, RubsLessAndPullsLessWhenWarm) {
  const auto parameters = with([](auto& p) {
    p.friction.viscous_Nm_s_per_rad = 2.0;
    p.thermal = {.friction_per_K = -0.02, .torque_per_K = -0.004};
  });
  const auto torque_Nm = [&](double temperature_C, double wish_Nm, double dq_rad_s) {
    sim::ActuatorModel actuator(parameters, kActuatorStep_s);
    return actuator.step({.feed_forward_Nm = wish_Nm, .temperature_C = temperature_C}, 0.0, dq_rad_s).torque_Nm;
  };
  EXPECT_DOUBLE_EQ(torque_Nm(25.0, 0.0, 1.0), -2.0);
  EXPECT_NEAR(torque_Nm(45.0, 0.0, 1.0), -2.0 * std::exp(-0.4), 1e-12);
  EXPECT_NEAR(torque_Nm(45.0, 10.0, 0.0), 10.0 * (1.0 - 0.08), 1e-12);
}

TEST(ActuatorWarmth, WarmsByTheSquareOfItsTorqueAndCools) {
  sim::ActuatorModel actuator(with([](auto& p) {
                                p.friction.viscous_Nm_s_per_rad = 1.0;
                                p.thermal = {.friction_per_Nm2_s = -0.01, .cooling_s = 5.0};
                              }),
                              kActuatorStep_s);
  const auto friction_Nm = [&](double wish_Nm, double for_s) {
    sim::ActuatorTorque torque;
    for (int k = 0; k < std::lround(for_s / kActuatorStep_s); ++k)
      torque = actuator.step({.feed_forward_Nm = wish_Nm}, 0.0, 1.0);
    return wish_Nm - torque.torque_Nm;
  };
  // 3 Nm with 5 s of cooling settle at 3^2 * 5 = 45 Nm^2 s. Tolerance: one step, and e^-8 of the way is left.
  EXPECT_NEAR(friction_Nm(3.0, 40.0), std::exp(-0.45), 0.005);
  EXPECT_NEAR(friction_Nm(0.0, 5.0), std::exp(-0.45 / std::exp(1.0)), 0.005);
}

TEST(ActuatorWarmth, ThinsViscousFrictionAlone) {
  const auto parameters = with([](auto& p) {
    p.friction.viscous_Nm_s_per_rad = 2.0, p.friction.coulomb_Nm = 0.5;
    p.thermal.viscous_per_K = -0.03;
  });
  EXPECT_NEAR(first_torque_Nm(parameters, {.temperature_C = 45.0}, 1.0), -0.5 - 2.0 * std::exp(-0.6), 1e-12);
}

TEST(ActuatorWarmth, WeakensAVoltageServoAndItsBrakeByTheWindingsResistance) {
  const auto parameters = with([](auto& p) {
    p.drive.limit = 1.0, p.drive.torque_per_unit_Nm = 0.3, p.drive.back_emf_s_per_rad = 1.2;
    p.drive.brake_when_disabled = 1.0;
    p.thermal.resistance_per_K = 0.0039;
  });
  sim::ActuatorInput input{.q_rad = 0.5, .kp = 1.0, .supply = 12.0, .temperature_C = 65.0};
  const double resistance = 1.0 + 0.0039 * 40.0;
  EXPECT_NEAR(first_torque_Nm(parameters, input, 2.0), 0.3 * (6.0 - 2.4) / resistance, 1e-12);
  input.enabled = false;
  EXPECT_NEAR(first_torque_Nm(parameters, input, 2.0), -0.3 * 2.4 / resistance, 1e-12);
}

TEST(ActuatorWarmth, ThinsFrictionByTheEnergyThatItDissipates) {
  const auto friction_Nm = [](const std::function<void(model::ActuatorParameters&)>& set, double duration_s) {
    sim::ActuatorModel actuator(with([&](auto& p) {
                                  p.friction.coulomb_Nm = 1.0;
                                  p.thermal.friction_per_J = -0.5;
                                  set(p);
                                }),
                                kActuatorStep_s);
    double torque_Nm = 0.0, q_rad = 0.0;
    for (int k = 0; k <= std::lround(duration_s / kActuatorStep_s); ++k) {
      torque_Nm = actuator.step(kLimp, q_rad, 2.0).torque_Nm;
      q_rad += 2.0 * kActuatorStep_s;
    }
    return -torque_Nm;
  };
  // dW/dt = 2 rad/s F, F = 1 Nm exp(-0.5 W)  =>  F = 1 Nm / (1 + t / 1 s). Tolerance: steps of 2 ms.
  const auto plain = [](auto&) {};
  EXPECT_NEAR(friction_Nm(plain, 0.0), 1.0, 1e-12);
  EXPECT_NEAR(friction_Nm(plain, 1.0), 0.5, 1e-3);
  EXPECT_NEAR(friction_Nm(plain, 3.0), 0.25, 1e-3);
  // Behind a shaft, the joint's friction warms it as well: it rubs alone, because the motor's hasn't moved yet.
  EXPECT_NEAR(friction_Nm(
                  [](auto& p) {
                    p.transmission.armature_kg_m2 = 1e9;
                    p.transmission.stiffness_Nm_per_rad = 1e-9;
                    p.transmission.friction_on_joint = 1.0;
                  },
                  1.0),
              0.5, 1e-3);
}

TEST(ActuatorWarmth, CostsTorqueByTheWindingsHeat) {
  sim::ActuatorModel actuator(with([](auto& p) { p.thermal.torque_per_Nm2_s = -0.01; }), kActuatorStep_s);
  const auto torque_Nm = [&] { return actuator.step({.feed_forward_Nm = 3.0}, 0.0, 0.0).torque_Nm; };
  EXPECT_NEAR(torque_Nm(), 3.0, 1e-12);
  double now_Nm = 0.0;
  for (int k = 0; k < 1000; ++k) now_Nm = torque_Nm();
  // u = T / 3 Nm falls by du/dt = -0.01 * 9 u^2  =>  u = 1 / (1 + 0.09 t), here t = 2 s. Tolerance: steps of 2 ms.
  EXPECT_NEAR(now_Nm, 3.0 / 1.18, 1e-3);
}

TEST(ActuatorWarmth, CostsTorqueByTheTimeSinceTheStart) {
  sim::ActuatorModel actuator(with([](auto& p) { p.thermal.torque_fade_share = 0.4, p.thermal.torque_fade_s = 0.5; }),
                              kActuatorStep_s);
  for (const bool again : {false, true}) {
    for (int k = 0; k < 2000; ++k) {
      const double expected_Nm = 5.0 * (1.0 - 0.4 * (1.0 - std::exp(-k * kActuatorStep_s / 0.5)));
      ASSERT_NEAR(actuator.step({.feed_forward_Nm = 5.0}, 0.0, 0.0).torque_Nm, expected_Nm, 1e-9) << k << again;
    }
    actuator.reset(0.0);
  }
}

}  // namespace
}  // namespace pmg::test
