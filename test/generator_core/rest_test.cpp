// Standing, starting and stopping: when the phase freezes, and when both feet carry the robot.
#include <gtest/gtest.h>

#include "generator_core/synthetic_library.hpp"

namespace pmg::test {
namespace {

const Command kForward = make_command(0.8, 0, 0);

/// Walks, then commands zero until the gains are exactly zero.
void walk_and_stop(Generator& generator, double walk_s = 3.0) {
  run(generator, kForward, walk_s);
  while (generator.reference().gain > 0.0) generator.step(Command{}, kDt_s);
}

TEST(Rest, PhaseFreezesAfterHalfASecondWithBothFeetInContact) {
  Generator generator(make_library(7), make_options());
  walk_and_stop(generator);  // its last tick is the first one at rest
  for (int tick = 1; tick < 50; ++tick) {
    EXPECT_GT(generator.step(Command{}, kDt_s).phase_rate_per_s, 0.0) << tick;
  }
  const Reference frozen = generator.step(Command{}, kDt_s);
  EXPECT_EQ(frozen.phase_rate_per_s, 0.0);
  const Reference later = run(generator, Command{}, 5.0);
  EXPECT_EQ(later.phase, frozen.phase);
  for (const Foot foot : {kLeft, kRight}) {
    EXPECT_TRUE(later.contact[foot]);
    EXPECT_EQ(later.contact_weight[foot], 1.0);
    EXPECT_EQ(later.duty_factor[foot], 1.0);
  }
}

TEST(Rest, PhaseContinuesWhereItFroze) {
  Generator generator(make_library(7), make_options());
  walk_and_stop(generator);
  const double frozen = run(generator, Command{}, 2.0).phase;
  const Reference& r = generator.step(kForward, kDt_s);
  EXPECT_NEAR(wrap_half_cycle(r.phase - frozen), kDt_s / 1.10, 1e-12);
  EXPECT_NEAR(r.phase_rate_per_s, 1.0 / 1.10, 1e-12);
}

TEST(Rest, ShortStopDoesNotFreezeThePhase) {
  Generator generator(make_library(7), make_options());
  walk_and_stop(generator);
  run(generator, Command{}, 0.3);
  double previous = generator.reference().phase;
  for (int tick = 0; tick < 100; ++tick) {
    const Reference& r = generator.step(kForward, kDt_s);
    EXPECT_NEAR(wrap_half_cycle(r.phase - previous), kDt_s / 1.10, 1e-12);
    previous = r.phase;
  }
}

TEST(Rest, PhaseRunsOnUntilBothFeetCarry) {
  GeneratorOptions options = make_options();
  options.rest_before_freeze_s = 0.0;
  options.stance_ramp_s = 2.0;  // then rest alone does not load both feet at once
  for (int walk_ticks = 300; walk_ticks < 400; walk_ticks += 7) {
    Generator generator(make_library(7), options);
    walk_and_stop(generator, walk_ticks * kDt_s);
    Reference last_moving = generator.reference();
    for (int tick = 0; tick < 200 && generator.step(Command{}, kDt_s).phase_rate_per_s > 0.0; ++tick) {
      last_moving = generator.reference();
    }
    EXPECT_EQ(generator.reference().phase_rate_per_s, 0.0);
    EXPECT_TRUE(last_moving.contact[kLeft] && last_moving.contact[kRight]) << "phase " << last_moving.phase;
  }
}

TEST(Rest, DutyFactorRisesAtRestAndFallsAgainOverTheStanceRamp) {
  Generator generator(make_library(7), make_options());
  run(generator, kForward, 3.0);
  EXPECT_NEAR(generator.reference().duty_factor[kLeft], 0.60, 1e-12);
  double previous = 0.60;
  while (generator.reference().gain > 0.0) {
    previous = generator.reference().duty_factor[kLeft];
    EXPECT_NEAR(previous, 0.60, 1e-12);  // the clips' average at every amplitude
    generator.step(Command{}, kDt_s);
  }
  EXPECT_NEAR(generator.reference().duty_factor[kLeft], 0.60 + 0.4 * kDt_s / 0.2, 1e-12);
  EXPECT_NEAR(run(generator, Command{}, 0.09).duty_factor[kLeft], 0.80, 1e-9);
  EXPECT_EQ(run(generator, Command{}, 1.0).duty_factor[kLeft], 1.0);
  EXPECT_NEAR(run(generator, kForward, 0.1).duty_factor[kLeft], 0.80, 1e-9);
  EXPECT_NEAR(run(generator, kForward, 0.1).duty_factor[kLeft], 0.60, 1e-9);
}

TEST(Rest, GainWeightedRuleCountsStandingWithItsShare) {
  GeneratorOptions options = make_options();
  options.stance_rule = StanceRule::kGainWeighted;
  Generator generator(make_library(7), options);
  const Reference half = run(generator, make_command(0.4, 0, 0), 3.0);
  EXPECT_NEAR(half.duty_factor[kLeft], 0.5 * 0.60 + 0.5, 1e-9);
  EXPECT_NEAR(run(generator, kForward, 3.0).duty_factor[kRight], 0.60, 1e-9);
  EXPECT_EQ(run(generator, Command{}, 1.0).duty_factor[kLeft], 1.0);
}

TEST(Rest, PeriodAndContactCentresAreHeld) {
  Generator generator(make_library(7), make_options());
  const Reference walking = run(generator, make_command(0, 0.2, 0), 3.0);
  run(generator, Command{}, 0.5);
  const Reference standing = generator.step(Command{}, kDt_s);
  EXPECT_EQ(standing.gain, 0.0);
  EXPECT_NEAR(standing.phase_rate_per_s, 1.0 / 1.02, 1e-12);
  EXPECT_EQ(standing.contact_center, walking.contact_center);
}

TEST(Rest, ContactsFollowTheRuleInEveryTick) {
  Generator generator(make_library(7), make_options());
  for (int tick = 0; tick < 2000; ++tick) {
    const Reference& r = generator.step(tick / 400 % 2 == 0 ? make_command(0.4, 0.1, 0.2) : Command{}, kDt_s);
    for (const Foot foot : {kLeft, kRight}) {
      ASSERT_EQ(r.contact[foot],
                std::abs(wrap_half_cycle(r.phase - r.contact_center[foot])) <= 0.5 * r.duty_factor[foot]);
      if (r.duty_factor[foot] < 0.9) {
        ASSERT_EQ(r.contact[foot], r.contact_weight[foot] > 0.0) << r.phase;
      }
    }
    ASSERT_TRUE(r.contact[kLeft] || r.contact[kRight]);
  }
}

TEST(Rest, ResetStandsWithBothFeetLoadedInTheMiddleOfADoubleSupport) {
  const ClipLibrary library = make_library(7);
  Generator generator(library, make_options());
  const Reference fresh = generator.reference();
  run(generator, make_command(0.5, 0.2, 0.1, 0.2), 2.345);
  generator.reset();
  const Reference& r = generator.reference();
  EXPECT_EQ(r.q, library.q_stand);
  EXPECT_EQ(r.dq, JointVector::Zero(7));
  EXPECT_EQ(r.command, Command{});
  EXPECT_EQ(r.phase, fresh.phase);
  EXPECT_EQ(r.phase_rate_per_s, 0.0);
  EXPECT_NEAR(r.phase, 0.05, 1e-9);  // left contact from 0 on, right contact until 0.1
  EXPECT_EQ(r.contact_weight, (PerFoot<double>{1.0, 1.0}));
}

}  // namespace
}  // namespace pmg::test
