// Who may lead the arms, with what, and for how long.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "control/command_intake.hpp"

namespace pmg::control {
namespace {

using ArmsVerdict = CommandIntake::DriveVerdict;

constexpr std::int64_t kOneSecond_ns = 1'000'000'000;
constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN(),
                 kInfinite = std::numeric_limits<double>::infinity();

class ArmsIntake : public testing::Test {
 protected:
  ArmsVerdict drive(const char* source, std::int64_t now_ns, double lease_s = 2.0) {
    return intake_.accept(DriveMessage{.source = Source::make(source, 1),
                                       .sequence = ++driven_,
                                       .stamp_ns = now_ns,
                                       .received_ns = now_ns,
                                       .lease_s = lease_s,
                                       .command = {}},
                          now_ns);
  }
  static ArmsMessage message(const char* source, std::int64_t sequence, std::int64_t now_ns, double lease_s = 0.3) {
    ArmsMessage arms{.source = Source::make(source, 1),
                     .sequence = sequence,
                     .stamp_ns = now_ns,
                     .received_ns = now_ns,
                     .lease_s = lease_s};
    arms.arm[kLeft] = {.wish = ArmWish::kAim, .palm = {.p_m = {0.3, 0.2, 0.1}}};
    return arms;
  }
  ArmsVerdict arms(const char* source, std::int64_t sequence, std::int64_t now_ns, double lease_s = 0.3) {
    return intake_.accept(message(source, sequence, now_ns, lease_s), now_ns);
  }

