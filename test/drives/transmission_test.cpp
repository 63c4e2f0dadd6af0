#include "drives/transmission.hpp"

#include <gtest/gtest.h>

namespace pmg::drives {
namespace {

TEST(Transmission, JointAndMotorAgreeOnAngleTorqueAndPower) {
  const Transmission transmission(
      {.bus = "can0", .node = 1, .drive = "leg", .direction = -1, .gear = 2.0, .zero_offset_rad = 0.1});
  // q_motor = -2 (0.3 + 0.1); a gear of 2 halves the torque; gains go with the gear's square.
  const MotorCommand motor = transmission.to_motor(
      MotorCommand{.q_rad = 0.3, .dq_rad_s = 1.5, .kp_Nm_per_rad = 400.0, .kd_Nm_s_per_rad = 8.0, .torque_Nm = 10.0});
  EXPECT_DOUBLE_EQ(motor.q_rad, -0.8);
  EXPECT_DOUBLE_EQ(motor.dq_rad_s, -3.0);
  EXPECT_DOUBLE_EQ(motor.kp_Nm_per_rad, 100.0);
  EXPECT_DOUBLE_EQ(motor.kd_Nm_s_per_rad, 2.0);
  EXPECT_DOUBLE_EQ(motor.torque_Nm, -5.0);
  EXPECT_DOUBLE_EQ(motor.torque_Nm * motor.dq_rad_s, 10.0 * 1.5) << "power";
  const MotorCommand joint = transmission.to_joint(motor);
  EXPECT_NEAR(joint.q_rad, 0.3, 1e-15);
  EXPECT_DOUBLE_EQ(joint.kp_Nm_per_rad, 400.0);
  const MotorReading reading = transmission.to_joint(MotorReading{.q_rad = -0.8, .dq_rad_s = -3.0, .torque_Nm = -5.0});
  EXPECT_NEAR(reading.q_rad, 0.3, 1e-15);
  EXPECT_DOUBLE_EQ(reading.dq_rad_s, 1.5);
  EXPECT_DOUBLE_EQ(reading.torque_Nm, 10.0);
}

TEST(Transmission, LimitsChangePlacesWithTheDirection) {
  const Transmission transmission(
      {.bus = "can0", .node = 1, .drive = "leg", .direction = -1, .gear = 2.0, .zero_offset_rad = 0.1});
  const MotorLimits limits =
      transmission.to_motor(MotorLimits{.q_lower_rad = -1.0, .q_upper_rad = 0.5, .dq_rad_s = 10.0, .torque_Nm = 60.0});
  EXPECT_DOUBLE_EQ(limits.q_lower_rad, -1.2);
  EXPECT_DOUBLE_EQ(limits.q_upper_rad, 1.8);
  EXPECT_DOUBLE_EQ(limits.dq_rad_s, 20.0);
  EXPECT_DOUBLE_EQ(limits.torque_Nm, 30.0);
}

}  // namespace
}  // namespace pmg::drives
