// Whatever of a headset is lost, late or old holds.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vr/vr_fixture.hpp"

namespace pmg::vr {
namespace {

using Arms = pmg_msgs::arms_t;
using testing::HasSubstr;
using VrLoss = VrCommandTest;

TEST_F(VrLoss, WhateverLosesTheHeadsetHoldsAndAFreshSqueezeIsNeeded) {
  const auto lost_by = [&](const char* what, auto spoil, auto mend) {
    SCOPED_TRACE(what);
    walk();
    spoil();
    step();
    expect_held();
    run(0.2);
    mend();
    step();
    glide(-kReach_m, 0.0);
    expect_fresh_squeeze_needed();
    headset_.let_go();
    run(0.1);
  };
  std::optional<Pose> head;
  lost_by(
      "tracking", [&] { head = std::exchange(headset_.news.head, std::nullopt); }, [&] { headset_.news.head = head; });
  lost_by(
      "blur", [&] { headset_.news.shown = false; }, [&] { headset_.news.shown = true; });
  lost_by(
      "jump", [&] { headset_.step(1.0, 0.0); }, [&] { headset_.step(-1.0, 0.0); });
  lost_by(
      "another headset", [&] { vr_.begin(now_ns_); },
      [&] {
        headset_.step(-kReach_m, 0.0);
        ++headset_.news.recentres;
        step();
        headset_.step(kReach_m, 0.0);
      });
}

TEST_F(VrLoss, ALossBetweenTwoLooksCountsToo) {
  walk();
  for (const bool shown : {false, true}) {
    headset_.news.shown = shown;
    now_ns_ += 2'000'000;
    vr_.take(headset_.next(now_ns_), now_ns_);
  }
  step();
  expect_held();
  glide(-kReach_m, 0.0);
  expect_fresh_squeeze_needed();
}

TEST_F(VrLoss, ASilentLinkHoldsAfterThreeTenthsOfASecond) {
  walk();
  talks_ = false;
  run(0.25);
  EXPECT_DOUBLE_EQ(command_[kVx], 0.8);
  run(0.06);
  expect_held();
  talks_ = true;
  glide(-kReach_m, 0.0);
  expect_fresh_squeeze_needed();
}

TEST_F(VrLoss, LateMessagesDoNotDriveOnAndALateReleaseEnds) {
  walk();
  headset_.delay_ns = ops::Device::kLate_ns + 20'000'000;
  run(0.25);
  EXPECT_DOUBLE_EQ(command_[kVx], 0.8) << "as silence";
  EXPECT_THAT(vr_.note(), HasSubstr("late"));
  headset_.let_go();
  step();
  expect_held();
  headset_.delay_ns = 0;
  glide(-kReach_m, 0.0);
  headset_.delay_ns = ops::Device::kLate_ns + 20'000'000;
  headset_.squeeze();
  run(0.1);
  headset_.delay_ns = 0;
  run(0.1);
  expect_held();
}

TEST_F(VrLoss, OldAndRepeatedMessagesChangeNothing) {
  walk();
  const VrNews driving = headset_.next(now_ns_);
  vr_.take(driving, now_ns_);
  headset_.let_go();
  step();
  talks_ = false;
  for (int k = 0; k < 10; ++k) {
    vr_.take(driving, now_ns_);
    step();
    expect_held();
  }
}

TEST_F(VrLoss, WhateverLosesTheHeadsetHoldsThePalms) {
  for (const int how : {0, 1, 2, 3, 4}) {
    headset_ = test::Headset{};
    vr_.begin(now_ns_);
    run(0.3);
    headset_.squeeze();
    run(0.1);
    headset_.pull(kLeft);
    run(0.1);
    ASSERT_EQ((*vr_.palms())[kLeft].wish, Arms::AIM) << how;
    const auto hand = headset_.news.hands[kLeft].pose;
    if (how == 0) headset_.news.head.reset();
    if (how == 1) headset_.news.shown = false;
    if (how == 2) headset_.news.hands[kLeft].pose.reset();
    if (how == 3) ++headset_.news.recentres;
    if (how == 4) {
      vr_.end(now_ns_);
      EXPECT_EQ((*vr_.palms())[kLeft].wish, Arms::HOLD) << "before anybody looks";
    }
    step();
    EXPECT_EQ((*vr_.palms())[kLeft].wish, Arms::HOLD) << how;
    if (how != 2) continue;
    EXPECT_TRUE(hold_.armed()) << "a lost hand is no reason to stop";
    headset_.news.hands[kLeft].pose = hand;
    run(0.5);
    EXPECT_EQ((*vr_.palms())[kLeft].wish, Arms::HOLD);
  }
}

}  // namespace
}  // namespace pmg::vr
