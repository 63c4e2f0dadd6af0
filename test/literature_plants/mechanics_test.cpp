// The plants' own physics, against what is known in closed form.
#include "mechanics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "joint.hpp"

namespace pmg::literature {
namespace {

Machine pendulum() {
  Machine m;
  m.body.load_inertia_kg_m2 = 0.05;
  m.body.load_gravity_Nm = 2.0;
  m.body.rotor_inertia_kg_m2 = 0.01;
  return m;
}

void swing(Mechanics& mechanics, double duration_s, const Forces& forces = {}) {
  for (double left_s = duration_s; left_s > 1e-12; left_s -= 1e-3) mechanics.move(std::min(left_s, 1e-3), forces);
}

Forces forces(double drive_Nm, double push_Nm) {
  Forces f;
  f.drive.held_Nm = drive_Nm;
  f.push_Nm = push_Nm;
  return f;
}

TEST(DormandPrince, FollowsAnOscillatorToItsTolerance) {
  DormandPrince<2> solver(1e-10, 1e-12);
  DormandPrince<2>::State state = {1.0, 0.0};
  const auto slope = [](const DormandPrince<2>::State& at) { return DormandPrince<2>::State{at[1], -at[0]}; };
  solver.advance(slope, state, 100.0, [](const auto&) { return 1.0; });
  EXPECT_NEAR(state[0], std::cos(100.0), 1e-7);  // a thousand steps' errors of 1e-10
  EXPECT_NEAR(state[1], -std::sin(100.0), 1e-7);
}

TEST(DormandPrince, StopsWhereAnEventHappens) {
  DormandPrince<2> solver(1e-10, 1e-12);
  DormandPrince<2>::State state = {0.0, 1.0};
  const auto slope = [](const DormandPrince<2>::State& at) { return DormandPrince<2>::State{at[1], -at[0]}; };
  const double passed_s = solver.advance(slope, state, 10.0, [](const auto& at) { return at[1]; });
  EXPECT_NEAR(passed_s, std::numbers::pi / 2.0, 1e-8);
  EXPECT_NEAR(state[0], 1.0, 1e-8);
}

TEST(DormandPrince, GivesUpWhereAMillisecondTakesTooManySteps) {
  DormandPrince<1> solver;
  const auto never = [](const DormandPrince<1>::State&) { return 1.0; };
  DormandPrince<1>::State stiff = {1.0}, ends = {1.0};
  EXPECT_THROW(solver.advance([](const auto& at) { return DormandPrince<1>::State{-1e9 * at[0]}; }, stiff, 1e-3, never),
               DoesNotConverge);
  const auto to_the_root = [](const auto& at) { return DormandPrince<1>::State{1.0 + std::sqrt(1.5 - at[0])}; };
  EXPECT_THROW(solver.advance(to_the_root, ends, 2.0, never), DoesNotConverge) << "no number beyond 1.5";
  DormandPrince<1>::State usual = {1.0};
  solver.advance([](const auto& at) { return DormandPrince<1>::State{-at[0]}; }, usual, 1.0, never);
  EXPECT_NEAR(usual[0], std::exp(-1.0), 1e-6) << "the next call begins anew";
}

TEST(Mechanics, KeepsItsEnergyWithoutFriction) {
  Mechanics mechanics(pendulum());
  mechanics.reset(1.2);
  const double before_J = mechanics.energy_J();
  for (int k = 0; k < 20; ++k) {
    swing(mechanics, 0.25);
    ASSERT_NEAR(mechanics.energy_J(), before_J, 1e-7 * before_J);
  }
}

TEST(Mechanics, KeepsTheEnergyOfSpringsAndOfFlanksThatDontRub) {
  Machine soft = pendulum(), hard = pendulum(), loose = pendulum(), cushioned = pendulum();
  soft.transmission.stiffness_Nm_per_rad = 200.0;
  hard.transmission = {.stiffness_Nm_per_rad = 100.0, .hardening_Nm_per_rad3 = 2e5};
  loose.transmission = {.stiffness_Nm_per_rad = 400.0, .backlash_rad = 0.05};
  cushioned.transmission = {.stiffness_Nm_per_rad = 400.0,
                            .backlash_rad = 0.05,
                            .contact = ContactForm::kSoftGap,
                            .gap_stiffness_Nm_per_rad = 10.0};
  for (const Machine& machine : {soft, hard, loose, cushioned}) {
    Mechanics mechanics(machine);
    mechanics.reset(1.2);
    const double before_J = mechanics.energy_J();
    swing(mechanics, 2.0);
    EXPECT_NEAR(mechanics.energy_J(), before_J, 1e-5 * before_J);  // corners of flanks, and steps of the solver
  }
}

TEST(Mechanics, LargeSwingsHaveThePeriodOfTheEllipticIntegral) {
  Mechanics mechanics(pendulum());
  const double from_rad = 1.5, w = std::sqrt(2.0 / 0.06);
  mechanics.reset(from_rad);
  swing(mechanics, 4.0 / w * std::comp_ellint_1(std::sin(0.5 * from_rad)));
  EXPECT_NEAR(mechanics.load_rad(), from_rad, 1e-7);
  EXPECT_NEAR(mechanics.load_rad_s(), 0.0, 1e-5);
}

TEST(Mechanics, WhatFrictionTakesIsMissingFromTheEnergy) {
  Machine dry = pendulum(), smooth = pendulum(), geared = pendulum(), bristle = pendulum();
  dry.friction = {.coulomb_Nm = 0.1, .viscous_Nm_s_per_rad = 0.02, .stribeck_Nm = 0.1, .stribeck_rad_s = 0.3};
  smooth.friction = {.dry = DryForm::kTanh, .coulomb_Nm = 0.1, .power_Nm = 0.02, .power_exponent = 2.0};
  geared.friction = {
      .coulomb_Nm = 0.1, .load_form = LoadForm::kPowerFlow, .load_driving = 0.3, .load_backdriving = 0.2};
  bristle.friction = {.dry = DryForm::kLuGre, .coulomb_Nm = 0.1, .bristle_rad = 0.01};
  for (const Machine& machine : {dry, smooth, geared}) {
    Mechanics mechanics(machine);
    mechanics.reset(1.2);
    const double before_J = mechanics.energy_J();
    swing(mechanics, 0.6);
    EXPECT_GT(mechanics.dissipated_J(), 0.05 * before_J);
    EXPECT_NEAR(mechanics.energy_J() + mechanics.dissipated_J(), before_J, 1e-6 * before_J);
  }
  Mechanics mechanics(bristle);  // its bristles keep some
  mechanics.reset(1.2);
  const double before_J = mechanics.energy_J();
  swing(mechanics, 0.6);
  EXPECT_NEAR(mechanics.energy_J() + mechanics.dissipated_J(), before_J, 1e-6 * before_J);
}

TEST(Mechanics, CoulombFrictionTakesTheSameFromEachSwingAndThenHolds) {
  Machine m = pendulum();
  m.friction.coulomb_Nm = 0.002;
  Mechanics mechanics(m);
  mechanics.reset(0.02);
  // A spring of 2 Nm/rad: the amplitude falls by 2 F / k a half swing, to rest within F / k.
  for (int half = 1; half <= 9; ++half) {
    swing(mechanics, std::numbers::pi * std::sqrt(0.06 / 2.0));
    EXPECT_NEAR(std::abs(mechanics.load_rad()), 0.02 - half * 0.002, 1e-5) << half;  // sin q is not quite q
  }
  swing(mechanics, 5.0);
  EXPECT_TRUE(mechanics.sticks());
  const double rests_rad = mechanics.load_rad();
  swing(mechanics, 5.0);
  EXPECT_EQ(mechanics.load_rad(), rests_rad);
}

TEST(Mechanics, LetsGoAsSoonAsThePushExceedsItsFriction) {
  Machine m = pendulum();
  m.body.load_gravity_Nm = 0.0;
  m.friction.coulomb_Nm = 0.5;
  m.friction.stribeck_Nm = 0.2;
  for (const auto& [push_Nm, moves] : {std::pair{0.699, false}, std::pair{0.701, true}}) {
    Mechanics mechanics(m);
    swing(mechanics, 0.5, forces(0.0, push_Nm));
    EXPECT_EQ(mechanics.load_rad() > 1e-3, moves) << push_Nm;
  }
}

TEST(Mechanics, SpringBeforeTheFrictionBendsBeforeTheLoadMoves) {
  Machine m = pendulum();
  m.body.load_gravity_Nm = 0.0;
  m.transmission = {.stiffness_Nm_per_rad = 100.0, .damping_Nm_s_per_rad = 1.0};
  m.friction.coulomb_Nm = 0.5;
  m.friction.at_load = true;
  Mechanics mechanics(m);
  swing(mechanics, 2.0, forces(0.2, 0.0));
  EXPECT_EQ(mechanics.load_rad(), 0.0);
  EXPECT_NEAR(mechanics.motor_rad(), 0.2 / 100.0, 1e-6);
  m.friction.at_load = false;
  Mechanics behind(m);
  swing(behind, 2.0, forces(0.2, 0.0));
  EXPECT_EQ(behind.motor_rad(), 0.0);
}

TEST(Mechanics, GearFrictionFollowsWhatItIsToFollow) {
  // A motor of 1 Nm drives a load without weight; J_m = 0.01, J_l = 0.05, share 0.3.
  const auto speed_after = [](LoadForm form) {
    Machine m = pendulum();
    m.body.load_gravity_Nm = 0.0;
    m.friction = {.load_form = form, .load_driving = 0.3, .load_backdriving = 0.1};
    Mechanics mechanics(m);
    swing(mechanics, 0.1, forces(1.0, 0.0));
    return mechanics.load_rad_s();
  };
  EXPECT_NEAR(speed_after(LoadForm::kMotor), 0.1 * (1.0 - 0.3) / 0.06, 1e-6);
  EXPECT_NEAR(speed_after(LoadForm::kNet), 0.1 * (1.0 - 0.15) / 0.06, 1e-6);
  EXPECT_NEAR(speed_after(LoadForm::kTransmitted), 0.1 / (0.01 + 0.05 * 1.3), 1e-6);
  EXPECT_NEAR(speed_after(LoadForm::kPowerFlow), 0.1 / (0.01 + 0.05 * 1.3), 1e-6);
}

// The load's torque less two fifths turns the rotor: J_l a = -2 sin q - T, J_m a = 0.6 T.
TEST(Mechanics, BackdrivesOnlyAgainstWhatTheGearHolds) {
  Machine m = pendulum();
  m.friction = {.load_form = LoadForm::kPowerFlow, .load_driving = 0.1, .load_backdriving = 0.4};
  Mechanics mechanics(m);
  mechanics.reset(1.0);
  swing(mechanics, 0.01);
  const double expected_rad_s = -0.01 * 2.0 * std::sin(1.0) / (0.05 + 0.01 / 0.6);
  EXPECT_NEAR(mechanics.load_rad_s(), expected_rad_s, 1e-3 * std::abs(expected_rad_s));
}

TEST(Mechanics, BacklashIsAsWideAsPlanted) {
  Machine m = pendulum();
  m.body.load_gravity_Nm = 0.0;
  m.transmission = {.stiffness_Nm_per_rad = 1e4, .damping_Nm_s_per_rad = 2.0, .backlash_rad = 0.04};
  m.friction.viscous_Nm_s_per_rad = 0.1;
  Mechanics mechanics(m);
  swing(mechanics, 3.0, forces(0.05, 0.0));  // pushed on one flank
  const double ahead_rad = mechanics.motor_rad() - mechanics.load_rad();
  swing(mechanics, 6.0, forces(-0.05, 0.0));  // and on the other
  const double behind_rad = mechanics.motor_rad() - mechanics.load_rad();
  EXPECT_NEAR(ahead_rad - behind_rad, 0.04, 2e-5);  // the flanks give 0.05 Nm / 1e4 Nm/rad each
}

TEST(Mechanics, BristlesBeginAtNothingAndEndUpAtCoulombsLevel) {
  for (const DryForm form : {DryForm::kDahl, DryForm::kLuGre}) {
    Machine m = pendulum();
    m.body.load_gravity_Nm = 0.0;
    m.friction = {.dry = form, .coulomb_Nm = 0.4, .bristle_rad = 0.1};
    Mechanics mechanics(m);
    swing(mechanics, 0.02, forces(1.0, 0.0));
    EXPECT_GT(mechanics.load_rad_s(), 0.9 * 0.02 * 1.0 / 0.06);  // hardly any friction yet
    swing(mechanics, 0.5, forces(1.0, 0.0));
    const double before_rad_s = mechanics.load_rad_s();
    swing(mechanics, 0.1, forces(1.0, 0.0));
    EXPECT_NEAR(mechanics.load_rad_s() - before_rad_s, 0.1 * (1.0 - 0.4) / 0.06, 1e-6);
  }
}

TEST(Mechanics, ALooseMassCreepsOutwardsAndMakesTheJointHeavier) {
  Machine m = pendulum();
  m.screw = {.most_share = 0.4, .holds_m_s2 = 9.9, .creep_s = 0.05, .length_m = 0.25};
  Mechanics mechanics(m);
  mechanics.reset(1.2);
  const double heavy_J = 2.0 * (1.0 - std::cos(1.2));
  EXPECT_NEAR(mechanics.energy_J(), heavy_J, 1e-12);
  swing(mechanics, 3.0);
  EXPECT_GT(std::abs(mechanics.energy_J() - heavy_J), 0.05 * heavy_J);
  mechanics.reset(1.2);
  EXPECT_NEAR(mechanics.energy_J(), heavy_J, 1e-12);  // tightened again
}

/// A joint that holds 1 rad against its weight.
double held_rad(const Machine& machine, double kp) {
  Machine m = machine;
  m.drive.loop_hz = 2000.0;
  Joint joint(m);
  const Command command{.q_rad = 1.0, .kp = kp, .kd = 2.0};
  joint.reset(0.0, command);
  joint.tell(command);
  joint.advance(4.0);
  return joint.reading_rad();
}

TEST(Joint, DeadBandsJumpSubtractAndSleep) {
  Machine m = pendulum();
  const double sags_rad = held_rad(m, 40.0);
  EXPECT_NEAR(40.0 * (1.0 - sags_rad), 2.0 * std::sin(sags_rad), 1e-3);
  m.drive.dead_band_rad = 0.02;
  EXPECT_NEAR(held_rad(m, 40.0), sags_rad, 1e-3);  // its error is beyond the band
  m.drive.dead_form = DeadBandForm::kSubtract;
  const double subtracted_rad = held_rad(m, 40.0);
  EXPECT_NEAR(40.0 * (1.0 - subtracted_rad - 0.02), 2.0 * std::sin(subtracted_rad), 1e-3);
}

TEST(Joint, AnIntegralTermTakesTheSagAwayAndDoesntWindUp) {
  Machine m = pendulum();
  m.friction.viscous_Nm_s_per_rad = 0.4;
  m.drive.integral_per_s = 3.0;
  EXPECT_NEAR(held_rad(m, 40.0), 1.0, 2e-3);
  // Too weak for its command, it comes back at once when it is told to: 4 s at 0.48 rad of error would have wound up
  // 230 Nm.
  m.drive.limit = 1.0;
  Joint joint(m);
  const Command up{.q_rad = 1.0, .kp = 40.0, .kd = 2.0}, down{.q_rad = 0.0, .kp = 40.0, .kd = 2.0};
  joint.reset(0.0, up);
  joint.tell(up);
  joint.advance(4.0);
  EXPECT_NEAR(joint.reading_rad(), std::asin(0.5), 1e-2);
  joint.tell(down);
  joint.advance(1.5);
  EXPECT_NEAR(joint.reading_rad(), 0.0, 5e-2);
}

TEST(Joint, ARateLimitTurnsAStepIntoARamp) {
  Machine m = pendulum();
  m.body.load_gravity_Nm = 0.0;
  m.command.rate_limit_rad_s = 2.0;
  Joint joint(m);
  const Command step{.q_rad = 1.5, .kp = 2000.0, .kd = 22.0};
  joint.reset(0.0, {.q_rad = 0.0, .kp = 2000.0, .kd = 22.0});
  joint.tell(step);
  joint.advance(0.4);
  const double lag_rad = 22.0 / 2000.0 * 2.0;  // a PD without commanded speed trails a ramp by kd/kp
  EXPECT_NEAR(joint.reading_rad(), 0.8 - lag_rad, 2e-3);
  joint.advance(1.0);
  EXPECT_NEAR(joint.reading_rad(), 1.5, 1e-4);
}

TEST(Joint, WarmFrictionIsLess) {
  Machine m = pendulum();
  m.body.load_gravity_Nm = 0.0;
  m.friction.coulomb_Nm = 0.5;
  m.thermal.friction_per_K = -0.02;
  m.drive.law = Law::kTorque;
  Joint joint(m);
  joint.reset(0.0, {}, kReference_C + 30.0);
  joint.tell({.feed_forward = 1.0});
  joint.advance(0.1);
  EXPECT_NEAR(joint.mechanics().load_rad_s(), 0.1 * (1.0 - 0.5 * std::exp(-0.6)) / 0.06, 1e-6);
}

TEST(Joint, ServosMeetTheirBackEmfAndTheirSource) {
  // Free of load and friction a servo at full duty ends at bus / back_emf; a stalled one gives less by its source.
  Machine m = pendulum();
  m.body.load_gravity_Nm = 0.0;
  m.drive = {.law = Law::kServo, .limit = 1.0, .torque_per_unit = 0.3, .back_emf = 1.5};
  Joint joint(m);
  const Command far{.q_rad = 1e4, .kp = 1.0, .bus_V = 12.0};
  joint.reset(0.0, far);
  joint.tell(far);
  joint.advance(5.0);
  EXPECT_NEAR(joint.mechanics().load_rad_s(), 8.0, 1e-3);
  m.friction.coulomb_Nm = 100.0;
  m.drive.sag_per_Nm = 0.1;
  Joint stalled(m);
  stalled.reset(0.0, far);
  stalled.tell(far);
  stalled.advance(0.1);
  EXPECT_NEAR(stalled.torque_Nm(), 3.6 / (1.0 + 0.1 * 3.6), 1e-9);
}

TEST(Joint, CommandsAndReadingsAreLateByWhatIsPlanted) {
  for (const bool reading : {false, true}) {
    Machine m = pendulum();
    (reading ? m.sensor.delay_s : m.command.delay_s) = 0.02;
    m.drive.law = Law::kTorque;
    Joint joint(m);
    joint.reset(0.0, {});
    joint.tell({.feed_forward = 1.0});
    joint.advance(0.0195);
    EXPECT_EQ(joint.reading_rad(), 0.0);
    joint.advance(0.0105);
    const double moved_s = 0.01;
    EXPECT_NEAR(joint.reading_rad(), 0.5 * 1.0 / 0.06 * moved_s * moved_s, 2e-5);  // a tick's interpolation
  }
}

}  // namespace
}  // namespace pmg::literature
