// One joint's drive and transmission: each effect acts as its name says, and does nothing when it is neutral.
#include "sim/actuator_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "generator_core/allocation_count.hpp"

namespace pmg::sim {
namespace {

constexpr double kStep_s = 0.002;

/// A joint of 0.05 kg m^2 about its axis, under a constant torque from outside.
struct Joint {
  explicit Joint(const model::ActuatorParameters& parameters, double start_rad = 0.0)
      : actuator(parameters, kStep_s), q_rad(start_rad) {
    actuator.reset(start_rad);
  }
  void step(const ActuatorInput& input, double outside_Nm = 0.0) {
    torque = actuator.step(input, q_rad, dq_rad_s);
    const double inertia = 0.05 + actuator.joint_armature_kg_m2();
    dq_rad_s += kStep_s * (torque.torque_Nm + outside_Nm) / (inertia - kStep_s * torque.slope_Nm_s_per_rad);
    q_rad += kStep_s * dq_rad_s;
  }
  void run(double duration_s, const ActuatorInput& input, double outside_Nm = 0.0) {
    for (double t_s = 0.0; t_s < duration_s; t_s += kStep_s) step(input, outside_Nm);
  }
  ActuatorModel actuator;
  double q_rad, dq_rad_s = 0.0;
  ActuatorTorque torque;
};

constexpr ActuatorInput kLimp{};

model::ActuatorParameters with(const std::function<void(model::ActuatorParameters&)>& set) {
  model::ActuatorParameters parameters;
  set(parameters);
  return parameters;
}

TEST(ActuatorModel, IsAPdWhenNeutral) {
  ActuatorModel actuator({}, kStep_s);
  const ActuatorTorque torque =
      actuator.step({.q_rad = 0.5, .dq_rad_s = 0.2, .kp = 30.0, .kd = 2.0, .feed_forward_Nm = 0.7}, 0.1, -0.3);
  EXPECT_DOUBLE_EQ(torque.torque_Nm, 30.0 * 0.4 + 2.0 * 0.5 + 0.7);
  EXPECT_DOUBLE_EQ(torque.slope_Nm_s_per_rad, -2.0);
}

TEST(ActuatorModel, NewtonMetresAreNewtonMetresUnderEveryDriveLaw) {
  const model::ActuatorParameters::Drive position_pd{.limit = 20.0}, servo{.limit = 1.0, .torque_per_unit_Nm = 0.3},
      cascade{.limit = 10.0, .torque_per_unit_Nm = 35.0};
  const auto torque_Nm = [](const model::ActuatorParameters::Drive& drive, double supply, double wish_Nm) {
    const auto parameters = with([&](auto& p) { p.drive = drive; });
    const ActuatorInput input{.kp = 5.0, .feed_forward_Nm = wish_Nm, .supply = supply};
    return ActuatorModel(parameters, kStep_s).step(input, 0.0, 0.0).torque_Nm;
  };
  for (const double wish_Nm : {-2.5, 0.7, 2.6}) {
    EXPECT_NEAR(torque_Nm(position_pd, 1.0, wish_Nm), wish_Nm, 1e-12);
    EXPECT_NEAR(torque_Nm(servo, 12.0, wish_Nm), wish_Nm, 1e-12);
    EXPECT_NEAR(torque_Nm(servo, 9.0, wish_Nm), wish_Nm, 1e-12) << "the drive divides by its bus";
    EXPECT_NEAR(torque_Nm(cascade, 1.0, wish_Nm), wish_Nm, 1e-12);
  }
  EXPECT_NEAR(torque_Nm(servo, 12.0, 100.0), 0.3 * 12.0, 1e-12) << "full duty is all there is";
}

TEST(ActuatorModel, HoldsAtRestAgainstLessThanItsDryFriction) {
  const auto parameters = with([](auto& p) { p.friction.coulomb_Nm = 1.0; });
  Joint held(parameters);
  held.run(1.0, kLimp, 0.95);
  const double settled_rad = held.q_rad;
  EXPECT_LT(std::abs(settled_rad), 0.01) << "a sudden load swings a little before it is held";
  held.run(10.0, kLimp, 0.95);
  EXPECT_NEAR(held.q_rad, settled_rad, 1e-9) << "doesn't creep";
  Joint pushed(parameters);
  pushed.run(1.0, kLimp, 1.5);
  EXPECT_NEAR(pushed.dq_rad_s, 0.5 / 0.05, 0.1) << "what is beyond friction accelerates";
}

TEST(ActuatorModel, StopsASlidingJointAndKeepsItThere) {
  Joint joint(with([](auto& p) { p.friction.coulomb_Nm = 0.5; }));
  joint.dq_rad_s = 4.0;
  joint.run(0.39, kLimp);
  EXPECT_GT(joint.dq_rad_s, 0.05) << "0.5 Nm stop 0.05 kg m^2 at 4 rad/s in 0.4 s";
  joint.run(0.6, kLimp);
  EXPECT_NEAR(joint.q_rad, 0.8, 0.01) << "after 0.8 rad";
  EXPECT_LT(std::abs(joint.dq_rad_s), 1e-3);
}

TEST(ActuatorModel, LosesMoreTorqueUnderMoreLoad) {
  // Driven at constant speed against an external torque: motor torque beyond it is friction.
  const auto friction_Nm = [](double load_Nm) {
    Joint joint(with([](auto& p) {
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

TEST(ActuatorModel, DelaysCommandsByFractionsOfAStep) {
  ActuatorModel actuator(with([](auto& p) { p.command.delay_s = 0.007; }), kStep_s);
  std::vector<double> torque_Nm;
  for (int k = 0; k < 8; ++k) torque_Nm.push_back(actuator.step({.q_rad = 1.0, .kp = 1.0}, 0.0, 0.0).torque_Nm);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(torque_Nm[k], 0.0);
  EXPECT_NEAR(torque_Nm[3], 0.5, 1e-9) << "7 ms are three steps and a half";
  EXPECT_EQ(torque_Nm[4], 1.0);
}

TEST(ActuatorModel, LimitsTheRateOfCommands) {
  ActuatorModel actuator(with([](auto& p) { p.command.rate_limit_rad_s = 5.0; }), kStep_s);
  double torque_Nm = 0.0;
  for (int k = 0; k < 10; ++k) torque_Nm = actuator.step({.q_rad = 1.0, .kp = 1.0}, 0.0, 0.0).torque_Nm;
  EXPECT_NEAR(torque_Nm, 10 * 5.0 * kStep_s, 1e-12);
}

TEST(ActuatorModel, GivesNoMoreThanItsTorqueSpeedLine) {
  const auto parameters = with([](auto& p) { p.drive.stall_torque_Nm = 10.0, p.drive.no_load_rad_s = 8.0; });
  const auto torque_Nm = [&](double wish_Nm, double dq_rad_s) {
    return ActuatorModel(parameters, kStep_s).step({.feed_forward_Nm = wish_Nm}, 0.0, dq_rad_s).torque_Nm;
  };
  EXPECT_DOUBLE_EQ(torque_Nm(50.0, 0.0), 10.0);
  EXPECT_DOUBLE_EQ(torque_Nm(50.0, 4.0), 5.0);
  EXPECT_DOUBLE_EQ(torque_Nm(50.0, 9.0), 0.0);
  EXPECT_DOUBLE_EQ(torque_Nm(-50.0, 4.0), -10.0) << "braking";
  EXPECT_DOUBLE_EQ(torque_Nm(3.0, 4.0), 3.0);
}

TEST(ActuatorModel, LosesOfItsBusWhatTheBridgeTakesFromIt) {
  const double full_Nm = 0.3 * 12.0, sag_per_Nm = 0.2, back_emf_V_s_per_rad = 1.2;
  const auto parameters = with([&](auto& p) {
    p.drive = {.limit = 1.0, .torque_per_unit_Nm = 0.3, .back_emf_s_per_rad = back_emf_V_s_per_rad};
    p.drive.supply_sag_per_Nm = sag_per_Nm;
  });
  for (const double duty : {-1.0, 0.5, 0.05}) {
    for (const double dq_rad_s : {0.0, 3.0}) {
      const double torque_Nm =
          ActuatorModel(parameters, kStep_s).step({.q_rad = duty, .kp = 1.0, .supply = 12.0}, 0.0, dq_rad_s).torque_Nm;
      const double bus_V = 12.0 * (1.0 - sag_per_Nm * duty * torque_Nm);
      EXPECT_NEAR(torque_Nm, 0.3 * (duty * bus_V - back_emf_V_s_per_rad * dq_rad_s), 1e-12 * full_Nm) << duty;
    }
  }
}

TEST(ActuatorModel, LeavesAJointFreeWithinItsBacklash) {
  const auto parameters = with([](auto& p) {
    p.transmission = {
        .armature_kg_m2 = 0.02, .stiffness_Nm_per_rad = 500.0, .damping_Nm_s_per_rad = 0.5, .backlash_rad = 0.04};
  });
  Joint inside(parameters);
  inside.q_rad = 0.015;
  inside.step(kLimp);
  EXPECT_EQ(inside.torque.torque_Nm, 0.0);
  Joint beyond(parameters);
  beyond.q_rad = 0.03;
  beyond.step(kLimp);
  EXPECT_LT(beyond.torque.torque_Nm, -2.0) << "wound by 10 mrad of 500 Nm/rad, less what the rotor gives way";
  EXPECT_EQ(beyond.actuator.joint_armature_kg_m2(), 0.0) << "the rotor turns on its own";
}

TEST(ActuatorModel, StaysStableBehindAStiffShaft) {
  Joint joint(with([](auto& p) {
    p.transmission = {.armature_kg_m2 = 1e-3, .stiffness_Nm_per_rad = 5e4, .damping_Nm_s_per_rad = 1.0};
  }));
  joint.dq_rad_s = 1.0;
  joint.run(2.0, {.kp = 20.0, .kd = 1.0});
  EXPECT_LT(std::abs(joint.q_rad), 0.05);
  EXPECT_LT(std::abs(joint.dq_rad_s), 1.0);
}

TEST(ActuatorModel, GivesNothingWhenSwitchedOff) {
  ActuatorModel actuator(with([](auto& p) { p.drive.back_emf_s_per_rad = 2.0; }), kStep_s);
  EXPECT_EQ(actuator.step({.q_rad = 1.0, .kp = 10.0, .enabled = false}, 0.0, 1.0).torque_Nm, 0.0);
}

TEST(ActuatorModel, IsSwitchedOffAtOnceHoweverLateItsCommandsAre) {
  ActuatorModel actuator(with([](auto& p) { p.command.delay_s = 0.02; }), kStep_s);
  ActuatorInput input{.q_rad = 1.0, .kp = 10.0};
  for (int k = 0; k < 20; ++k) actuator.step(input, 0.0, 0.0);
  EXPECT_EQ(actuator.step(input, 0.0, 0.0).torque_Nm, 10.0);
  input.enabled = false;
  EXPECT_EQ(actuator.step(input, 0.0, 0.0).torque_Nm, 0.0);
}

TEST(ActuatorModel, ReadsTheSameWhileAReversalCrossesItsSensorsHysteresis) {
  ActuatorModel actuator(with([](auto& p) { p.sensor.hysteresis_rad = 0.04; }), kStep_s);
  const auto read_at = [&](double q_rad) {
    actuator.step(kLimp, q_rad, 0.0);
    return actuator.reading_rad(q_rad);
  };
  EXPECT_DOUBLE_EQ(read_at(0.015), 0.0) << "starts in the middle";
  EXPECT_DOUBLE_EQ(read_at(0.5), 0.48);
  EXPECT_DOUBLE_EQ(read_at(0.47), 0.48) << "waits";
  EXPECT_DOUBLE_EQ(read_at(0.3), 0.32) << "and comes along";
}

TEST(ActuatorModel, ReadsAnEccentricSensorsAngleAndFindsTheJointBehindIt) {
  const auto parameters = with(
      [](auto& p) { p.sensor = {.zero_offset_rad = 0.02, .eccentricity_rad = 0.3, .eccentricity_phase_rad = 0.5}; });
  const ActuatorModel actuator(parameters, kStep_s);
  for (const double q_rad : {-3.0, -0.7, 0.0, 0.4, 2.5}) {
    ActuatorModel there = actuator;
    there.reset(q_rad);
    const double reading_rad = there.reading_rad(q_rad);
    EXPECT_NEAR(reading_rad, q_rad + 0.02 + 0.3 * std::sin(q_rad + 0.5), 1e-12);
    EXPECT_NEAR(ActuatorModel::joint_rad(parameters.sensor, reading_rad), q_rad, 1e-12);
  }
}

TEST(ActuatorModel, RubsLessAndPullsLessWhenWarm) {
  const auto parameters = with([](auto& p) {
    p.friction.viscous_Nm_s_per_rad = 2.0;
    p.thermal = {.friction_per_K = -0.02, .torque_per_K = -0.004};
  });
  const auto torque_Nm = [&](double temperature_C, double wish_Nm, double dq_rad_s) {
    ActuatorModel actuator(parameters, kStep_s);
    return actuator.step({.feed_forward_Nm = wish_Nm, .temperature_C = temperature_C}, 0.0, dq_rad_s).torque_Nm;
  };
  EXPECT_DOUBLE_EQ(torque_Nm(25.0, 0.0, 1.0), -2.0);
  EXPECT_NEAR(torque_Nm(45.0, 0.0, 1.0), -2.0 * std::exp(-0.4), 1e-12);
  EXPECT_NEAR(torque_Nm(45.0, 10.0, 0.0), 10.0 * (1.0 - 0.08), 1e-12);
}

TEST(ActuatorModel, WarmsByTheSquareOfItsTorqueAndCools) {
  ActuatorModel actuator(with([](auto& p) {
                           p.friction.viscous_Nm_s_per_rad = 1.0;
                           p.thermal = {.friction_per_Nm2_s = -0.01, .cooling_s = 5.0};
                         }),
                         kStep_s);
  const auto friction_Nm = [&](double wish_Nm, double for_s) {
    ActuatorTorque torque;
    for (int k = 0; k < std::lround(for_s / kStep_s); ++k)
      torque = actuator.step({.feed_forward_Nm = wish_Nm}, 0.0, 1.0);
    return wish_Nm - torque.torque_Nm;
  };
  // 3 Nm with 5 s of cooling settle at 3^2 * 5 = 45 Nm^2 s. Tolerance: one step, and e^-8 of the way is left.
  EXPECT_NEAR(friction_Nm(3.0, 40.0), std::exp(-0.45), 0.005);
  EXPECT_NEAR(friction_Nm(0.0, 5.0), std::exp(-0.45 / std::exp(1.0)), 0.005);
}

TEST(ActuatorModel, NeverAllocatesInAStep) {
  if (test::allocation_count() < 0) GTEST_SKIP() << "a sanitizer's malloc isn't counted";
  ActuatorModel actuator(with([](auto& p) {
                           p.command = {.delay_s = 0.02, .rate_limit_rad_s = 4.0};
                           p.friction = {.coulomb_Nm = 0.1, .stribeck_Nm = 0.1, .load_driving = 0.1};
                         }),
                         kStep_s);
  const long before = test::allocation_count();
  for (int k = 0; k < 100; ++k) actuator.step({.q_rad = 1.0, .kp = 1.0}, 0.0, 0.1);
  EXPECT_EQ(test::allocation_count(), before);
}

TEST(ActuatorModel, RefusesWhatMakesNoSense) {
  const std::vector<std::function<void(model::ActuatorParameters&)>> senseless = {
      [](auto& p) { p.command.delay_s = 2.0; },
      [](auto& p) { p.command.rate_limit_rad_s = 0.0; },
      [](auto& p) { p.friction.presliding_rad = 0.0; },
      [](auto& p) { p.transmission.backlash_rad = 0.01; },
      [](auto& p) { p.transmission.stiffness_Nm_per_rad = 100.0; },
      [](auto& p) { p.sensor.eccentricity_rad = 1.0; },
      [](auto& p) { p.thermal.cooling_s = 0.0; }};
  for (const auto& set : senseless) EXPECT_THROW(ActuatorModel(with(set), kStep_s), std::invalid_argument);
}

}  // namespace
}  // namespace pmg::sim
