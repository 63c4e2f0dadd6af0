#include "sil/shown_speed.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace pmg::sil {
namespace {

/// A robot that walks at these speeds in its own frame, while it turns and sways by 2 cm.
ShownSpeed walked(double forwards_m_s, double left_m_s, double turn_rad_s, double duration_s) {
  ShownSpeed speed;
  PoseSample pose;
  pose.count = 7;
  double x = 0.0, y = 0.0, yaw = 2.5;
  for (int k = 0; k < static_cast<int>(duration_s * 100.0); ++k) {
    yaw += 0.01 * turn_rad_s;
    x += 0.01 * (forwards_m_s * std::cos(yaw) - left_m_s * std::sin(yaw));
    y += 0.01 * (forwards_m_s * std::sin(yaw) + left_m_s * std::cos(yaw));
    const double sway_m = 0.02 * std::sin(2.0 * M_PI * 1.3 * 0.01 * k);
    pose.time_s = 0.01 * k;
    pose.qpos = {x - sway_m * std::sin(yaw), y + sway_m * std::cos(yaw), 0.7, std::cos(0.5 * yaw), 0.0, 0.0,
                 std::sin(0.5 * yaw)};
    speed.take(pose);
    speed.take(pose);  // the picture is drawn again before the robot has moved
  }
  return speed;
}

TEST(ShownSpeed, IsTheSpeedInTheRobotsOwnFrame) {
  const ShownSpeed speed = walked(0.5, -0.2, 0.3, 5.0);
  EXPECT_NEAR(speed.forwards_m_s(), 0.5, 0.01);
  EXPECT_NEAR(speed.left_m_s(), -0.2, 0.05) << "the sway is smoothed";
  EXPECT_NEAR(speed.turn_rad_s(), 0.3, 0.01);
}

TEST(ShownSpeed, ARobotThatIsSetElsewhereHasNoSpeed) {
  ShownSpeed speed = walked(0.5, 0.0, 0.0, 2.0);
  PoseSample elsewhere;
  elsewhere.count = 7;
  elsewhere.time_s = 10.0;
  elsewhere.qpos = {100.0, 100.0, 0.7, 1.0, 0.0, 0.0, 0.0};
  speed.take(elsewhere);
  EXPECT_EQ(speed.forwards_m_s(), 0.0);
}

}  // namespace
}  // namespace pmg::sil
