#include "vr/palm_lead.hpp"

#include <gtest/gtest.h>

#include "vr/headset.hpp"

namespace pmg::vr {
namespace {

using Arms = pmg_msgs::arms_t;
using test::turned;

class PalmLeadTest : public testing::Test {
 protected:
  /// 11 ms, and a message.
  void step() {
    now_ns_ += 11'000'000;
    lead_.take(hand_, relative_, may_lead_, palm_, scale_, now_ns_);
    if (robot_follows_ && lead_.wish().wish == Arms::AIM)
      palm_ = PalmLead::Palm{.pose = {.p_m = lead_.wish().p_m, .R = lead_.wish().R}, .heard_ns = now_ns_};
    if (palm_ && robot_follows_) palm_->heard_ns = now_ns_;
  }
  void pull() {
    hand_.leads = true;
    ++hand_.lead_presses;
  }
  void release() { hand_.leads = false; }
  void run(double seconds) {
    for (; seconds > 0.0; seconds -= 0.011) step();
  }

  PalmLead lead_;
  HandNews hand_{.pose = Pose{}};
  std::optional<Pose> relative_ = Pose{.p_m = {0.4, -0.2, -0.5}, .R = turned(0.3, 0.2)};
  std::optional<PalmLead::Palm> palm_ =
      PalmLead::Palm{.pose = {.p_m = {0.25, -0.3, 0.1}, .R = turned(-0.4, 0.0, 0.5)}, .heard_ns = 1};
  bool may_lead_ = true, robot_follows_ = true;
  double scale_ = 0.8;
  std::int64_t now_ns_ = 1'000'000'000;
};

TEST_F(PalmLeadTest, ALeadBeginsWhereThePalmIsAndFollowsTheHandScaled) {
  step();
  EXPECT_EQ(lead_.wish().wish, Arms::HOLD);
  pull();
  const PalmLead::Palm before = *palm_;
  step();
  ASSERT_TRUE(lead_.leads());
  EXPECT_EQ(lead_.wish().p_m, before.pose.p_m) << "no jump";
  EXPECT_LT(lead_.wish().R.angularDistance(before.pose.R), 1e-9);
  relative_->p_m += Eigen::Vector3d(0.05, 0.02, -0.03);
  relative_->R = turned(0.1) * relative_->R;
  step();
  EXPECT_TRUE(lead_.wish().p_m.isApprox(before.pose.p_m + 0.8 * Eigen::Vector3d(0.05, 0.02, -0.03)));
  EXPECT_LT(lead_.wish().R.angularDistance(turned(0.1) * before.pose.R), 1e-9);
}

TEST_F(PalmLeadTest, ReclutchingAfterTheHandMovedDoesNotJump) {
  step();
  pull();
  run(0.1);
  relative_->p_m += Eigen::Vector3d(0.05, 0.0, 0.0);
  run(0.1);
  release();
  step();
  EXPECT_EQ(lead_.wish().wish, Arms::HOLD);
  for (int k = 0; k < 50; ++k) {
    relative_->p_m += Eigen::Vector3d(-0.01, 0.01, 0.0);
    step();
  }
  const Eigen::Vector3d stays = palm_->pose.p_m;
  pull();
  step();
  ASSERT_TRUE(lead_.leads());
  EXPECT_TRUE(lead_.wish().p_m.isApprox(stays));
}

TEST_F(PalmLeadTest, ATriggerThatWasPulledBeforeItCouldLeadDoesNotCountLater) {
  may_lead_ = false;
  step();
  pull();
  run(0.2);
  may_lead_ = true;
  run(0.2);
  EXPECT_FALSE(lead_.leads());
  release();
  step();
  pull();
  step();
  EXPECT_TRUE(lead_.leads());
}

TEST_F(PalmLeadTest, ATriggerThatIsPulledWhenTheHeadsetComesDoesNotCount) {
  pull();
  run(0.2);
  EXPECT_FALSE(lead_.leads());
}

TEST_F(PalmLeadTest, ALostControllerHoldsAndAFoundOneNeedsAFreshPull) {
  step();
  pull();
  run(0.1);
  const auto where = relative_;
  const Eigen::Vector3d target = lead_.wish().p_m;
  relative_.reset();
  step();
  EXPECT_EQ(lead_.wish().wish, Arms::HOLD);
  relative_ = where;
  run(0.5);
  EXPECT_EQ(lead_.wish().wish, Arms::HOLD);
  release();
  step();
  pull();
  step();
  EXPECT_TRUE(lead_.wish().p_m.isApprox(target));
}

TEST_F(PalmLeadTest, AControllerThatJumpsOrTwistsEndsTheLead) {
  for (const bool twist : {false, true}) {
    release();
    run(0.3);
    pull();
    run(0.1);
    ASSERT_TRUE(lead_.leads());
    if (twist) {
      relative_->R = turned(0.9) * relative_->R;
    } else {
      relative_->p_m.x() += PalmLead::kJump_m + PalmLead::kFastest_m_s * 0.011 + 0.01;
    }
    step();
    EXPECT_EQ(lead_.wish().wish, Arms::HOLD);
    run(0.3);
    EXPECT_FALSE(lead_.leads());
  }
}

TEST_F(PalmLeadTest, WithoutThePalmsPlaceNothingIsLedAndAfterAnEndItMustBeNew) {
  palm_.reset();
  step();
  pull();
  run(0.3);
  EXPECT_FALSE(lead_.leads());
  palm_ = PalmLead::Palm{.pose = {.p_m = {0.1, 0.2, 0.3}}, .heard_ns = now_ns_};
  step();
  ASSERT_TRUE(lead_.leads()) << "the trigger is still held, and nothing moved by it";
  EXPECT_EQ(lead_.wish().p_m, Eigen::Vector3d(0.1, 0.2, 0.3));
  robot_follows_ = false;
  release();
  step();
  const std::int64_t ended_ns = now_ns_;
  pull();
  run(0.5);
  EXPECT_FALSE(lead_.leads()) << "what the robot said of its palm is from before the end";
  palm_->heard_ns = ended_ns + PalmLead::kSettle_ns;
  step();
  EXPECT_TRUE(lead_.leads());
}

TEST_F(PalmLeadTest, HandingBackEndsTheLeadAndStaysUntilTheNextOne) {
  step();
  pull();
  run(0.1);
  ++hand_.hand_backs;
  run(0.2);
  EXPECT_EQ(lead_.wish().wish, Arms::HAND_BACK);
  release();
  run(0.3);
  EXPECT_EQ(lead_.wish().wish, Arms::HAND_BACK);
  pull();
  step();
  EXPECT_EQ(lead_.wish().wish, Arms::AIM);
}

}  // namespace
}  // namespace pmg::vr
