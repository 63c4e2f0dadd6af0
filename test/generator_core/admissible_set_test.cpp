#include "pmg/admissible_set.hpp"

#include <gtest/gtest.h>

#include "generator_core/synthetic_library.hpp"
#include "pmg/joint_clamp.hpp"

namespace pmg::test {
namespace {

/// A library whose joints have so little room that most commands are scaled down.
ClipLibrary tight_library(int joints, std::uint64_t seed, double room_rad = 0.25) {
  ClipLibrary library = make_library(joints, seed);
  library.q_lower = library.q_stand.array() - room_rad;
  library.q_upper = library.q_stand.array() + room_rad;
  return library;
}

double margin_left(const ClipLibrary& library, const JointVector& q) {
  return std::min((library.q_upper - q).minCoeff(), (q - library.q_lower).minCoeff());
}

TEST(AdmissibleSet, ReferenceKeepsTheMarginForEveryCommandAtEveryPhase) {
  const GeneratorOptions options = make_options();
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const ClipLibrary library = tight_library(31, seed);
    Generator generator(library, options);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    Command user;
    bool limited = false;
    for (int tick = 0; tick < 20000; ++tick) {
      if (tick % 150 == 0) {
        for (double& u : user.u) u = any(random);
      }
      const Reference& r = generator.step(user, kDt_s);
      // 1e-9: sums of a few dozen rounded products.
      ASSERT_GE(margin_left(library, r.q), options.limit_margin_rad - 1e-9) << "seed " << seed << " tick " << tick;
      ASSERT_FALSE(r.joint_clamped);
      limited = limited || r.command_limited;
    }
    EXPECT_TRUE(limited);
  }
}

TEST(AdmissibleSet, OneDirectionIsScaledJustAsFarAsItsWorstPhaseNeeds) {
  const ClipLibrary library = tight_library(31, 3);
  const GeneratorOptions options = make_options();
  Generator generator(library, options);
  double least = 1e9;
  run(generator, make_command(0.8, 0, 0), 5.0);
  const double gain = generator.reference().gain;
  ASSERT_LT(gain, 1.0);
  for (int tick = 0; tick < 20000; ++tick) {
    const Reference& r = generator.step(make_command(0.8, 0, 0), 0.00317);  // a fine sweep over the phase
    least = std::min(least, margin_left(library, r.q));
  }
  // The sampled phases lie within 1e-4 cycles of the worst one, which is below 1e-6 rad at an extreme.
  EXPECT_NEAR(least, options.limit_margin_rad, 1e-6);
  EXPECT_NEAR(generator.reference().command[kVx], gain * 0.8, 1e-12);
  EXPECT_TRUE(generator.reference().command_limited);
}

TEST(AdmissibleSet, VelocityYieldsBeforePosture) {
  const ClipLibrary library = tight_library(31, 3);
  Generator generator(library, make_options());
  const Command posture = make_command(0, 0, 0, 0.15, 0.05, -0.05);
  const Reference standing = run(generator, posture, 5.0);
  ASSERT_FALSE(standing.command_limited);
  Command both = posture;
  both[kVx] = 0.8;
  const double alone = [&] {
    Generator walking(library, make_options());
    return run(walking, make_command(0.8, 0, 0), 5.0).command[kVx];
  }();
  const Reference walking = run(generator, both, 5.0);
  for (const Channel channel : {kPitch, kRoll, kHeight}) EXPECT_EQ(walking.command[channel], posture[channel]);
  EXPECT_LT(walking.command[kVx], alone - 1e-3);
  EXPECT_GT(walking.command[kVx], 0.0);
  EXPECT_TRUE(walking.command_limited);
}

TEST(AdmissibleSet, PostureTheRobotCannotTakeIsScaledToTheLimitAndNoFurther) {
  const ClipLibrary library = tight_library(31, 3, 0.15);
  const GeneratorOptions options = make_options();
  Generator generator(library, options);
  const Command user = make_command(0, 0, 0, 0.5, 0.25, -0.2);
  const Reference r = run(generator, user, 5.0);
  EXPECT_TRUE(r.command_limited);
  EXPECT_NEAR(margin_left(library, r.q), options.limit_margin_rad, 1e-7);
  const double share = r.command[kPitch] / 0.5;
  EXPECT_GT(share, 0.1);
  EXPECT_LT(share, 1.0);
  EXPECT_NEAR(r.command[kRoll] / 0.25, share, 1e-12);
  EXPECT_NEAR(r.command[kHeight] / -0.2, share, 1e-12);
}

TEST(AdmissibleSet, CommandWithRoomToSpareIsLeftAlone) {
  Generator generator(make_library(31), make_options());
  const Command user = make_command(0.3, 0.1, -0.2, 0.2, 0.1, -0.05);
  const Reference r = run(generator, user, 5.0);
  EXPECT_FALSE(r.command_limited);
  for (std::size_t c = 0; c < kChannels; ++c) EXPECT_NEAR(r.command.u[c], user.u[c], 1e-12);
}

TEST(AdmissibleSet, AdmissibleCommandIsContinuousInTheCommand) {
  // Along straight lines through the command space the scaled command must not jump: half the step gives half the
  // largest change.
  const ClipLibrary library = tight_library(31, 3);
  const Posture posture(library.posture, library.q_stand);
  AdmissibleSet set(library.q_stand, library.q_lower, library.q_upper, 0.035);
  set.add(0, ClipCurve(*library.positive[kVx]), library.q_stand);
  const auto largest_change = [&](int steps) {
    double largest = 0.0;
    Eigen::Vector2d previous = Eigen::Vector2d::Zero();
    JointVector q_s(31);
    for (int i = 0; i <= steps; ++i) {
      const double s = static_cast<double>(i) / steps;
      const Command command = make_command(0, 0, 0, 0.5 * s, 0.25 * s * s, -0.2 * s);
      const double share = posture_scale(
          set, [&](double scale, JointVector& q) { posture.offset(command, scale, q); }, q_s);
      const double gain = 1.0 - 0.5 * s;
      const Eigen::Vector2d now(share * s, gain * set.velocity_scale({gain, 0, 0, 0, 0, 0}, q_s));
      if (i > 0) largest = std::max(largest, (now - previous).cwiseAbs().maxCoeff());
      previous = now;
    }
    return largest;
  };
  const double coarse = largest_change(1000), fine = largest_change(16000);
  EXPECT_LT(coarse, 0.05);
  EXPECT_LT(fine, coarse / 8.0);
}

TEST(JointClamp, LastGuardClampsSaysSoAndStopsTheJoint) {
  const JointVector lower = JointVector::Constant(3, -1.0), upper = JointVector::Constant(3, 1.0);
  JointVector q(3), dq(3);
  q << -1.5, 0.5, 1.25;
  dq << -2.0, 3.0, 4.0;
  EXPECT_TRUE(clamp_joints(lower, upper, q, dq));
  EXPECT_EQ(q, (JointVector(3) << -1.0, 0.5, 1.0).finished());
  EXPECT_EQ(dq, (JointVector(3) << 0.0, 3.0, 0.0).finished());
  EXPECT_FALSE(clamp_joints(lower, upper, q, dq));
}

TEST(JointClamp, GuardsTheReferenceWhereTheAdmissibleSetIsSwitchedOff) {
  const ClipLibrary library = tight_library(31, 3, 0.1);
  GeneratorOptions options = make_options();
  options.limit_margin_rad = -10.0;
  Generator generator(library, options);
  bool clamped = false;
  for (int tick = 0; tick < 500; ++tick) {
    const Reference& r = generator.step(make_command(0.8, 0, 0), kDt_s);
    ASSERT_GE(margin_left(library, r.q), 0.0);
    clamped = clamped || r.joint_clamped;
  }
  EXPECT_TRUE(clamped);
}

}  // namespace
}  // namespace pmg::test
