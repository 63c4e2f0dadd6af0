#include "can/xsens_imu.hpp"

#include <gtest/gtest.h>

namespace pmg::can {
namespace {

model::RobotState tilted() {
  model::RobotState state;
  state.orientation_WI = Eigen::AngleAxisd(0.4, Eigen::Vector3d(1.0, -2.0, 0.5).normalized());
  state.gyro_rad_s = {0.5, -3.0, 12.0};
  state.acceleration_m_s2 = {0.3, -9.81, 25.0};
  return state;
}

TEST(XsensImu, FramesAreTheManualsFixedPoint) {
  model::RobotState state;
  state.gyro_rad_s = {1.0, -1.0, 0.0};
  state.acceleration_m_s2 = {0.0, 0.0, 9.8125};
  const auto frames = imu_frames(state);
  EXPECT_EQ(frames[0].id, 0x21u);
  EXPECT_EQ(frames[0].data[0], 0x7F) << "1 is beyond 2^15 - 1 steps of 2^-15: the largest";
  EXPECT_EQ(frames[0].data[1], 0xFF);
  EXPECT_EQ(frames[1].id, 0x32u);
  EXPECT_EQ(frames[1].data[0], 0x02) << "512 steps of 2^-9 rad/s";
  EXPECT_EQ(frames[1].data[2], 0xFE);
  EXPECT_EQ(frames[2].id, 0x34u);
  EXPECT_EQ(frames[2].data[4] << 8 | frames[2].data[5], 2512) << "of 2^-8 m/s^2";
}

TEST(XsensImu, ASampleComesBackWithinHalfAStep) {
  const model::RobotState sent = tilted();
  XsensImu imu;
  imu.begin_cycle();
  for (const drives::Message& frame : imu_frames(sent)) EXPECT_TRUE(imu.hear(frame));
  EXPECT_EQ(imu.age_cycles(), 0);
  model::RobotState read;
  imu.read(read);
  EXPECT_LT(read.orientation_WI.angularDistance(sent.orientation_WI), 1e-4) << "four components, half of 2^-15 each";
  EXPECT_LE((read.gyro_rad_s - sent.gyro_rad_s).cwiseAbs().maxCoeff(), 0x1p-10);
  EXPECT_LE((read.acceleration_m_s2 - sent.acceleration_m_s2).cwiseAbs().maxCoeff(), 0x1p-9);
}

TEST(XsensImu, WhatIsNoOrientationOrNoMessageIsRefused) {
  XsensImu imu;
  auto frames = imu_frames(tilted());
  frames[0].data.fill(0);
  EXPECT_FALSE(imu.hear(frames[0])) << "an orientation of length 0";
  frames[1].length = 8;
  EXPECT_FALSE(imu.hear(frames[1]));
  frames[2].extended = true;
  EXPECT_FALSE(imu.hear(frames[2]));
  imu.begin_cycle();
  EXPECT_GT(imu.age_cycles(), XsensImu::kSilentCycles) << "it never spoke";
}

TEST(XsensImu, ItsAgeIsThatOfItsOldestMessage) {
  XsensImu imu;
  const auto frames = imu_frames(tilted());
  for (const drives::Message& frame : frames) imu.hear(frame);
  for (int k = 0; k < 4; ++k) {
    imu.begin_cycle();
    imu.hear(frames[1]);
    imu.hear(frames[2]);
  }
  EXPECT_EQ(imu.age_cycles(), 4);
}

}  // namespace
}  // namespace pmg::can
