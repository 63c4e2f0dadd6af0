// What comes next, from what is known of a robot.
#include "operator/way_up.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "operator/robot_text.hpp"

namespace pmg::ops {
namespace {

using Hoist = pmg_msgs::hoist_state_t;
using Modes = pmg_msgs::mode_t;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::int64_t kNow_ns = 5'000'000'000;

/// A robot whose IMU is mounted turned by 0.3 rad about x, that leans by tilt_rad about y.
RobotNews news(std::int8_t mode, double tilt_rad) {
  const Eigen::AngleAxisd R_LI(0.3, Eigen::Vector3d::UnitX());
  const Eigen::Quaterniond R_WI(Eigen::AngleAxisd(tilt_rad, Eigen::Vector3d::UnitY()) * R_LI);
  RobotNews news;
  news.status.mode = mode;
  news.heard_ns = kNow_ns;
  news.state.emplace();
  for (const auto& [i, value] : {std::pair{0, R_WI.w()}, {1, R_WI.x()}, {2, R_WI.y()}, {3, R_WI.z()}})
    news.state->orientation_WI[i] = value;
  const Eigen::Vector3d up_I = R_LI.inverse() * Eigen::Vector3d::UnitZ();
  news.upright = UprightRule{.up_I = {up_I.x(), up_I.y(), up_I.z()}, .most_tilt_rad = 1.0};
  return news;
}

std::vector<Step> steps(const RobotNews& news) { return steps_up(posture(news, kNow_ns)); }

RobotNews on_hoist(RobotNews news, std::int8_t state, bool stays_up = false) {
  news.hoist.state.emplace();
  news.hoist.state->state = state;
  news.hoist.state->stays_up = stays_up ? 1 : 0;
  news.hoist.heard_ns = kNow_ns;
  return news;
}

TEST(WayUp, TheTiltIsOfTheLinkThatCarriesTheImu) {
  for (const double tilt : {0.0, 0.4, 1.38, 3.1}) EXPECT_NEAR(*tilt_rad(news(Modes::DAMPING, tilt)), tilt, 1e-9);
  RobotNews unknown = news(Modes::DAMPING, 1.38);
  unknown.upright.reset();
  EXPECT_FALSE(tilt_rad(unknown));
  RobotNews broken = news(Modes::DAMPING, 1.38);
  broken.state->orientation_WI[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(tilt_rad(broken));
}

TEST(WayUp, WithoutAHoistWhatLiesIsPutUprightFirst) {
  EXPECT_THAT(steps(news(Modes::DAMPING, 0.1)), ElementsAre(Step::kStand));
  EXPECT_THAT(steps(news(Modes::PASSIVE, 1.1)), ElementsAre(Step::kPutUp, Step::kStand));
  EXPECT_THAT(steps(news(Modes::FAULT, 0.1)), ElementsAre(Step::kReset, Step::kStand));
  EXPECT_THAT(steps(news(Modes::FAULT, 1.1)), ElementsAre(Step::kPutUp, Step::kReset, Step::kStand));
  EXPECT_THAT(steps(news(Modes::STAND, 0.1)), IsEmpty());
  EXPECT_THAT(steps(news(Modes::WALK, 0.1)), IsEmpty());
}

TEST(WayUp, WithAHoistWhatNobodyHoldsIsLiftedFirst) {
  for (const double tilt : {0.1, 1.1}) {
    EXPECT_THAT(steps(on_hoist(news(Modes::DAMPING, tilt), Hoist::FREE)), ElementsAre(Step::kLift, Step::kStand));
    EXPECT_THAT(steps(on_hoist(news(Modes::FAULT, tilt), Hoist::FREE)),
                ElementsAre(Step::kLift, Step::kReset, Step::kStand));
    EXPECT_THAT(steps(on_hoist(news(Modes::DAMPING, tilt), Hoist::LIFTING)),
                ElementsAre(Step::kAwaitHoist, Step::kStand));
    EXPECT_THAT(steps(on_hoist(news(Modes::PASSIVE, tilt), Hoist::HOLDING)), ElementsAre(Step::kStand));
  }
  EXPECT_THAT(steps(on_hoist(news(Modes::STAND, 0.0), Hoist::HOLDING, true)), ElementsAre(Step::kSetDown));
  EXPECT_THAT(steps(on_hoist(news(Modes::STAND, 0.0), Hoist::LOWERING)), IsEmpty());
  RobotNews silent = on_hoist(news(Modes::DAMPING, 0.1), Hoist::FREE);
  silent.hoist.heard_ns = kNow_ns - 1'100'000'000;
  EXPECT_THAT(steps(silent), ElementsAre(Step::kStand)) << "a hoist that says nothing lifts nothing";
}

TEST(WayUp, TheWordsAreTheDevices) {
  const Posture lies = posture(on_hoist(news(Modes::FAULT, 1.38), Hoist::FREE), kNow_ns);
  EXPECT_EQ(way_up(lies, shell_manner()),
            "lies (1.38 rad from upright): pmg_send lift lifts it, then pmg_send reset resets it, then pmg_send stand "
            "makes it stand up");
  DeviceManner keys = shell_manner();
  keys.lifts = "H lifts it";
  keys.resets = "R resets it";
  keys.raises = "Enter makes it stand up";
  keys.sets_down = "G sets it down";
  EXPECT_EQ(way_up(lies, keys),
            "lies (1.38 rad from upright): H lifts it, then R resets it, then Enter makes it stand up");
  EXPECT_EQ(way_up(posture(on_hoist(news(Modes::STAND, 0.0), Hoist::HOLDING, true), kNow_ns), keys),
            "hangs on the hoist: G sets it down");
  EXPECT_EQ(way_up(posture(news(Modes::DAMPING, 1.38), kNow_ns), keys),
            "lies (1.38 rad from upright): put it upright and hold it, then Enter makes it stand up");
  EXPECT_EQ(way_up(posture(news(Modes::WALK, 0.0), kNow_ns), keys), "");
}

TEST(WayUp, WhoWatchesReadsItInWholeAndNoCommandIsInForce) {
  RobotNews lies = on_hoist(news(Modes::FAULT, 1.38), Hoist::FREE);
  lies.status.robot = "z1";
  lies.reference.emplace();
  std::string text;
  for (const std::string& line : screen(lies, 0.0)) {
    EXPECT_LE(line.size(), 80U);
    EXPECT_FALSE(line.starts_with("asked")) << line;
    text += line + "\n";
  }
  EXPECT_THAT(text, testing::HasSubstr("next       lies (1.38 rad from upright): pmg_send lift lifts it"));
  EXPECT_THAT(text, testing::HasSubstr("makes it stand up"));
  const auto json = news_json(lies, 0.0);
  EXPECT_FALSE(json.contains("command"));
  EXPECT_NEAR(json["tilt_rad"].get<double>(), 1.38, 1e-9);
  lies.status.mode = Modes::WALK;
  EXPECT_TRUE(news_json(lies, 0.0).contains("command"));
}

TEST(WayUp, WhatOfAnInfoIsNoRuleTellsNothing) {
  RobotNews without = news(Modes::DAMPING, 1.38);
  without.upright->up_I = {0.0, 0.0, 0.0};
  EXPECT_FALSE(tilt_rad(without)) << "no direction";
  EXPECT_THAT(steps(without), ElementsAre(Step::kStand));
}

}  // namespace
}  // namespace pmg::ops
