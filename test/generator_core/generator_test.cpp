#include "pmg/generator.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "generator_core/allocation_count.hpp"
#include "generator_core/synthetic_library.hpp"

namespace pmg::test {
namespace {

TEST(Generator, ZeroCommandIsExactlyTheStandingPostureBeforeAndAfterMoving) {
  const ClipLibrary library = make_library(31);
  Generator generator(library, make_options());
  EXPECT_EQ(run(generator, Command{}, 0.1).q, library.q_stand);
  run(generator, make_command(0.5, -0.2, 0.3, 0.3, -0.1, -0.1), 3.0);
  const Reference r = run(generator, Command{}, 3.0);
  EXPECT_EQ(r.q, library.q_stand);  // bit by bit
  EXPECT_EQ(r.dq, JointVector::Zero(31));
  EXPECT_EQ(r.command, Command{});
  EXPECT_FALSE(r.command_limited);
}

TEST(Generator, StepNeitherAllocatesNorThrows) {
  PMG_SKIP_IF_HEAP_IS_NOT_COUNTED();
  static_assert(noexcept(std::declval<Generator&>().step(Command{}, kDt_s)));
  static_assert(noexcept(std::declval<Generator&>().reset()));
  ClipLibrary library = make_library(31);
  library.q_lower = library.q_stand.array() - 0.2;  // makes the admissible set scale commands too
  library.q_upper = library.q_stand.array() + 0.2;
  const long at_start = allocation_count();
  Generator generator(library, make_options());
  const long before = allocation_count();
  EXPECT_GT(before, at_start);  // the counter works
  std::mt19937_64 random(31);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  Command user;
  for (int tick = 0; tick < 5000; ++tick) {
    if (tick % 50 == 0) {
      for (double& u : user.u) u = any(random);
    }
    if (tick % 1000 == 0) generator.reset();
    generator.step(user, kDt_s);
  }
  EXPECT_EQ(allocation_count(), before);
}

TEST(Generator, ReportsTheCommandThatTheReferenceRealises) {
  Generator generator(make_library(31), make_options());
  const Reference r = run(generator, make_command(0.8, 0.35, 0.0, 0.2), 5.0);  // two whole gaits at once
  EXPECT_NEAR(r.command[kVx], 0.4, 1e-12);
  EXPECT_NEAR(r.command[kVy], 0.175, 1e-12);
  EXPECT_NEAR(r.command[kPitch], 0.2, 1e-12);
  EXPECT_NEAR(r.gain, 1.0, 1e-12);
  EXPECT_TRUE(r.command_limited);
}

TEST(Generator, ALibrarysOwnVelocityScaleGoesBeforeTheOptions) {
  ClipLibrary library = make_library(31, 5);
  const GeneratorOptions options = make_options();
  Command half;
  half[kVx] = 0.25 * options.scale_positive[kVx];
  const auto gain_after_4_s = [&] {
    Generator generator(library, options);
    for (int k = 0; k < 400; ++k) generator.step(half, kDt_s);
    EXPECT_NEAR(generator.reference().command[kVx], half[kVx], 1e-12);
    return generator.reference().gain;
  };
  EXPECT_NEAR(gain_after_4_s(), 0.25, 1e-12);
  library.velocity_scale = VelocityScale{options.scale_negative, options.scale_positive};
  library.velocity_scale->positive[kVx] *= 0.5;
  EXPECT_NEAR(gain_after_4_s(), 0.5, 1e-12);
}

TEST(Generator, SameInputsGiveTheSameBits) {
  Generator a(make_library(31), make_options()), b(make_library(31), make_options());
  run(b, make_command(0.4, 0.1, 0.2, 0.1, 0.1, -0.1), 1.23);
  b.reset();  // leaves no trace of the past
  for (int tick = 0; tick < 500; ++tick) {
    const Command user = make_command(0.004 * tick, -0.1, 0.3, 0.2, -0.1, -0.05);
    const Reference &x = a.step(user, kDt_s), &y = b.step(user, kDt_s);
    ASSERT_EQ(x.q, y.q);
    ASSERT_EQ(x.dq, y.dq);
    ASSERT_EQ(x.phase, y.phase);
  }
}

TEST(Generator, TimeThatDoesNotPassChangesNothing) {
  Generator generator(make_library(7), make_options());
  const Reference before = run(generator, make_command(0.4, 0, 0), 1.0);
  for (const double dt :
       {0.0, -0.01, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const Reference& after = generator.step(make_command(-0.4, 0.3, 0.2, 0.1), dt);
    EXPECT_EQ(after.q, before.q);
    EXPECT_EQ(after.phase, before.phase);
    EXPECT_EQ(after.command, before.command);
  }
}

TEST(Generator, DirectionWithoutAClipAndPostureWithoutRowsAreNotAvailable) {
  ClipLibrary library = make_library(7);
  library.negative[kVx].reset();
  library.positive[kOmega].reset();
  library.posture[1] = StaticClip{};
  Generator generator(library, make_options());
  const Reference r = run(generator, make_command(-0.5, 0, 0.5, 0, 0.2), 3.0);
  EXPECT_EQ(r.q, library.q_stand);
  EXPECT_EQ(r.command, Command{});
  EXPECT_TRUE(r.command_limited);
}

TEST(Generator, PhaseAdvancesByTimeOverPeriodForAnyTimestep) {
  for (const double dt_s : {0.002, 0.01, 0.0333}) {
    Generator generator(make_library(7), make_options());
    for (int i = 0; i < std::lround(5.0 / dt_s); ++i) generator.step(make_command(0, 0.35, 0), dt_s);
    const double before = generator.reference().phase;
    EXPECT_NEAR(wrap_half_cycle(generator.step(make_command(0, 0.35, 0), dt_s).phase - before), dt_s / 1.02, 1e-12);
  }
}

}  // namespace
}  // namespace pmg::test
