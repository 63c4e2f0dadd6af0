#include "pmg/clip_sampling.hpp"

#include <gtest/gtest.h>

#include "generator_core/synthetic_library.hpp"

namespace pmg::test {
namespace {

class ClipCurveTest : public ::testing::Test {
 protected:
  ClipLibrary library = make_library(31);
  const DynamicClip& clip = *library.positive[kOmega];  // odd number of samples
  ClipCurve curve{clip};
  JointVector q{31}, dq{31}, other_q{31}, other_dq{31};
};

TEST_F(ClipCurveTest, CurvePassesThroughItsSamplesWithTheirSlopes) {
  for (std::size_t k = 0; k < clip.q.size(); ++k) {
    curve.sample(static_cast<double>(k) / static_cast<double>(clip.q.size()), q, dq);
    // 1e-12: k/N is rounded; slopes of 10 rad per cycle turn that into 1e-15 rad and more.
    EXPECT_LT((q - clip.q[k]).cwiseAbs().maxCoeff(), 1e-12) << k;
    EXPECT_LT((dq - clip.dq_dphi[k]).cwiseAbs().maxCoeff(), 1e-10) << k;
  }
}

TEST_F(ClipCurveTest, ValueAndSlopeAreContinuousAcrossEveryKnotAndTheWrap) {
  constexpr double kBeside = 1e-9;
  for (std::size_t k = 0; k < clip.q.size(); ++k) {
    const double phase = static_cast<double>(k) / static_cast<double>(clip.q.size());
    curve.sample(wrap_cycle(phase - kBeside), q, dq);
    curve.sample(phase + kBeside, other_q, other_dq);
    EXPECT_LT((q - other_q).cwiseAbs().maxCoeff(), 1e-7) << k;    // 2e-9 cycles at less than 20 rad per cycle
    EXPECT_LT((dq - other_dq).cwiseAbs().maxCoeff(), 1e-5) << k;  // at less than 1000 rad per cycle^2
  }
}

TEST_F(ClipCurveTest, SlopeIsTheDerivativeOfTheCurve) {
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 997; ++i) {
    const double phase = i / 997.0;
    curve.sample(phase, q, dq);
    JointVector ahead(31), behind(31);
    curve.sample(wrap_cycle(phase + kStep), ahead, other_dq);
    curve.sample(wrap_cycle(phase - kStep), behind, other_dq);
    // Central difference: rounding 1e-16 / 1e-6, and at most 1e-4 from a jump of the second derivative inside the step.
    EXPECT_LT((dq - (ahead - behind) / (2.0 * kStep)).cwiseAbs().maxCoeff(), 1e-4) << phase;
  }
}

TEST_F(ClipCurveTest, SumOfBlendedCurveIsGainTimesCurveAndItsProductRule) {
  curve.sample(0.37, q, dq);
  JointVector sum = JointVector::Constant(31, 0.5), rate = JointVector::Constant(31, -0.25);
  curve.add_blended(curve.segment(0.37), 0.9, 0.6, 0.3, sum, rate);
  EXPECT_LT((sum - (0.6 * q).array().matrix() - JointVector::Constant(31, 0.5)).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_LT((rate - (0.6 * 0.9 * dq + 0.3 * q) - JointVector::Constant(31, -0.25)).cwiseAbs().maxCoeff(), 1e-13);
}

TEST_F(ClipCurveTest, ExtremesBoundTheCurveAndAreReached) {
  JointVector highest, lowest;
  curve.extremes(highest, lowest);
  JointVector seen_high = JointVector::Constant(31, -1e9), seen_low = JointVector::Constant(31, 1e9);
  for (int i = 0; i < 20000; ++i) {
    curve.sample(i / 20000.0, q, dq);
    seen_high = seen_high.cwiseMax(q);
    seen_low = seen_low.cwiseMin(q);
  }
  EXPECT_LE((seen_high - highest).maxCoeff(), 1e-12);
  EXPECT_GE((seen_low - lowest).minCoeff(), -1e-12);
  // The nearest of 20000 phases is at most 2.5e-5 away; with a curvature below 200 rad per cycle^2 that is 1e-7 rad.
  EXPECT_LT((highest - seen_high).maxCoeff(), 1e-6);
  EXPECT_LT((seen_low - lowest).maxCoeff(), 1e-6);
}

TEST(ClipCurve, ExtremesBetweenSamplesAreFound) {
  DynamicClip clip;  // eight samples of a sine, none at its peak
  for (int k = 0; k < 8; ++k) {
    const double angle = 2.0 * std::numbers::pi * (k / 8.0 + 1.0 / 16.0);
    clip.q.push_back(JointVector::Constant(1, std::sin(angle)));
    clip.dq_dphi.push_back(JointVector::Constant(1, 2.0 * std::numbers::pi * std::cos(angle)));
  }
  JointVector highest, lowest;
  ClipCurve(clip).extremes(highest, lowest);
  EXPECT_NEAR(highest[0], 1.0, 2e-3);  // cubic Hermite error h^4/384 f'''' = (pi/4)^4/384
  EXPECT_NEAR(lowest[0], -1.0, 2e-3);
  EXPECT_GT(highest[0], std::sin(2.0 * std::numbers::pi * 3.0 / 16.0) + 0.05);  // the highest sample
}

}  // namespace
}  // namespace pmg::test
