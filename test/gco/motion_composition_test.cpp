// The three policies of Table I: what each imitates and observes, and that they differ in nothing else.
#include "gco/motion_composition.hpp"

#include <gtest/gtest.h>

#include "folders.hpp"
#include "model/clip_library_file.hpp"

namespace pmg::gco {
namespace {

const model::RobotModel& z1() {
  static const model::RobotModel robot = model::load_robot(pmg::test::project_folder() + "/config/robots/z1");
  return robot;
}

/// The committed clips without their inverse: tests bring their own.
ClipLibrary clips() {
  ClipLibrary library = model::load_clip_library(z1().directory / "clips", z1());
  library.inverse = {};
  return library;
}

MotionComposition composition(Variant variant, const ClipLibrary& library = clips()) {
  return {z1(), library, variant, generator_options(z1())};
}

/// Steps at a constant command, long enough for every rate limit.
void settle(MotionComposition& motion, const Command& user, int ticks = 400) {
  for (int k = 0; k < ticks; ++k) {
    motion.advance(user, 0.01);
    motion.ground();
  }
}

const Command kTurning{{0.2, 0.1, 0.3, 0.1, 0.05, -0.04}};

TEST(MotionComposition, WithoutGcoImitatesTheSameAndObservesTheAdmissibleCommand) {
  MotionComposition pmg = composition(Variant::kPmg), without = composition(Variant::kWithoutGco);
  double largest = 0.0;
  for (int k = 0; k < 300; ++k) {
    const Reference& reference = pmg.advance(kTurning, 0.01);
    ASSERT_EQ(without.advance(kTurning, 0.01).q, reference.q);
    ASSERT_EQ(without.reference().dq, reference.dq);
    ASSERT_EQ(without.ground().command, reference.command);
    ASSERT_EQ(without.ground().status, Status::kNotAsked);
    largest = std::max(largest, std::abs(pmg.ground().command[kVx] - reference.command[kVx]));
  }
  EXPECT_GT(largest, 0.02) << "u' must differ from u, or there is nothing to compare";
}

TEST(MotionComposition, OfAPolicyThatStepsByItselfStandsAndTellsTheVelocitiesWithinLimits) {
  ClipLibrary library;  // of a standing posture alone
  library.q_stand = z1().q_stand();
  library.q_lower = z1().q_lower();
  library.q_upper = z1().q_upper();
  library.mirror = z1().mirror;
  GeneratorOptions options = generator_options(z1());
  for (const Channel channel : {kPitch, kRoll, kHeight})
    options.limits.lower[channel] = options.limits.upper[channel] = 0.0;
  MotionComposition motion(z1(), library, Variant::kVelocity, options);
  const Command fast{{9.0, -0.1, 0.0, 0.1, 0.0, -0.1}};
  Command before;
  for (int k = 0; k < 300; ++k) {
    const Reference& reference = motion.advance(fast, 0.01);
    ASSERT_EQ(reference.q, library.q_stand);
    ASSERT_EQ(reference.dq.norm(), 0.0);
    ASSERT_LE(reference.command[kVx] - before[kVx], options.limits.rate_per_s[kVx] * 0.01 + 1e-12);
    ASSERT_NEAR(reference.command_rate[kVx], (reference.command[kVx] - before[kVx]) / 0.01, 1e-9);
    ASSERT_TRUE(reference.command_limited);
    before = reference.command;
    ASSERT_EQ(motion.ground().command, before);
  }
  EXPECT_EQ(before[kVx], options.limits.upper[kVx]);
  EXPECT_EQ(before[kVy], -0.1);
  EXPECT_EQ(before[kHeight], 0.0);
  EXPECT_EQ(motion.reference().gain, 1.0);
  settle(motion, {}, 50);
  EXPECT_EQ(motion.reference().command, Command{});
  EXPECT_EQ(motion.reference().gain, 0.0) << "at rest";
}

TEST(MotionComposition, ASingleGaitPlaysTheForwardClipWhateverIsAskedAndObservesThat) {
  MotionComposition pmg = composition(Variant::kPmg), single = composition(Variant::kSingleGait);
  settle(pmg, kTurning);
  settle(single, kTurning);
  EXPECT_EQ(single.ground().command, pmg.reference().command) << "all six channels";
  EXPECT_NEAR(single.reference().gain, pmg.reference().gain, 1e-12) << "as strongly as the command is large";

  MotionComposition forward = composition(Variant::kWithoutGco);
  Command straight;
  straight[kVx] = single.reference().gain * z1().velocity_scale_positive[kVx];
  settle(forward, straight);
  // Both play the forward clip with this amplitude, but may have begun to walk at different times.
  bool met = false;
  for (int k = 0; k < 200 && !met; ++k) {
    const Reference& alone = forward.advance(straight, 0.01);
    met = std::abs(alone.phase - single.reference().phase) < 0.005 &&
          (alone.q - single.reference().q).cwiseAbs().maxCoeff() < 0.02;  // half a tick of 4 rad/s
  }
  EXPECT_TRUE(met);
}

TEST(MotionComposition, ASingleGaitStandsUprightWhenOnlyAPostureIsAsked) {
  MotionComposition single = composition(Variant::kSingleGait);
  settle(single, Command{{0.0, 0.0, 0.0, 0.2, 0.1, -0.08}});
  EXPECT_EQ(single.reference().q, z1().q_stand());
  EXPECT_EQ(single.ground().command, (Command{{0.0, 0.0, 0.0, 0.2, 0.1, -0.08}})) << "but is rewarded for the posture";
}

TEST(MotionComposition, OnlyPmgAsksTheClipsForWhatTheInverseSays) {
  ClipLibrary library = clips();
  library.inverse = CommandInverse({{{0.0}, {0.0}, {0.0}, {0.0}}}, {{0.05, -0.02, 0.04, -0.01}});
  const Command corrected = library.inverse.apply(kTurning);
  for (const Variant variant : {Variant::kPmg, Variant::kWithoutGco, Variant::kSingleGait}) {
    MotionComposition motion = composition(variant, library), plain = composition(variant, clips());
    settle(motion, kTurning);
    settle(plain, variant == Variant::kPmg ? corrected : kTurning);
    for (std::size_t c = 0; c < kChannels; ++c) {
      EXPECT_NEAR(motion.reference().command.u[c], kTurning.u[c], 1e-9) << "the user's, in " << to_string(variant);
    }
    // They may have begun to walk at different times.
    EXPECT_NEAR(motion.reference().gain, plain.reference().gain, 1e-9) << to_string(variant);
    EXPECT_NEAR(motion.reference().phase_rate_per_s, plain.reference().phase_rate_per_s, 1e-9) << to_string(variant);
  }
}

TEST(MotionComposition, AfterAResetEveryVariantBeginsAnew) {
  for (const Variant variant : {Variant::kPmg, Variant::kWithoutGco, Variant::kSingleGait}) {
    MotionComposition used = composition(variant), fresh = composition(variant);
    settle(used, kTurning, 137);
    used.reset();
    EXPECT_EQ(used.reference().q, z1().q_stand()) << to_string(variant);
    for (int k = 0; k < 100; ++k) {
      ASSERT_EQ(used.advance(kTurning, 0.01).q, fresh.advance(kTurning, 0.01).q) << to_string(variant);
      ASSERT_EQ(used.ground().command, fresh.ground().command) << to_string(variant);
    }
  }
}

}  // namespace
}  // namespace pmg::gco
