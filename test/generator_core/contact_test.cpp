#include "pmg/contact.hpp"

#include <gtest/gtest.h>

namespace pmg::test {
namespace {

constexpr double kEdge = 0.04;

TEST(Contact, HoldsWithinHalfTheDutyFactorOfItsCentreAcrossTheWrap) {
  EXPECT_TRUE(in_contact(0.0, 0.3, 0.6));
  EXPECT_TRUE(in_contact(0.6 - 1e-12, 0.3, 0.6));
  EXPECT_FALSE(in_contact(0.601, 0.3, 0.6));
  EXPECT_FALSE(in_contact(0.999, 0.3, 0.6));
  EXPECT_TRUE(in_contact(0.05, 0.8, 0.6));
  EXPECT_FALSE(in_contact(0.15, 0.8, 0.6));
  for (int i = 0; i < 1000; ++i) EXPECT_TRUE(in_contact(i / 1000.0, 0.8, 1.0));
}

TEST(ContactWeight, HasCosineEdgesInsideTheStance) {
  for (const double boundary : {0.1, 0.5}) {  // mu = 0.3, r = 0.4
    const double inwards = boundary < 0.3 ? 1.0 : -1.0;
    EXPECT_NEAR(contact_weight(boundary, 0.3, 0.4, kEdge), 0.0, 1e-12);
    EXPECT_NEAR(contact_weight(boundary + inwards * 0.02, 0.3, 0.4, kEdge), 0.5, 1e-12);
    EXPECT_NEAR(contact_weight(boundary + inwards * 0.03, 0.3, 0.4, kEdge), 0.5 + std::sqrt(0.125), 1e-12);
    EXPECT_NEAR(contact_weight(boundary + inwards * 0.04, 0.3, 0.4, kEdge), 1.0, 1e-12);
    EXPECT_EQ(contact_weight(boundary - inwards * 1e-3, 0.3, 0.4, kEdge), 0.0);
  }
  EXPECT_EQ(contact_weight(0.3, 0.3, 0.4, kEdge), 1.0);
  EXPECT_EQ(contact_weight(0.8, 0.3, 0.4, kEdge), 0.0);
}

TEST(ContactWeight, IsPositiveOnlyForAFootInContactWhileWalking) {
  for (const double r : {0.5, 0.6, 0.85}) {
    for (int i = 0; i < 1000; ++i) {
      if (contact_weight(i / 1000.0, 0.3, r, kEdge) == 0.0) continue;
      EXPECT_TRUE(in_contact(i / 1000.0, 0.3, r)) << r << " " << i;
    }
  }
}

TEST(ContactWeight, StaysOneWhereTheFootNeverLeavesTheGround) {
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(contact_weight(i / 1000.0, 0.8, 1.0, kEdge), 1.0);
}

TEST(ContactWeight, IsContinuousInPhaseAndInDutyFactor) {
  // The slope of a cosine edge over its boundary is at most pi / 2 / width. The boundary moves with r by at most 1: by
  // 0.5, and by 0.5 more where it moves outwards.
  constexpr double kSteepest = 0.5 * 3.1416 / kEdge;
  constexpr double kStep = 1e-4;
  for (double r = 0.5; r + kStep <= 1.0; r += 10 * kStep) {
    for (double phase = 0.0; phase < 1.0; phase += 10 * kStep) {
      const double here = contact_weight(phase, 0.3, r, kEdge);
      ASSERT_LE(std::abs(contact_weight(wrap_cycle(phase + kStep), 0.3, r, kEdge) - here), kSteepest * kStep);
      ASSERT_LE(std::abs(contact_weight(phase, 0.3, r + kStep, kEdge) - here), kSteepest * kStep);
    }
  }
  for (double phase = 0.0; phase < 1.0; phase += kStep) {  // also the last step to r = 1
    ASSERT_GE(contact_weight(phase, 0.3, 1.0 - kStep, kEdge), 1.0 - kSteepest * kStep);
  }
}

TEST(StanceRamp, TakesItsTimeBothWays) {
  StanceRamp ramp;
  ramp.reset();
  EXPECT_EQ(ramp.standing(), 1.0);
  ramp.step(false, 0.2, 0.05);
  EXPECT_NEAR(ramp.standing(), 0.75, 1e-12);
  for (int i = 0; i < 10; ++i) ramp.step(false, 0.2, 0.05);
  EXPECT_EQ(ramp.standing(), 0.0);
  ramp.step(true, 0.2, 0.05);
  EXPECT_NEAR(ramp.standing(), 0.25, 1e-12);
  ramp.step(true, 0.0, 0.05);
  EXPECT_EQ(ramp.standing(), 1.0);
}

}  // namespace
}  // namespace pmg::test
