#include "control/entry_ramp.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "control/fixtures.hpp"

namespace pmg::control {
namespace {

using test::kTick_s;

JointVector two(double a, double b) {
  JointVector q(2);
  q << a, b;
  return q;
}

TEST(EntryRamp, StartsAtTheMeasuredPostureAndEndsAtTheWantedOne) {
  EntryRamp ramp({.speed_rad_s = 0.5, .shortest_s = 0.5, .longest_s = 5.0});
  const JointVector measured = two(-1.0, 0.2), wanted = two(0.5, 0.1);
  ramp.start(measured, wanted);
  EXPECT_DOUBLE_EQ(ramp.duration_s(), 3.0) << "1.5 rad at 0.5 rad/s";
  JointVector previous = measured;
  int ticks = 0;
  while (!ramp.done()) {
    JointVector q = wanted;
    ramp.apply(kTick_s, q);
    // A smooth step is at most 1.5 times as fast as its mean.
    EXPECT_LE((q - previous).cwiseAbs().maxCoeff(), 1.5 * 0.5 * kTick_s + 1e-12);
    previous = q;
    ASSERT_LE(++ticks, 301);
  }
  EXPECT_LT((previous - wanted).cwiseAbs().maxCoeff(), 1e-12);
  JointVector q = two(7.0, 8.0);
  ramp.apply(kTick_s, q);
  EXPECT_EQ(q, two(7.0, 8.0)) << "afterwards it leaves targets alone";
}

TEST(EntryRamp, TakesItsTimeButNotForEver) {
  EntryRamp ramp({.speed_rad_s = 0.5, .shortest_s = 0.5, .longest_s = 5.0});
  ramp.start(two(0.0, 0.0), two(0.0, 0.0));
  EXPECT_DOUBLE_EQ(ramp.duration_s(), 0.5);
  ramp.start(two(0.0, 0.0), two(9.0, 0.0));
  EXPECT_DOUBLE_EQ(ramp.duration_s(), 5.0);
}

}  // namespace
}  // namespace pmg::control
