// The reference's way down without the motion generator.
#include "control/fallback_reference.hpp"

#include <gtest/gtest.h>

namespace pmg::control {
namespace {

constexpr double kDt_s = 0.01, kDuration_s = 0.4, kSquat_m = -0.2;

TEST(FallbackReference, GoesEvenlyFromTheLastReferenceToTheSquatAndStaysThere) {
  Reference last;
  last.q = JointVector::LinSpaced(4, -0.3, 0.6);
  last.dq = JointVector::Constant(4, 2.0);
  last.phase = 0.3;
  last.phase_rate_per_s = 1.0;
  last.gain = 0.8;
  last.contact = {true, false};
  last.command[kVx] = 0.5;
  Command observed;
  observed[kVx] = 0.4;
  const JointVector squat_rad = JointVector::Constant(4, 0.9);
  FallbackReference way(kDuration_s);
  way.start(last, observed, squat_rad, kSquat_m);
  JointVector before_rad = last.q;
  const double longest_rad = (squat_rad - last.q).cwiseAbs().maxCoeff();
  for (int k = 1; k <= 40; ++k) {
    const Reference& now = way.advance(kDt_s);
    const JointVector step_rad = now.q - before_rad;
    // The way's mean speed over this tick; ds/dt changes by at most 6 / duration^2 in a second, half of it in half a
    // tick.
    EXPECT_LT((step_rad / kDt_s - now.dq).cwiseAbs().maxCoeff(),
              longest_rad * 6.0 / (kDuration_s * kDuration_s) * 0.5 * kDt_s * 1.01);
    EXPECT_DOUBLE_EQ(now.phase, 0.3);
    EXPECT_EQ(now.phase_rate_per_s, 0.0);
    EXPECT_TRUE(now.contact[0] && now.contact[1]);
    EXPECT_NEAR(now.gain / 0.8, now.command[kVx] / 0.5, 1e-12);
    EXPECT_NEAR(way.observed()[kVx] / 0.4, now.command[kVx] / 0.5, 1e-12);
    before_rad = now.q;
  }
  const Reference& end = way.advance(kDt_s);
  EXPECT_LT((end.q - squat_rad).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(end.dq.cwiseAbs().maxCoeff(), 0.0);
  EXPECT_EQ(end.gain, 0.0);
  EXPECT_EQ(end.command[kVx], 0.0);
  EXPECT_DOUBLE_EQ(end.command[kHeight], kSquat_m);
  EXPECT_DOUBLE_EQ(way.observed()[kHeight], kSquat_m);
}

}  // namespace
}  // namespace pmg::control