  CommandIntake intake_;
  std::int64_t driven_ = 0;
};

TEST_F(ArmsIntake, OnlyTheDrivingSourceLeadsAndEverybodyElseIsCounted) {
  EXPECT_EQ(arms("vr", 1, 0), ArmsVerdict::kOtherSourceDrives) << "nobody drives";
  drive("vr", 0);
  EXPECT_EQ(arms("vr", 1, 1), ArmsVerdict::kOutOfOrder) << "what was refused isn't taken later";
  EXPECT_EQ(arms("vr", 2, 1), ArmsVerdict::kAccepted);
  EXPECT_EQ(arms("page", 1, 2), ArmsVerdict::kOtherSourceDrives);
  ArmsMessage successor = message("vr", 2, 3);
  successor.source.session = 2;
  EXPECT_EQ(intake_.accept(successor, 3), ArmsVerdict::kOtherSourceDrives) << "the same name is not the same operator";
  EXPECT_EQ(intake_.ignored().other_source, 3);
  EXPECT_EQ(intake_.arms_refused(), 4);
  EXPECT_EQ(intake_.arms_refusal(), ArmsVerdict::kOtherSourceDrives);
  EXPECT_EQ(intake_.arms_order(3), ArmsOrder::kInForce);
  EXPECT_EQ(intake_.arms().source, Source::make("vr", 1));
}

TEST_F(ArmsIntake, ATargetIsInForceForItsLeaseAndForHalfASecondAtMost) {
  drive("vr", 0);
  EXPECT_EQ(intake_.arms_order(0), ArmsOrder::kNoneCame);
  arms("vr", 1, 0, 0.1);
  EXPECT_EQ(intake_.arms_order(kOneSecond_ns / 10 - 1), ArmsOrder::kInForce);
  EXPECT_EQ(intake_.arms_order(kOneSecond_ns / 10), ArmsOrder::kLeaseOver);
  arms("vr", 2, kOneSecond_ns, 1e9);
  EXPECT_EQ(intake_.arms_order(kOneSecond_ns + kOneSecond_ns / 2 - 1), ArmsOrder::kInForce);
  EXPECT_EQ(intake_.arms_order(kOneSecond_ns + kOneSecond_ns / 2), ArmsOrder::kLeaseOver);
  EXPECT_EQ(arms("vr", 3, kOneSecond_ns, 0.0), ArmsVerdict::kNoLease);
  EXPECT_EQ(arms("vr", 4, kOneSecond_ns, kNoNumber), ArmsVerdict::kNoLease);
}

TEST_F(ArmsIntake, WhoNoLongerDrivesNoLongerLeads) {
  drive("vr", 0, 0.1);
  arms("vr", 1, 0, 0.5);
  EXPECT_EQ(intake_.arms_order(kOneSecond_ns / 10), ArmsOrder::kNoneCame) << "the driver's own lease is over";
  drive("gamepad", kOneSecond_ns / 10);
  EXPECT_EQ(intake_.arms_order(kOneSecond_ns / 10), ArmsOrder::kNoneCame) << "the next driver inherits no target";
}

TEST_F(ArmsIntake, RepeatedOvertakenAndLateTargetsAreRefused) {
  drive("vr", 0);
  EXPECT_EQ(arms("vr", 5, 0), ArmsVerdict::kAccepted);
  EXPECT_EQ(arms("vr", 5, 1), ArmsVerdict::kOutOfOrder);
  EXPECT_EQ(arms("vr", 4, 2), ArmsVerdict::kOutOfOrder);
  ArmsMessage late = message("vr", 6, kOneSecond_ns / 2);
  late.stamp_ns -= 210'000'000;
  EXPECT_EQ(intake_.accept(late, kOneSecond_ns / 2), ArmsVerdict::kLate);
  EXPECT_EQ(intake_.arms_order(kOneSecond_ns / 2), ArmsOrder::kLeaseOver) << "none of them is a sign of life";
  EXPECT_EQ(arms("vr", 7, kOneSecond_ns / 2), ArmsVerdict::kAccepted);
  EXPECT_EQ(drive("vr", kOneSecond_ns / 2), ArmsVerdict::kAccepted) << "commands have numbers of their own";
}

TEST_F(ArmsIntake, WhatIsNoPoseOfAPalmIsRefused) {
  drive("vr", 0);
  std::int64_t number = 0;
  const auto spoilt = [&](const char* what, const std::function<void(ArmTarget&)>& spoil) {
    for (const Foot arm : {kLeft, kRight}) {
      ArmsMessage one = message("vr", ++number, 0);
      one.arm[kRight] = one.arm[kLeft];
      spoil(one.arm[arm]);
      EXPECT_EQ(intake_.accept(one, 0), ArmsVerdict::kNotFinite) << what;
    }
  };
  for (const double bad : {kNoNumber, kInfinite, -kInfinite, 1e300, 10.001, -10.001}) {
    for (int axis = 0; axis < 3; ++axis) spoilt("position", [&](ArmTarget& target) { target.palm.p_m[axis] = bad; });
  }
  for (const double bad : {kNoNumber, kInfinite, 1e300, 0.1}) {
    for (int i = 0; i < 3; ++i) spoilt("orientation", [&](ArmTarget& target) { target.palm.R.coeffs()[i] = bad; });
  }
  spoilt("zero quaternion", [](ArmTarget& target) { target.palm.R.coeffs().setZero(); });
  spoilt("length 1.01", [](ArmTarget& target) { target.palm.R.coeffs() *= 1.01; });
  EXPECT_EQ(intake_.arms_order(0), ArmsOrder::kNoneCame);
  EXPECT_EQ(intake_.ignored().not_finite, intake_.arms_refused());

  ArmsMessage rounded = message("vr", ++number, 0);
  rounded.arm[kLeft].palm.R.coeffs() *= 1.0 + 1e-4;  // four decimals, as a person types them
  EXPECT_EQ(intake_.accept(rounded, 0), ArmsVerdict::kAccepted);
  ArmsMessage held = message("vr", ++number, 0);
  held.arm[kLeft] = {.wish = ArmWish::kHold, .palm = {.p_m = {kNoNumber, kNoNumber, kNoNumber}}};
  EXPECT_EQ(intake_.accept(held, 0), ArmsVerdict::kAccepted) << "a pose that isn't asked for doesn't count";
}

TEST_F(ArmsIntake, LeadingArmsIsMotionThatNobodyTakesOver) {
  const auto walk = [&](std::int64_t now_ns) {
    return intake_.judge({.source = Source::make("page", 1),
                          .sequence = now_ns,
                          .stamp_ns = now_ns,
                          .received_ns = now_ns,
                          .mode = Mode::kWalk},
                         now_ns);
  };
  for (std::int64_t k = 0; k <= 80; ++k) {
    const std::int64_t now_ns = k * kOneSecond_ns / 20;
    drive("vr", now_ns);
    ArmsMessage moving = message("vr", k + 1, now_ns);
    moving.arm[kLeft].palm.p_m.x() += 1e-3 * static_cast<double>(k);
    intake_.accept(moving, now_ns);
  }
  EXPECT_EQ(walk(4 * kOneSecond_ns).verdict, Verdict::kNotYours);
  for (std::int64_t k = 81; k <= 141; ++k) {
    const std::int64_t now_ns = k * kOneSecond_ns / 20;
    drive("vr", now_ns);
    ArmsMessage still = intake_.arms();
    still.sequence = k + 1;
    still.stamp_ns = still.received_ns = now_ns;
    intake_.accept(still, now_ns);
  }
  EXPECT_TRUE(walk(141 * kOneSecond_ns / 20).fresh) << "a target that stays where it is only renews";
}

}  // namespace
}  // namespace pmg::control
