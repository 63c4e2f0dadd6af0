#include "faults/torso_attitude.hpp"

#include <gtest/gtest.h>

#include "control/fixtures.hpp"

namespace pmg::faults {
namespace {

constexpr double kRounding = 1e-9;  // rounding of a few rotations

TEST(TorsoAttitude, IsSeenThroughTheWaistWhateverTheHeading) {
  const model::RobotModel& robot = test::z1();
  TorsoAttitude torso(robot);
  model::RobotState state = test::standing_state(robot);
  EXPECT_NEAR(torso.error_rad(state, {}), 0.0, kRounding);
  state.q[robot.joint_index.at("waist_pitch")] += 0.3;
  EXPECT_NEAR(torso.error_rad(state, {}), 0.3, kRounding) << "bent above an upright pelvis";
  EXPECT_NEAR(torso.error_rad(state, {.pitch_rad = 0.3, .roll_rad = 0.0}), 0.0, kRounding);
  EXPECT_NEAR(torso.error_rad(state, {.pitch_rad = -0.3, .roll_rad = 0.0}), 0.6, kRounding);
  state.orientation_WI = Eigen::AngleAxisd(1.3, Eigen::Vector3d::UnitZ()) *
                         Eigen::AngleAxisd(-0.3, Eigen::Vector3d::UnitY()) * state.orientation_WI;
  EXPECT_NEAR(torso.error_rad(state, {}), 0.0, kRounding)
      << "a pelvis that leans back under a torso that bends forward";
}

TEST(TorsoAttitude, RollIsPositiveToTheRight) {
  const model::RobotModel& robot = test::z1();
  TorsoAttitude torso(robot);
  model::RobotState state = test::standing_state(robot);
  state.orientation_WI = Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX()) * state.orientation_WI;
  EXPECT_NEAR(torso.error_rad(state, {.pitch_rad = 0.0, .roll_rad = 0.2}), 0.0, kRounding);
  EXPECT_NEAR(torso.error_rad(state, {.pitch_rad = 0.0, .roll_rad = -0.2}), 0.4, kRounding);
}

TEST(TorsoAttitude, PitchComesBeforeRollAsInTheCommandsConvention) {
  const model::RobotModel& robot = test::z1();
  TorsoAttitude torso(robot);
  model::RobotState state = test::standing_state(robot);
  state.orientation_WI = Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitY()) *
                         Eigen::AngleAxisd(0.25, Eigen::Vector3d::UnitX()) * state.orientation_WI;
  EXPECT_NEAR(torso.error_rad(state, {.pitch_rad = 0.4, .roll_rad = 0.25}), 0.0, kRounding);
}

}  // namespace
}  // namespace pmg::faults
