// Descriptors of other projects' policies: what fits is read, what doesn't is named.
#include "policy/policy_descriptor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "files/config_error.hpp"
#include "model/robots.hpp"
#include "policy/descriptor_file.hpp"
#include "refusal.hpp"

namespace pmg::policy {
namespace {

using test::DescriptorFile;
using test::z1;
using testing::HasSubstr;

std::string descriptor_refusal(const std::filesystem::path& file, const model::RobotModel& robot = z1(),
                               double rate_Hz = 100.0) {
  const std::string text = test::refusal_by<files::ConfigError>([&] { read_policy_descriptor(file, robot, rate_Hz); });
  EXPECT_THAT(text, testing::AnyOf("taken", HasSubstr(file.stem().string()))) << "it names the file";
  return text;
}

std::string descriptor_refusal_after(const std::string& text, const std::string& instead) {
  DescriptorFile file;
  file.exchange(text, instead);
  return descriptor_refusal(file.file());
}

TEST(PolicyDescriptor, IsReadInItsOwnOrderOfJoints) {
  const DescriptorFile file;
  const PolicyDescriptor told = read_policy_descriptor(file.file(), z1(), 100.0);
  EXPECT_EQ(told.observation_size, 264);
  EXPECT_EQ(told.joints.front(), z1().joint_index.at("right_hip_pitch"));
  const int right_knee = z1().joint_index.at("right_knee"), head = z1().joint_index.at("head_yaw");
  EXPECT_EQ(told.gains.kp_Nm_per_rad[right_knee], 104.0);
  EXPECT_EQ(told.gains.kd_Nm_s_per_rad[right_knee], 4.0);
  EXPECT_EQ(told.gains.kp_Nm_per_rad[head], z1().joints[static_cast<std::size_t>(head)].kp_Nm_per_rad) << "not its own";
  EXPECT_FALSE(told.action_bound_rad.has_value()) << "then the monitor's own";
}

TEST(PolicyDescriptor, AJointThatTheRobotLacksOrKeepsIsNamed) {
  EXPECT_THAT(descriptor_refusal_after("right_knee,", "right_kne,"), HasSubstr("'right_kne' is no joint of z1"));
  EXPECT_THAT(descriptor_refusal_after("right_knee,", "right_kne,"), HasSubstr("as right_knee"));
  EXPECT_THAT(descriptor_refusal_after("right_knee,", "head_yaw,"), HasSubstr("'head_yaw' is given to no policy"));
  EXPECT_THAT(descriptor_refusal_after("right_knee,", "left_knee,"), HasSubstr("'left_knee' stands twice"));
}

TEST(PolicyDescriptor, ATermThatIsNotMeasuredIsNamed) {
  EXPECT_THAT(descriptor_refusal_after("term: gyro", "term: base_lin_vel"), HasSubstr("'base_lin_vel' isn't measured"));
  EXPECT_THAT(descriptor_refusal_after("scale: [2, 2, 0.25]", "scale: [2, 2]"),
              HasSubstr("has 2 numbers; expected 1 or 3"));
  EXPECT_THAT(descriptor_refusal_after("history: 5", "history: 0"), HasSubstr("history"));
  EXPECT_THAT(descriptor_refusal_after("term: gyro, scale: [0.2], history: 5", "term: clock_sin, scale: [1]"),
              HasSubstr("period_s"));
}

TEST(PolicyDescriptor, WhatWouldMoveTheRobotOtherwiseThanTrainedIsRefused) {
  EXPECT_THAT(descriptor_refusal_after("rate_Hz: 50", "rate_Hz: 60"), HasSubstr("divided by a whole number"));
  EXPECT_THAT(descriptor_refusal_after("rate_Hz: 50", "rate_Hz: 200"), HasSubstr("divided by a whole number"));
  EXPECT_THAT(descriptor_refusal_after("default_rad: [-0.2, 0, 0, 0.4", "default_rad: [-0.2, 0, 0, 4.0"),
              HasSubstr("has right_knee at 4 rad"));
  EXPECT_THAT(descriptor_refusal_after("kp_Nm_per_rad: [101,", "kp_Nm_per_rad: ["), HasSubstr("kp_Nm_per_rad"));
  EXPECT_THAT(descriptor_refusal_after("kd_Nm_s_per_rad: [1,", "kd_Nm_s_per_rad: [0,"), HasSubstr("kd_Nm_s_per_rad"));
  EXPECT_THAT(descriptor_refusal_after("vx_m_s: [-0.3, 0.6]", "vx_m_s: [0.3, 0.6]"), HasSubstr("a range with 0 in it"));
  EXPECT_THAT(descriptor_refusal_after("frames: by_term", "frames: by_frame"),
              HasSubstr("the same history of all terms"));
  EXPECT_THAT(descriptor_refusal_after("rate_Hz", "rate_hz"), HasSubstr("rate_Hz"));
  EXPECT_THAT(descriptor_refusal_after("format: 1", "format: 1\nobservations: []"), HasSubstr("observations"));
}

TEST(PolicyDescriptor, AnImuThatMovesAgainstTheBaseIsRefused) {
  const DescriptorFile file;
  model::RobotModel robot = z1();
  robot.imu.link = robot.torso_link;
  EXPECT_THAT(descriptor_refusal(file.file(), robot), HasSubstr("joint waist_pitch is between the base and the IMU"));
}

TEST(PolicyDescriptor, AGoldenPairOfAnotherSizeIsNamedWithItsLine) {
  DescriptorFile file;
  file.append("golden: foreign_golden.csv\ngolden_tolerance: 0.001\n");
  std::ofstream pairs(file.file().parent_path() / "foreign_golden.csv");
  std::string row = "0";
  for (int i = 1; i < 264 + 12; ++i) row += ",0";
  pairs << row << "\n" << row << ",0\n" << std::flush;
  EXPECT_THAT(descriptor_refusal(file.file()), HasSubstr("foreign_golden.csv:2"));
}

}  // namespace
}  // namespace pmg::policy
