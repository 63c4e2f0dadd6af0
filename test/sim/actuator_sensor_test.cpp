// The drive's sensor: each effect acts as its name says, and does nothing when it is neutral.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "one_joint.hpp"

namespace pmg::test {
namespace {

TEST(ActuatorSensor, ReadsTheSameWhileAReversalCrossesItsSensorsHysteresis) {
  sim::ActuatorModel actuator(with([](auto& p) { p.sensor.hysteresis_rad = 0.04; }), kActuatorStep_s);
  const auto read_at = [&](double q_rad) {
    actuator.step(kLimp, q_rad, 0.0);
    return actuator.reading_rad(q_rad);
  };
  EXPECT_DOUBLE_EQ(read_at(0.015), 0.0) << "starts in the middle";
  EXPECT_DOUBLE_EQ(read_at(0.5), 0.48);
  EXPECT_DOUBLE_EQ(read_at(0.47), 0.48) << "waits";
  EXPECT_DOUBLE_EQ(read_at(0.3), 0.32) << "and comes along";
}

TEST(ActuatorSensor, ReadsAnEccentricSensorsAngleAndFindsTheJointBehindIt) {
  const auto parameters = with(
      [](auto& p) { p.sensor = {.zero_offset_rad = 0.02, .eccentricity_rad = 0.3, .eccentricity_phase_rad = 0.5}; });
  const sim::ActuatorModel actuator(parameters, kActuatorStep_s);
  for (const double q_rad : {-3.0, -0.7, 0.0, 0.4, 2.5}) {
    sim::ActuatorModel there = actuator;
    there.reset(q_rad);
    const double reading_rad = there.reading_rad(q_rad);
    EXPECT_NEAR(reading_rad, q_rad + 0.02 + 0.3 * std::sin(q_rad + 0.5), 1e-12);
    EXPECT_NEAR(sim::ActuatorModel::joint_rad(parameters, reading_rad, 0.0), q_rad, 1e-12);
  }
}

TEST(ActuatorSensor, ReadsAndFindsTheJointBehindReadingsOfAnotherScale) {
  const auto parameters = with([](auto& p) {
    p.sensor = {.zero_offset_rad = 0.02, .angle_scale = 1.1, .eccentricity_rad = 0.3, .eccentricity_phase_rad = 0.5};
  });
  const auto round = with([](auto& p) { p.sensor = {.zero_offset_rad = 0.02, .angle_scale = 1.1}; });
  for (const double q_rad : {-3.0, -0.7, 0.0, 0.4, 2.5}) {
    sim::ActuatorModel there(parameters, kActuatorStep_s);
    there.reset(q_rad);
    const double reading_rad = there.reading_rad(q_rad);
    EXPECT_NEAR(reading_rad, 1.1 * q_rad + 0.02 + 0.3 * std::sin(q_rad + 0.5), 1e-12);
    EXPECT_NEAR(sim::ActuatorModel::joint_rad(parameters, reading_rad, 0.0), q_rad, 1e-12);
    EXPECT_NEAR(sim::ActuatorModel::joint_rad(round, 1.1 * q_rad + 0.02, 0.0), q_rad, 1e-12);
  }
  const auto folded = with([](auto& p) { p.sensor = {.angle_scale = 0.8, .eccentricity_rad = 0.9}; });
  EXPECT_THROW(sim::ActuatorModel(folded, kActuatorStep_s), std::invalid_argument) << "the reading turns back";
}

TEST(ActuatorSensor, ReadsADiscThatIsNotRoundAndTurnsWithTheMotorsShaft) {
  const auto parameters = with([](auto& p) {
    p.sensor = {.eccentricity_rad = 0.08,
                .eccentricity_order = 6.0,
                .eccentricity_phase_rad = 0.5,
                .ellipticity_rad = 0.1,
                .ellipticity_phase_rad = -0.3};
  });
  for (const double q_rad : {-3.0, -0.7, 0.0, 0.4, 2.5}) {
    sim::ActuatorModel there(parameters, kActuatorStep_s);
    there.reset(q_rad);
    const double reading_rad = there.reading_rad(q_rad);
    EXPECT_NEAR(reading_rad, q_rad + 0.08 * std::sin(6.0 * q_rad + 0.5) + 0.1 * std::sin(2.0 * q_rad - 0.3), 1e-12);
    EXPECT_NEAR(sim::ActuatorModel::joint_rad(parameters, reading_rad, 0.0), q_rad, 1e-12);
  }
  const auto folded = with([](auto& p) { p.sensor = {.eccentricity_rad = 0.2, .eccentricity_order = 6.0}; });
  EXPECT_THROW(sim::ActuatorModel(folded, kActuatorStep_s), std::invalid_argument) << "the reading turns back";
}

/// However many stages a lag has, the drive is late by the whole of it at constant speed.
TEST(ActuatorSensor, LagsByTheSameTimeInAsManyStagesAsItHas) {
  constexpr double kLag_s = 0.03, kSpeed_rad_s = 1.0, kStiffness = 1.0;
  std::vector<double> soon_Nm;
  for (const double stages : {1.0, 2.0, 3.0}) {
    sim::ActuatorModel actuator(with([&](auto& p) { p.sensor = {.lag_s = kLag_s, .lag_stages = stages}; }),
                                kActuatorStep_s);
    double torque_Nm = 0.0;
    int k = 0;
    for (; k < 200; ++k) {
      torque_Nm = actuator.step({.kp = kStiffness}, kSpeed_rad_s * k * kActuatorStep_s, kSpeed_rad_s).torque_Nm;
      if (k == 5) soon_Nm.push_back(torque_Nm);
    }
    EXPECT_NEAR(-torque_Nm / kStiffness, kSpeed_rad_s * ((k - 1) * kActuatorStep_s - kLag_s), 1e-5) << stages;
  }
  EXPECT_GT(soon_Nm[1], 0.7 * soon_Nm[0]) << "below zero: the more stages, the later the first reaction";
  EXPECT_GT(soon_Nm[2], 0.8 * soon_Nm[1]);
  const auto half = with([](auto& p) { p.sensor = {.lag_s = kLag_s, .lag_stages = 1.5}; });
  EXPECT_THROW(sim::ActuatorModel(half, kActuatorStep_s), std::invalid_argument);
}

TEST(ActuatorSensor, IsLateInTheDriveAndInRecordings) {
  for (const double late_s : {0.007, 0.0005}) {
    sim::ActuatorModel actuator(with([&](auto& p) { p.sensor.delay_s = late_s; }), kActuatorStep_s);
    for (int k = 0; k < 12; ++k) {  // a joint at 1 rad/s: its angle is the time
      const double t_s = k * kActuatorStep_s, seen_s = std::max(0.0, t_s - late_s);
      const double torque_Nm = actuator.step({.kp = 1.0, .kd = 10.0}, t_s, 1.0).torque_Nm;
      if (t_s > late_s + kActuatorStep_s) {
        EXPECT_NEAR(torque_Nm, -seen_s - 10.0, 1e-12);
      }
      if (k == 0) {
        EXPECT_LT(std::abs(torque_Nm), late_s > kActuatorStep_s ? 1e-12 : 10.0) << "the speed comes late too";
      }
      for (const double share : {0.25, 1.0}) {
        const double now_s = t_s + share * kActuatorStep_s;
        EXPECT_NEAR(actuator.reading_rad(now_s, share), std::max(0.0, now_s - late_s), 1e-12) << k;
      }
    }
  }
}

TEST(ActuatorSensor, ShowsTheDriveANewReadingOnceInAPeriodAndRecordingsEach) {
  sim::ActuatorModel actuator(with([](auto& p) { p.sensor.hold_s = 0.01; }), kActuatorStep_s);
  for (int k = 0; k < 13; ++k) {
    const double q_rad = 0.1 * k;
    const int seen = k - k % 5;  // 10 ms are five steps
    EXPECT_EQ(actuator.step({.kp = 1.0}, q_rad, 0.0).torque_Nm, -0.1 * seen);
    EXPECT_EQ(actuator.reading_rad(q_rad), q_rad);
  }
}

TEST(ActuatorSensor, TurnsWithTheMotorOrTheJoint) {
  for (const double on_motor : {0.0, 0.5, 1.0}) {
    const auto parameters = with([&](auto& p) {
      p.sensor.on_motor = on_motor;
      p.sensor.zero_offset_rad = 0.1;
      p.transmission.armature_kg_m2 = 0.02;
      p.transmission.stiffness_Nm_per_rad = 50.0;
      p.transmission.backlash_rad = 0.04;
    });
    OneJoint joint(parameters);
    joint.q_rad = 0.015;  // within the play: the motor stays
    EXPECT_NEAR(joint.actuator.step(kLimp, joint.q_rad, 0.0).torque_Nm, 0.0, 1e-12);
    EXPECT_NEAR(joint.reading_rad(), 0.1 + (1.0 - on_motor) * 0.015, 1e-12);
    EXPECT_NEAR(joint.actuator.step({.q_rad = 0.1, .kp = 10.0}, 0.015, 0.0).torque_Nm, 0.0, 1e-12);
    EXPECT_NEAR(joint.actuator.drive_torque_Nm(), -10.0 * (1.0 - on_motor) * 0.015, 1e-12) << "the drive sees the same";
    // Under a load the motor stands ahead by half the play and by the shaft's twist.
    const double q_rad = sim::ActuatorModel::joint_rad(parameters, 0.6, 2.0);
    EXPECT_NEAR(q_rad, 0.5 - on_motor * (0.02 + 2.0 / 50.0), 1e-12);
    joint.actuator.reset_at_rest({.q_rad = 0.6, .feed_forward_Nm = 2.0}, q_rad, 2.0);
    EXPECT_NEAR(joint.actuator.reading_rad(q_rad), 0.6, 1e-12);
  }
}

}  // namespace
}  // namespace pmg::test
