// A robot that drifts: kept on its heading in a simulation, where no turn is asked for; left alone on hardware.
#include "operator/heading_hold.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace pmg::ops {
namespace {

constexpr std::int64_t kPeriod_ns = 20'000'000;
constexpr double kPeriod_s = 0.02;

class Drifting {
 public:
  explicit Drifting(const std::string& backend, bool knows_up = true) {
    news.info.emplace();
    news.info->backend = backend;
    if (knows_up)
      news.upright = UprightRule{.up_I = {0.0, 1.0, 0.0}, .most_tilt_rad = 1.0};  // an IMU that lies on its side
    news.state.emplace();
  }
  /// Drives by this command; the robot turns as it is told and 0.05 rad/s besides, and sways with its steps.
  void run(double duration_s, const Command& asked) {
    for (double t_s = 0.0; t_s < duration_s; t_s += kPeriod_s) {
      now_ns += kPeriod_ns;
      const double sway_rad = 0.05 * std::sin(2.0 * M_PI * 1.3 * 1e-9 * static_cast<double>(now_ns));
      const double half_rad = 0.5 * (yaw_rad + sway_rad), upright = std::sqrt(0.5);
      // R_WI = yaw about the vertical, then a quarter turn about x that brings the IMU's y up.
      const double q[] = {upright * std::cos(half_rad), upright * std::cos(half_rad), upright * std::sin(half_rad),
                          upright * std::sin(half_rad)};
      std::copy_n(q, 4, news.state->orientation_WI);
      sent = hold.held(asked, &news, now_ns);
      changes += sent == before ? 0 : 1;
      before = sent;
      rate_rad_s += kPeriod_s / 0.2 * (sent[kOmega] + 0.05 - rate_rad_s);  // it turns on for a while
      yaw_rad += rate_rad_s * kPeriod_s;
      most = std::max(most, std::abs(sent[kOmega]));
    }
  }

  HeadingHold hold;
  RobotNews news;
  Command sent, before;
  double yaw_rad = 0.3, rate_rad_s = 0.0, most = 0.0;
  int changes = 0;
  std::int64_t now_ns = 1'000'000'000;
};

const Command kForwards{{0.5, 0.0, 0.0, 0.0, 0.0, 0.0}};

TEST(HeadingHold, ASimulatedRobotThatDriftsKeepsTheHeadingItHadWhenItBeganToWalk) {
  Drifting robot("sil");
  robot.run(20.0, kForwards);
  EXPECT_NEAR(robot.yaw_rad, 0.3, 0.12) << "1 rad without it";
  EXPECT_LE(robot.most, HeadingHold::kMost_rad_s);
  EXPECT_LT(robot.changes, 60) << "the command settles: a person is told what the robot makes of it";
  EXPECT_EQ(robot.sent[kVx], 0.5);
}

TEST(HeadingHold, NothingTurnsARobotOfHardwareNorOneWhoseHeadingIsNotKnown) {
  Drifting hardware("can"), unknown("sil", false);
  for (Drifting* robot : {&hardware, &unknown}) {
    robot->run(5.0, kForwards);
    EXPECT_EQ(robot->most, 0.0);
  }
  HeadingHold hold;
  EXPECT_EQ(hold.held(kForwards, nullptr, 1), kForwards);
}

TEST(HeadingHold, ATurnThatIsAskedForIsLeftAloneAndItsHeadingKeptAfterwards) {
  Drifting robot("sil");
  robot.run(2.0, kForwards);
  Command turn = kForwards;
  turn[kOmega] = 0.4;
  robot.run(2.0, turn);
  EXPECT_EQ(robot.sent, turn);
  robot.run(0.4, kForwards);
  EXPECT_EQ(robot.sent, kForwards) << "it comes to rest first";
  robot.run(0.4, kForwards);
  const double then_rad = robot.yaw_rad;
  robot.run(15.0, kForwards);
  EXPECT_NEAR(robot.yaw_rad, then_rad, 0.12);
}

TEST(HeadingHold, WhoStandsIsNotTurned) {
  Drifting robot("sil");
  robot.run(5.0, Command{{0.0, 0.0, 0.0, 0.1, 0.0, 0.0}});
  EXPECT_EQ(robot.most, 0.0);
}

}  // namespace
}  // namespace pmg::ops
