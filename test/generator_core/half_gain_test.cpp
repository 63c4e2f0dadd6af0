// The promises of clips that say how they look at half gain.
#include "pmg/half_gain.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <vector>

#include "generator_core/allocation_count.hpp"
#include "generator_core/synthetic_library.hpp"
#include "pmg/clip_sampling.hpp"

namespace pmg::test {
namespace {

constexpr int kJoints = 7;

/// Half-gain curves that are nowhere near the middle between standing and the clip.
ClipLibrary bent_library(double amplitude = 1.0) {
  LibraryMaker maker(kJoints, 5);
  ClipLibrary library = maker.library();
  for (const std::size_t channel : {std::size_t{kVx}, std::size_t{kVy}}) {
    DynamicClip& clip = *library.positive[channel];
    const DynamicClip other =
        maker.dynamic_clip(library.q_stand, clip.q.size(), clip.period_s, clip.duty_factor[kLeft], channel == kVx);
    for (std::size_t k = 0; k < clip.q.size(); ++k) {
      clip.half_q.push_back(library.q_stand + amplitude * (other.q[k] - library.q_stand));
      clip.half_dq_dphi.push_back(amplitude * other.dq_dphi[k]);
    }
  }
  return library;
}

JointVector sampled(const std::vector<JointVector>& q, const std::vector<JointVector>& dq_dphi, double phase) {
  DynamicClip clip;
  clip.q = q;
  clip.dq_dphi = dq_dphi;
  JointVector at(kJoints), slope(kJoints);
  ClipCurve(clip).sample(phase, at, slope);
  return at;
}

TEST(HalfGain, IsPlayedAtHalfTheClipsSpeedAndTheClipItselfAtAllOfIt) {
  const ClipLibrary library = bent_library();
  const DynamicClip& clip = *library.positive[kVx];
  Generator generator(library, make_options());
  Reference r = run(generator, make_command(0.4, 0, 0), 4.0);
  EXPECT_LT((r.q - sampled(clip.half_q, clip.half_dq_dphi, r.phase)).cwiseAbs().maxCoeff(), 1e-9);
  r = run(generator, make_command(0.8, 0, 0), 4.0);
  EXPECT_LT((r.q - sampled(clip.q, clip.dq_dphi, r.phase)).cwiseAbs().maxCoeff(), 1e-9);
  // The parabola through 0, h and d at a quarter: 3/4 h - d/8.
  r = run(generator, make_command(0.2, 0, 0), 4.0);
  const JointVector expected = library.q_stand +
                               0.75 * (sampled(clip.half_q, clip.half_dq_dphi, r.phase) - library.q_stand) -
                               0.125 * (sampled(clip.q, clip.dq_dphi, r.phase) - library.q_stand);
  EXPECT_LT((r.q - expected).cwiseAbs().maxCoeff(), 1e-9);
  r = run(generator, make_command(0, 0, 0), 4.0);
  EXPECT_LT((r.q - library.q_stand).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(HalfGain, IsWhatAReportOfTheClipAtAGainSees) {
  const ClipLibrary library = bent_library();
  Generator generator(library, make_options());
  const Reference r = run(generator, make_command(0.56, 0, 0), 4.0);
  const DynamicClip at = at_gain(*library.positive[kVx], library.q_stand, 0.7);
  EXPECT_LT((r.q - sampled(at.q, at.dq_dphi, r.phase)).cwiseAbs().maxCoeff(), 1e-9);
}

/// Of what is played with a clip that has none, nothing may change.
TEST(HalfGain, OfOneChannelLeavesTheOthersAlone) {
  const ClipLibrary bent = bent_library();
  ClipLibrary straight = bent;
  for (auto& clip : straight.positive) {
    clip->half_q.clear();
    clip->half_dq_dphi.clear();
  }
  Generator with(bent, make_options()), without(straight, make_options());
  for (const Command& command : {make_command(-0.3, 0, 0), make_command(0, 0, 0.4), make_command(0, 0, -0.4)}) {
    const Reference a = run(with, command, 4.0), b = run(without, command, 4.0);
    EXPECT_LT((a.q - b.q).cwiseAbs().maxCoeff(), 1e-12);
  }
  const Reference a = run(with, make_command(0.4, 0, 0), 4.0), b = run(without, make_command(0.4, 0, 0), 4.0);
  EXPECT_GT((a.q - b.q).cwiseAbs().maxCoeff(), 0.01);
}

TEST(HalfGain, OfOneSideIsMirroredToTheOther) {
  const ClipLibrary library = bent_library();
  const DynamicClip right = mirrored(library.mirror, *library.positive[kVy]);
  Generator generator(library, make_options());
  const Reference r = run(generator, make_command(0, -0.175, 0), 4.0);
  EXPECT_LT((r.q - sampled(right.half_q, right.half_dq_dphi, r.phase)).cwiseAbs().maxCoeff(), 1e-9);
  const DynamicClip& left = *library.positive[kVy];  // 96 samples: half a cycle later is a sample, too
  for (std::size_t k = 0; k < 96; ++k) {
    for (std::size_t i = 0; i < kJoints; ++i) {
      const double expected = library.mirror.sign[i] * left.half_q[(k + 48) % 96][library.mirror.partner[i]];
      EXPECT_NEAR(right.half_q[k][static_cast<Eigen::Index>(i)], expected, 1e-12);
    }
  }
  const DynamicClip twice = mirrored(library.mirror, right);
  for (std::size_t k = 0; k < twice.q.size(); ++k)
    EXPECT_LT((twice.half_q[k] - library.positive[kVy]->half_q[k]).cwiseAbs().maxCoeff(), 1e-12);
}

/// dq_ref is the derivative of q_ref also while gains change.
TEST(HalfGain, HasTheDerivativeOfItsAnglesWhileTheCommandRamps) {
  const ClipLibrary library = bent_library(0.5);
  Generator generator(library, make_options());
  constexpr double kFine_s = 1e-4;
  JointVector before = generator.reference().q;
  double largest = 0.0;
  for (int tick = 0; tick < 20000; ++tick) {
    const Reference& r = generator.step(tick < 12000 ? make_command(0.8, 0.2, 0) : make_command(0, 0, 0), kFine_s);
    if (tick > 0) {
      const JointVector slope = (r.q - before) / kFine_s;
      largest = std::max(largest, (slope - r.dq).cwiseAbs().maxCoeff());
    }
    before = r.q;
  }
  // Of first order in the step: half of it times the acceleration, some 100 rad/s^2 here.
  EXPECT_LT(largest, 0.02);
}

/// Both ends of the parabola fit, its middle does not.
ClipLibrary library_with_little_room() {
  ClipLibrary library = bent_library(3.0);
  library.q_lower = library.q_stand.array() - 0.5;
  library.q_upper = library.q_stand.array() + 0.5;
  return library;
}

TEST(HalfGain, ThatLeavesTheJointsRoomIsScaledToTheMargin) {
  const ClipLibrary library = library_with_little_room();
  const GeneratorOptions options = make_options();
  Generator generator(library, options);
  double least = 1e9;
  bool limited = false;
  for (int tick = 0; tick < 20000; ++tick) {
    const double share = tick < 8000 ? 0.5 : tick < 14000 ? 0.3 : 0.9;
    const Reference& r = generator.step(make_command(0.8 * share, 0, 0), kDt_s);
    if (tick < 500 || (tick >= 14000 && tick < 14500)) continue;  // on the way
    least = std::min({least, (library.q_upper - r.q).minCoeff(), (r.q - library.q_lower).minCoeff()});
    limited = limited || r.command_limited;
    ASSERT_FALSE(r.joint_clamped);
  }
  EXPECT_TRUE(limited);
  // Phases between those of the table may come nearer by 3 mrad.
  EXPECT_GE(least, options.limit_margin_rad - 0.006);
  EXPECT_LE(least, options.limit_margin_rad + 0.02) << "scaled further than the joints need";
}

/// From one end to the other the joints cross a room that hasn't space for them: they take their time, and stay inside.
TEST(HalfGain, NeverMakesAJointJump) {
  const ClipLibrary library = library_with_little_room();
  Generator generator(library, make_options());
  JointVector before = generator.reference().q;
  double fastest_rad_s = 0.0, highest = 0.0;
  for (int tick = 0; tick < 20000; ++tick) {
    const double share = (tick / 500) % 2 == 0 ? 0.95 : 0.2;
    const Reference& r = generator.step(make_command(0.8 * share, 0, 0), kDt_s);
    fastest_rad_s = std::max(fastest_rad_s, (r.q - before).cwiseAbs().maxCoeff() / kDt_s);
    highest = std::max({highest, (r.q - library.q_upper).maxCoeff(), (library.q_lower - r.q).maxCoeff()});
    before = r.q;
  }
  EXPECT_LE(highest, 1e-12);
  EXPECT_LT(fastest_rad_s, 14.0) << "28 where the share jumps";
}

/// Also where the command is scaled down, which takes the longest.
TEST(HalfGain, IsPlayedWithoutTheHeap) {
  PMG_SKIP_IF_HEAP_IS_NOT_COUNTED();
  Generator generator(library_with_little_room(), make_options());
  generator.step(make_command(0.4, 0.1, 0), kDt_s);
  const long before = allocation_count();
  bool limited = false;
  for (int tick = 0; tick < 500; ++tick)
    limited = generator.step(make_command(0.4, 0.1, 0.2), kDt_s).command_limited || limited;
  EXPECT_EQ(allocation_count(), before);
  EXPECT_TRUE(limited);
}

TEST(HalfGain, WithOtherSamplesThanTheClipIsRefused) {
  ClipLibrary library = bent_library();
  library.positive[kVx]->half_q.pop_back();
  EXPECT_THROW(Generator(library, make_options()), std::invalid_argument);
  library = bent_library();
  library.positive[kVx]->half_dq_dphi.pop_back();
  EXPECT_THROW(Generator(library, make_options()), std::invalid_argument);
  library = bent_library();
  library.positive[kVx]->half_q[3][0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Generator(library, make_options()), std::invalid_argument);
}

}  // namespace
}  // namespace pmg::test
