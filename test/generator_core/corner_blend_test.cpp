// Blend::kCorners: combined commands keep their amplitude, single ones follow the paper's formula, and nothing jumps.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "generator_core/synthetic_library.hpp"

namespace pmg::test {
namespace {

constexpr PerDirection<double> kScale = {0.8, 0.5, 0.35, 0.35, 0.8, 0.8};

std::size_t corner(int vx, int vy, int omega) { return corner_of({{vx, vy, omega}}); }

GeneratorOptions corner_options() {
  GeneratorOptions options = make_options();
  options.blend = Blend::kCorners;
  return options;
}

TEST(CornerTable, HoldsEveryPlaceOfTheBoxOnceDirectionsFirst) {
  for (std::size_t c = 0; c < kCorners; ++c) EXPECT_EQ(corner_of(kCornerTable[c]), c);
  for (std::size_t channel = 0; channel < kVelocityChannels; ++channel) {
    for (const bool negative : {false, true}) {
      const Corner& single = kCornerTable[direction_of(channel, negative)];
      for (std::size_t other = 0; other < kVelocityChannels; ++other) {
        EXPECT_EQ(single.sign[other], other != channel ? 0 : negative ? -1 : 1);
      }
    }
  }
}

TEST(CornerBlend, EqualsNumbersWorkedOutByHand) {
  // n = (0.5, 0, 0.25): forward alone 0.5 * 0.75, turn alone 0.5 * 0.25, both 0.5 * 0.25.
  const Mixture m = mix(Blend::kCorners, make_command(0.4, 0.0, -0.2), kScale);
  EXPECT_NEAR(m.gain[corner(1, 0, 0)], 0.375, 1e-15);
  EXPECT_NEAR(m.gain[corner(0, 0, -1)], 0.125, 1e-15);
  EXPECT_NEAR(m.gain[corner(1, 0, -1)], 0.125, 1e-15);
  EXPECT_NEAR(m.gain_sum, 0.625, 1e-15);
  EXPECT_NEAR(m.weight[corner(1, 0, -1)], 0.2, 1e-15);
  EXPECT_FALSE(m.normalised);
  // All three at 60 % of their ranges are just within reach; full ones are scaled down to that.
  for (const double size : {0.6, 1.0}) {
    const Mixture three = mix(Blend::kCorners, make_command(-0.5 * size, 0.35 * size, 0.8 * size), kScale);
    EXPECT_NEAR(three.gain[corner(-1, 1, 1)], 0.216, 1e-12);
    EXPECT_NEAR(three.gain[corner(-1, 1, 0)], 0.144, 1e-12);
    EXPECT_NEAR(three.gain[corner(-1, 0, 0)], 0.096, 1e-12);
    EXPECT_EQ(three.normalised, size == 1.0);
  }
}

TEST(CornerBlend, IsAConvexCombinationThatKeepsTheCommandsDirection) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> any(-2.0, 2.0);
  for (int i = 0; i < 10000; ++i) {
    const Command command = make_command(any(random), i % 3 == 0 ? 0.0 : any(random), any(random));
    const Mixture m = mix(Blend::kCorners, command, kScale);
    double weight_sum = 0.0, gain_sum = 0.0;
    Command given;
    for (std::size_t c = 0; c < kCorners; ++c) {
      ASSERT_GE(m.gain[c], 0.0);
      weight_sum += m.weight[c];
      gain_sum += m.gain[c];
      for (std::size_t channel = 0; channel < kVelocityChannels; ++channel) {
        const int sign = kCornerTable[c].sign[channel];
        if (sign != 0) given.u[channel] += sign * m.gain[c] * kScale[direction_of(channel, sign < 0)];
      }
    }
    ASSERT_NEAR(weight_sum, 1.0, 1e-12);
    ASSERT_NEAR(gain_sum, m.gain_sum, 1e-12);
    ASSERT_LE(gain_sum, 1.0 + 1e-12);
    const double share = given[kVx] / command[kVx];
    ASSERT_LE(share, 1.0 + 1e-12);
    ASSERT_EQ(m.normalised, share < 1.0 - 1e-12);
    for (std::size_t channel = 0; channel < kVelocityChannels; ++channel) {
      ASSERT_NEAR(given.u[channel], share * command.u[channel], 1e-12);
    }
  }
}

TEST(CornerBlend, OneChannelAloneIsThePapersFormula) {
  const ClipLibrary library = make_library(31);
  Generator generator(library, corner_options());
  const Reference r = run(generator, make_command(0.4, 0.0, 0.0), 4.0);
  JointVector q(31), dq(31);
  ClipCurve(*library.positive[kVx]).sample(r.phase, q, dq);
  EXPECT_LT((r.q - (0.5 * q + 0.5 * library.q_stand)).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_NEAR(r.command[kVx], 0.4, 1e-12);
  EXPECT_FALSE(r.command_limited);
}

TEST(CornerBlend, CombinedCommandsAreGivenInFull) {
  Generator corners(make_library(31), corner_options());
  const Reference both = run(corners, make_command(0.64, 0.0, 0.64), 5.0);
  EXPECT_NEAR(both.command[kVx], 0.64, 1e-12);
  EXPECT_NEAR(both.command[kOmega], 0.64, 1e-12);
  EXPECT_FALSE(both.command_limited);
  const Reference beyond = run(corners, make_command(0.8, 0.0, 0.8), 5.0);
  EXPECT_NEAR(beyond.command[kVx], 0.72, 1e-12);
  EXPECT_NEAR(beyond.command[kOmega], 0.72, 1e-12);
  EXPECT_TRUE(beyond.command_limited);
}

TEST(CornerBlend, ACornersOwnClipIsPlayedThereAndMirroredOnTheOtherSide) {
  ClipLibrary library = make_library(31);
  LibraryMaker maker(31, 77);
  const DynamicClip circle = maker.dynamic_clip(library.q_stand, 100, 1.14, 0.61, false);
  library.corners = {{{1, 0, 1}, circle}};
  for (const double side : {1.0, -1.0}) {
    Generator generator(library, corner_options());
    const double n = 0.9;
    const Reference r = run(generator, make_command(0.8 * n, 0.0, side * 0.8 * n), 5.0);
    const auto at = [&](const DynamicClip& clip) {
      JointVector q(31), dq(31);
      ClipCurve(clip).sample(r.phase, q, dq);
      return q;
    };
    const DynamicClip& turn = *library.positive[kOmega];
    const JointVector expected =
        n * n * at(side > 0 ? circle : mirrored(library.mirror, circle)) +
        n * (1.0 - n) * (at(*library.positive[kVx]) + at(side > 0 ? turn : mirrored(library.mirror, turn))) +
        (1.0 - n) * (1.0 - n) * library.q_stand;
    EXPECT_LT((r.q - expected).cwiseAbs().maxCoeff(), 1e-12) << side;
  }
}

/// Two joints: one swings with the direction's sign, the other lifts the foot equally in every direction.
ClipLibrary striding_and_lifting() {
  ClipLibrary library;
  library.q_stand.setZero(2);
  library.q_lower.setConstant(2, -3.0);
  library.q_upper.setConstant(2, 3.0);
  library.mirror = {{0, 1}, {1.0, 1.0}};
  const auto clip = [](double stride) {
    DynamicClip made;
    for (int k = 0; k < 100; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / 100.0;
      made.q.push_back(JointVector(Eigen::Vector2d(stride * std::cos(angle), 0.3 + 0.3 * std::sin(angle))));
      made.dq_dphi.push_back(
          JointVector(2.0 * std::numbers::pi * Eigen::Vector2d(-stride * std::sin(angle), 0.3 * std::cos(angle))));
    }
    made.duty_factor = {0.6, 0.6};
    made.contact_center = {0.3, 0.8};
    made.period_s = 1.0;
    return made;
  };
  for (std::size_t channel = 0; channel < kVelocityChannels; ++channel) {
    const double stride = 0.2 + 0.1 * static_cast<double>(channel);
    library.positive[channel] = clip(stride);
    library.negative[channel] = clip(-stride);
  }
  return library;
}

TEST(Superposition, StridesAddUpAndTheLiftIsSharedByTwoAndByThree) {
  PerCorner<std::optional<DynamicClip>> clips;
  const ClipLibrary library = striding_and_lifting();
  for (std::size_t channel = 0; channel < kVelocityChannels; ++channel) {
    clips[direction_of(channel, false)] = library.positive[channel];
    clips[direction_of(channel, true)] = library.negative[channel];
  }
  add_corner_clips(library, clips);
  const double lift = 0.3 + 0.3;  // at a quarter of the cycle
  EXPECT_NEAR(clips[corner(1, 0, 1)]->q[0][0], 0.2 + 0.4, 1e-12);
  EXPECT_NEAR(clips[corner(1, 0, 1)]->q[25][1], lift, 1e-12);
  EXPECT_NEAR(clips[corner(-1, 1, 0)]->q[0][0], -0.2 + 0.3, 1e-12);
  EXPECT_NEAR(clips[corner(1, 1, 1)]->q[0][0], 0.2 + 0.3 + 0.4, 1e-12);
  EXPECT_NEAR(clips[corner(1, 1, 1)]->q[25][1], lift, 1e-12);
  // A made clip's slopes are the derivative of its samples.
  for (const std::size_t c : {corner(1, 0, 1), corner(1, 1, 1)}) {
    const DynamicClip& made = *clips[c];
    for (int joint = 0; joint < 2; ++joint) {
      EXPECT_NEAR(made.dq_dphi[10][joint], (made.q[11][joint] - made.q[9][joint]) * 50.0, 0.01);
    }
  }
}

TEST(CornerBlend, ACompletedLibraryWalksTheSame) {
  ClipLibrary library = make_library(31);
  library.blend = Blend::kCorners;
  const ClipLibrary completed = Generator::completed(library);
  EXPECT_EQ(completed.corners.size(), kCorners - kDirections);
  GeneratorOptions options = make_options();
  Generator a(library, options), b(completed, options);
  const Command command = make_command(0.48, -0.21, 0.48);
  EXPECT_EQ(run(a, command, 3.0).q, run(b, command, 3.0).q);
}

TEST(CornerBlend, WithoutABackwardClipThereIsNoBackwardCorner) {
  ClipLibrary library = make_library(31);
  library.negative[kVx].reset();
  Generator generator(library, corner_options());
  const Reference r = run(generator, make_command(-0.4, 0.0, 0.4), 4.0);
  EXPECT_EQ(r.command[kVx], 0.0);
  EXPECT_NEAR(r.command[kOmega], 0.4, 1e-12);
}

}  // namespace
}  // namespace pmg::test
