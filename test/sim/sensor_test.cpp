#include <gtest/gtest.h>

#include <cmath>

#include "robots.hpp"
#include "sim/sensor_noise.hpp"
#include "sim/world.hpp"

namespace pmg {
namespace {

/// Sensors of a pelvis in the air with this attitude and angular velocity omega_B.
model::RobotState read_in_attitude(const Eigen::Quaterniond& q_WB, const Eigen::Vector3d& omega_B) {
  sim::World world(z1(), {});
  mjData* d = world.mj_data();
  d->qpos[2] += 1.0;
  d->qpos[3] = q_WB.w();
  for (int k = 0; k < 3; ++k) d->qpos[4 + k] = q_WB.vec()[k];
  for (int k = 0; k < 3; ++k) d->qvel[3 + k] = omega_B[k];
  mj_forward(world.mj_model(), d);
  model::RobotState state;
  world.read(state);
  return state;
}

TEST(Sensors, GyroIsTheAngularVelocityInTheImuFrame) {
  const Eigen::Vector3d omega_B(0.3, -0.2, 0.7);
  const auto state = read_in_attitude(Eigen::Quaterniond(Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitX())), omega_B);
  EXPECT_LT((state.gyro_rad_s - z1().imu.T_LI.linear().transpose() * omega_B).norm(), 1e-12);
}

TEST(Sensors, OrientationTakesTheImuFrameToTheWorld) {
  const Eigen::Quaterniond pitched_forward(Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()));
  const auto state = read_in_attitude(pitched_forward, Eigen::Vector3d::Zero());
  EXPECT_LT(state.orientation_WI.angularDistance(pitched_forward * Eigen::Quaterniond(z1().imu.T_LI.linear())), 1e-7);
  EXPECT_LT((state.orientation_WI * z1().imu.T_LI.linear().transpose() * Eigen::Vector3d::UnitX()).z(), -0.19)
      << "a robot that leans forward looks down";
}

TEST(Sensors, AccelerometerShowsGravityUpwardsAtRest) {
  sim::World world(z1(), {});
  for (int i = 0; i < 2500; ++i) world.step(standing_command(z1()));
  model::RobotState state;
  world.read(state);
  const Eigen::Vector3d acceleration_W = state.orientation_WI * state.acceleration_m_s2;
  EXPECT_LT((acceleration_W - Eigen::Vector3d(0, 0, 9.81)).norm(), 0.1);  // still settling a little
}

TEST(Sensors, BelongToTheStateOfTheSample) {
  sim::World world(z1(), {});
  model::JointCommand command = standing_command(z1());
  command.kp *= 0.1;  // weak gains: the robot falls
  model::RobotState state;
  for (int i = 0; i < 400; ++i) world.step(command);
  world.read(state);
  const model::GroundTruth truth = world.truth();
  ASSERT_GT(truth.omega_WB_B.norm(), 0.05);
  const Eigen::Matrix3d R_BI = z1().imu.T_LI.linear();  // on the base link
  EXPECT_LT((R_BI * state.gyro_rad_s - truth.omega_WB_B).norm(), 1e-9);
  EXPECT_LT(state.orientation_WI.angularDistance(truth.q_WB * Eigen::Quaterniond(R_BI)), 1e-7);
}

TEST(Sensors, NoiseHasTheDeviationAskedForAndFollowsTheSeed) {
  sim::WorldOptions options;
  options.encoder_noise_rad = 0.01;
  options.gyro_noise_rad_s = 0.02;
  options.orientation_noise_rad = 0.03;
  sim::SensorNoise noise(options, 31), same(options, 31);
  options.seed = 1;
  sim::SensorNoise other(options, 31);
  EXPECT_EQ(noise.encoder_rad(), same.encoder_rad());
  EXPECT_NE(noise.encoder_rad(), other.encoder_rad());

  constexpr int kDraws = 4000;
  double encoder = 0.0, gyro = 0.0, orientation = 0.0, mean = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    noise.draw();
    encoder += noise.encoder_rad().squaredNorm() / 31.0;
    mean += noise.encoder_rad().mean();
    gyro += noise.gyro_rad_s().squaredNorm() / 3.0;
    orientation += 4.0 * noise.orientation().vec().squaredNorm() / 3.0;
  }
  // 12000 numbers give the deviation to 0.7 %; the tolerance of 3 % is more than four times that.
  EXPECT_NEAR(std::sqrt(encoder / kDraws), 0.01, 0.0003);
  EXPECT_NEAR(std::sqrt(gyro / kDraws), 0.02, 0.0006);
  EXPECT_NEAR(std::sqrt(orientation / kDraws), 0.03, 0.0009);
  EXPECT_NEAR(mean / kDraws, 0.0, 5.0 * 0.01 / std::sqrt(31.0 * kDraws));
}

TEST(Sensors, WithoutNoiseReadTheTruth) {
  sim::World world(z1(), {});
  model::RobotState state;
  world.read(state);
  EXPECT_EQ(state.q, z1().q_stand());
  EXPECT_TRUE(state.dq.isZero(0.0));
}

TEST(Sensors, ReadingTwiceReadsTheSameSample) {
  sim::WorldOptions options;
  options.encoder_noise_rad = 0.01;
  sim::World world(z1(), options);
  model::RobotState first, second;
  world.read(first);
  world.read(second);
  EXPECT_EQ(first.q, second.q);
  EXPECT_NE(first.q, z1().q_stand());
}

}  // namespace
}  // namespace pmg
