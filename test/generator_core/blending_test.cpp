#include "pmg/blending.hpp"

#include <gtest/gtest.h>

#include "generator_core/synthetic_library.hpp"

namespace pmg::test {
namespace {

PerDirection<std::optional<DynamicClip>> signed_clips(const ClipLibrary& library) {
  PerDirection<std::optional<DynamicClip>> clips;
  for (std::size_t channel = 0; channel < kVelocityChannels; ++channel) {
    clips[direction_of(channel, false)] = library.positive[channel];
    clips[direction_of(channel, true)] =
        library.negative[channel] ? *library.negative[channel] : mirrored(library.mirror, *library.positive[channel]);
  }
  return clips;
}

TEST(Blending, OneChannelAloneIsThePapersFormula) {
  const ClipLibrary library = make_library(31);
  const auto clips = signed_clips(library);
  const GeneratorOptions options = make_options();
  for (std::size_t d = 0; d < kDirections; ++d) {
    const std::size_t channel = d / 2;
    const double scale = d % 2 == 0 ? options.scale_positive[channel] : options.scale_negative[channel];
    for (const double alpha : {0.1, 0.5, 1.0}) {
      Generator generator(library, options);
      Command command;
      command.u[channel] = (d % 2 == 0 ? alpha : -alpha) * scale;
      const Reference r = run(generator, command, 4.0);
      JointVector q(31), dq(31);
      ClipCurve(*clips[d]).sample(r.phase, q, dq);
      EXPECT_LT((r.q - (alpha * q + (1.0 - alpha) * library.q_stand)).cwiseAbs().maxCoeff(), 1e-12);
      EXPECT_LT((r.dq - alpha / clips[d]->period_s * dq).cwiseAbs().maxCoeff(), 1e-10);
      EXPECT_NEAR(r.phase_rate_per_s, 1.0 / clips[d]->period_s, 1e-12);
      EXPECT_NEAR(r.gain, alpha, 1e-12);
      EXPECT_NEAR(r.command.u[channel], command.u[channel], 1e-12);
      EXPECT_FALSE(r.command_limited);
    }
  }
}

TEST(Blending, MixturesKeepTheirAmplitudeUntilTheyFillOneWholeGait) {
  const PerDirection<double> scale = {0.8, 0.5, 0.35, 0.35, 0.8, 0.8};
  const Mixture small = mix(Blend::kGain, make_command(0.4, -0.07, 0.08), scale);
  EXPECT_NEAR(small.gain[0], 0.5, 1e-15);
  EXPECT_NEAR(small.gain[3], 0.2, 1e-15);
  EXPECT_NEAR(small.gain[4], 0.1, 1e-15);
  EXPECT_NEAR(small.gain_sum, 0.8, 1e-15);
  EXPECT_FALSE(small.normalised);

  const Mixture large = mix(Blend::kGain, make_command(0.8, -0.35, 0.4), scale);  // n = 1, 1, 0.5
  EXPECT_NEAR(large.gain[0], 0.4, 1e-15);
  EXPECT_NEAR(large.gain[3], 0.4, 1e-15);
  EXPECT_NEAR(large.gain[4], 0.2, 1e-15);
  EXPECT_NEAR(large.gain_sum, 1.0, 1e-15);
  EXPECT_TRUE(large.normalised);
}

TEST(Blending, GainsNeverSumToMoreThanOne) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> any(-3.0, 3.0);
  for (int i = 0; i < 10000; ++i) {
    for (const Blend blend : {Blend::kGain, Blend::kPaper}) {
      const Mixture m =
          mix(blend, make_command(any(random), any(random), any(random)), {0.8, 0.5, 0.35, 0.35, 0.8, 0.8});
      ASSERT_LE(m.gain_sum, 1.0 + 1e-12);
      double weight_sum = 0.0;
      for (std::size_t c = 0; c < m.size; ++c) weight_sum += m.weight[c];
      ASSERT_NEAR(weight_sum, 1.0, 1e-12);
    }
  }
}

/// One joint, held at one angle by each clip: the blend is arithmetic on four numbers.
ClipLibrary constant_library() {
  ClipLibrary library;
  library.q_stand.setConstant(1, 0.1);
  library.q_lower.setConstant(1, -3.0);
  library.q_upper.setConstant(1, 3.0);
  library.mirror = {{0}, {-1.0}};
  const std::array<double, 3> angle = {1.0, -0.5, 0.25}, period_s = {1.0, 1.2, 1.4}, duty = {0.60, 0.64, 0.56};
  for (std::size_t channel = 0; channel < 3; ++channel) {
    DynamicClip clip;
    clip.q.assign(8, JointVector::Constant(1, angle[channel]));
    clip.dq_dphi.assign(8, JointVector::Zero(1));
    clip.period_s = period_s[channel];
    clip.duty_factor = {duty[channel], duty[channel]};
    clip.contact_center = {0.30, 0.80};
    library.positive[channel] = clip;
  }
  return library;
}

TEST(Blending, PaperBlendEqualsNumbersWorkedOutByHand) {
  GeneratorOptions options = make_options();
  options.blend = Blend::kPaper;
  options.scale_positive = {0.8, 0.4, 0.5};
  Generator generator(constant_library(), options);
  // u = (0.4, 0.1, 0): alpha = (0.4 / 0.8, 0.1 / 0.4) = (0.5, 0.25).
  // Interpolated motions: 0.5 * 1.0 + 0.5 * 0.1 = 0.55 and 0.25 * (-0.5) + 0.75 * 0.1 = -0.05.
  // w = (0.4, 0.1) / 0.500001 = (0.7999984000, 0.1999996000); the rest 1 - sum w = 1.999996e-6 goes to stand.
  // q_d = 0.7999984000 * 0.55 + 0.1999996000 * (-0.05) + 1.999996e-6 * 0.1 = 0.42999934
  const Reference r = run(generator, make_command(0.4, 0.1, 0.0), 4.0);
  EXPECT_NEAR(r.q[0], 0.42999934, 1e-9);
  // T = 0.8 * 1.0 + 0.2 * 1.2 = 1.04 s, r = 0.8 * 0.60 + 0.2 * 0.64 = 0.608, with weights w / sum w.
  EXPECT_NEAR(r.phase_rate_per_s, 1.0 / 1.04, 1e-9);
  EXPECT_NEAR(r.duty_factor[kLeft], 0.608, 1e-9);
  // A third channel: u = (0.4, 0.1, 0.5), alpha_omega = 1, motion 0.25; w = (0.4, 0.1, 0.5) / 1.000001.
  // q_d = (0.4 * 0.55 + 0.1 * (-0.05) + 0.5 * 0.25) / 1.000001 + 9.99999e-7 * 0.1 = 0.33999976
  EXPECT_NEAR(run(generator, make_command(0.4, 0.1, 0.5), 4.0).q[0], 0.33999976, 1e-9);
}

TEST(Blending, PaperBlendAtZeroIsTheStandingPostureNotTheZeroPosture) {
  GeneratorOptions options = make_options();
  options.blend = Blend::kPaper;
  Generator generator(constant_library(), options);
  run(generator, make_command(0.4, 0.0, 0.0), 2.0);
  const Reference r = run(generator, Command{}, 2.0);
  EXPECT_EQ(r.q[0], 0.1);
  EXPECT_EQ(r.gain, 0.0);
}

TEST(GaitTimings, AverageWithTheirWeightsAndOnTheCircle) {
  const ClipLibrary library = constant_library();
  PerCorner<std::optional<DynamicClip>> clips;
  clips[0] = library.positive[kVx];
  clips[2] = library.positive[kVy];
  clips[0]->contact_center = {0.98, 0.48};
  clips[2]->contact_center = {0.06, 0.52};
  const GaitTiming mean = GaitTimings(clips).average({0.75, 0.0, 0.25, 0.0, 0.0, 0.0});
  EXPECT_NEAR(mean.period_s, 1.05, 1e-12);
  EXPECT_NEAR(mean.duty_factor[kLeft], 0.61, 1e-12);
  EXPECT_NEAR(wrap_half_cycle(mean.contact_center[kLeft]), 0.0, 1e-12);  // 0.98 + 0.25 * 0.08, not 0.75
  EXPECT_NEAR(mean.contact_center[kRight], 0.49, 1e-12);
}

}  // namespace
}  // namespace pmg::test
