// What head, grips and triggers mean.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vr/vr_fixture.hpp"

namespace pmg::vr {
namespace {

using Arms = pmg_msgs::arms_t;
using testing::HasSubstr;

TEST_F(VrCommandTest, AStepFromTheCentreIsAVelocityInItsHeading) {
  glide(0.3, 0.0);
  EXPECT_EQ(command_, Command{}) << "without a grip";
  glide(-0.3, 0.0);
  headset_.squeeze();
  run(0.1);
  glide(0.1, 0.0);
  EXPECT_EQ(command_[kVx], 0.0) << "within the dead zone";
  glide(0.25, 0.0);
  EXPECT_DOUBLE_EQ(command_[kVx], 0.8);
  glide(-0.70, 0.0);
  EXPECT_NEAR(command_[kVx], -0.5, 1e-9);
  glide(0.35, -0.20);
  EXPECT_LT(command_[kVy], 0.0);
  EXPECT_GT(command_[kVy], -0.3);
  EXPECT_NEAR(command_[kVx], 0.0, 1e-9);
}

TEST_F(VrCommandTest, TurnsTiltsAndHeightAreThoseOfTheHead) {
  headset_.squeeze();
  run(0.1);
  tilt(kTurn_rad, 0.0, 0.0);
  EXPECT_DOUBLE_EQ(command_[kOmega], 0.6) << "to the left";
  tilt(0.0, kTilt_rad, 0.0);
  EXPECT_NEAR(command_[kPitch], 0.4, 1e-9) << "forward";
  tilt(0.0, 0.0, -kTilt_rad);
  EXPECT_NEAR(command_[kRoll], -0.2, 1e-9) << "to the left";
  tilt(0.0, 0.0, 0.0);
  glide(0.0, 0.0, -0.16);
  EXPECT_NEAR(command_[kHeight], -0.10, 1e-9);
  glide(0.0, 0.0, 0.5);
  EXPECT_DOUBLE_EQ(command_[kHeight], 0.02) << "the robot's own end";
}

TEST_F(VrCommandTest, AGripAwayFromTheCentreDoesNotDriveAndSaysWhy) {
  glide(0.3, 0.0);
  headset_.squeeze();
  run(0.2);
  expect_held();
  EXPECT_TRUE(hold_.refused(-1));
  EXPECT_THAT(vr_.note(), HasSubstr("recentre"));
  ++headset_.news.recentres;
  step();
  run(0.2);
  expect_held();
  headset_.let_go();
  step();
  headset_.squeeze();
  run(0.1);
  EXPECT_TRUE(hold_.armed());
}

TEST_F(VrCommandTest, AGripThatIsSqueezedWhenTheHeadsetComesDoesNotDrive) {
  headset_.squeeze();
  vr_.begin(now_ns_);
  expect_fresh_squeeze_needed();
}

TEST_F(VrCommandTest, PostureStaysWhenTheGripIsLetGoOrTheHeadsetIsLostAndIsCountedOnFromThere) {
  headset_.squeeze();
  run(0.1);
  glide(0.0, 0.0, -0.16);
  headset_.let_go();
  step();
  EXPECT_NEAR(command_[kHeight], -0.10, 1e-9);
  glide(0.0, 0.0, 0.16);
  EXPECT_NEAR(command_[kHeight], -0.10, 1e-9) << "it doesn't rise with the head";
  headset_.news.head.reset();
  run(1.0);
  EXPECT_NEAR(command_[kHeight], -0.10, 1e-9);
  headset_.news.head = Pose{.p_m = {0.3, -0.2, 1.7}, .R = test::turned(0.5)};
  ++headset_.news.recentres;
  run(0.1);
  headset_.squeeze();
  step();
  EXPECT_TRUE(hold_.armed());
  EXPECT_NEAR(command_[kHeight], -0.10, 1e-9) << "no jump";
  glide(0.0, 0.0, 0.11);
  EXPECT_NEAR(command_[kHeight], -0.05, 1e-9);
  headset_.let_go();
  run(0.1);
  ++headset_.news.uprights;
  step();
  EXPECT_EQ(command_[kHeight], 0.0);
}

TEST_F(VrCommandTest, ATriggerLeadsAPalmWhileTheGripIsHeldAndNothingElseDoes) {
  headset_.pull(kRight);
  run(0.1);
  EXPECT_EQ(vr_.palms(), nullptr) << "no grip";
  headset_.release(kRight);
  headset_.squeeze();
  run(0.1);
  headset_.pull(kRight);
  step();
  ASSERT_NE(vr_.palms(), nullptr);
  const ops::PalmWish begun = (*vr_.palms())[kRight];
  EXPECT_EQ(begun.wish, Arms::AIM);
  EXPECT_TRUE(begun.p_m.isApprox(Eigen::Vector3d(0.0, -0.2, 0.0)));
  headset_.move(kRight, {0.05, 0.0, 0.02});
  step();
  EXPECT_TRUE((*vr_.palms())[kRight].p_m.isApprox(Eigen::Vector3d(0.05, -0.2, 0.02))) << "in the centre's heading";
  EXPECT_EQ((*vr_.palms())[kLeft].wish, Arms::HOLD);
  glide(0.3, 0.0);
  EXPECT_TRUE((*vr_.palms())[kRight].p_m.isApprox(Eigen::Vector3d(0.05, -0.2, 0.02))) << "relative to the head";
  headset_.let_go();
  step();
  EXPECT_EQ((*vr_.palms())[kRight].wish, Arms::HOLD);
  glide(-0.3, 0.0);
  headset_.squeeze();
  run(0.1);
  EXPECT_EQ((*vr_.palms())[kRight].wish, Arms::HOLD) << "the trigger was pulled before";
}

TEST_F(VrCommandTest, AnotherDeviceThatTakesOverHoldsThePalms) {
  headset_.squeeze();
  run(0.1);
  headset_.pull(kRight);
  run(0.1);
  ASSERT_EQ((*vr_.palms())[kRight].wish, Arms::AIM);
  vr_.command(7, now_ns_);
  EXPECT_EQ((*vr_.palms())[kRight].wish, Arms::HOLD);
  EXPECT_FALSE(vr_.driving());
}

TEST_F(VrCommandTest, TheSpanOfTheArmsScalesAndEndsLeads) {
  headset_.squeeze();
  run(0.1);
  headset_.pull(kRight);
  run(0.1);
  const auto spread = [&](Foot side, double left_m) {  // as a person does: over a second
    const Eigen::Vector3d from = headset_.news.hands[side].pose->p_m;
    const Eigen::Vector3d to = headset_.news.head->p_m + test::turned(0.5) * Eigen::Vector3d(0.0, left_m, -0.2);
    for (int k = 1; k <= 100; ++k) {
      headset_.news.hands[side].pose->p_m = from + (to - from) * k / 100;
      step();
    }
  };
  spread(kLeft, 0.75);
  spread(kRight, -0.75);
  ASSERT_EQ((*vr_.palms())[kRight].wish, Arms::AIM);
  ++headset_.news.spans_shown;
  step();
  EXPECT_DOUBLE_EQ(vr_.scale(), 0.8);
  EXPECT_EQ((*vr_.palms())[kRight].wish, Arms::HOLD);
  headset_.news.hands[kLeft].pose->p_m = headset_.news.hands[kRight].pose->p_m;
  ++headset_.news.spans_shown;
  step();
  EXPECT_DOUBLE_EQ(vr_.scale(), 0.8) << "nobody's arms are that short";
}

}  // namespace
}  // namespace pmg::vr
