#include "evidence/inverse_dynamics.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "calib/fit_results.hpp"
#include "evidence/torque_balance.hpp"
#include "recorded_benches.hpp"

namespace pmg::evidence {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr double kMass_kg = 95.0, kViscous_N_s_per_m = 200.0, kForwards_N = 17.0, kBackwards_N = 23.0;

struct LinearDrive {
  double rate_hz = 1000.0, force_late_s = 0.0, pace = 1.0, noise_m = 0.0;
};

/// Twenty seconds of a linear drive's sines, with noise of 20 mV.
std::pair<bench::Bench, bench::BenchRun> recorded(const LinearDrive& drive) {
  bench::Bench bench;
  bench.rig = bench::Rig::kLinear;
  bench.law = bench::DriveLaw::kCascadePd;
  bench.sample_rate_hz = drive.rate_hz;
  bench.known.drive.torque_per_unit_Nm = 35.0;
  std::mt19937 random(3);
  std::normal_distribution<double> noise;
  bench::BenchRun run;
  for (int k = 0; k < static_cast<int>(20.0 * drive.rate_hz); ++k) {
    const double t = k / drive.rate_hz, slow = 3.0 * drive.pace, fast = 11.0 * drive.pace;
    run.recording.t_s.push_back(t);
    run.recording.q_cmd_rad.push_back(0.0);
    run.recording.q_rad.push_back(-0.1 / slow * std::cos(slow * t) - 0.05 / fast * std::cos(fast * t) +
                                  drive.noise_m * noise(random));
    run.recording.valid.push_back(true);
    const double then = t - drive.force_late_s;
    const double v = 0.1 * std::sin(slow * then) + 0.05 * std::sin(fast * then),
                 a = 0.1 * slow * std::cos(slow * then) + 0.05 * fast * std::cos(fast * then);
    const double force_N = kMass_kg * a + kViscous_N_s_per_m * v + (v > 0.0 ? kForwards_N : -kBackwards_N);
    run.recording.drive_V.push_back(force_N / 35.0 + 0.02 * noise(random));
  }
  return {bench, run};
}

// A percent of the mass: at 100 samples a second the fast sine moves by 0.1 rad of its phase between two of them. Noise
// of the readings adds nothing to it, because nothing is differentiated.
TEST(InverseDynamics, FindsALinearDrivesParametersAtAnyRateWithNoisyReadings) {
  for (const LinearDrive& drive : {LinearDrive{}, LinearDrive{.noise_m = 1e-5}, LinearDrive{.rate_hz = 200.0},
                                   LinearDrive{.rate_hz = 200.0, .noise_m = 1e-5}, LinearDrive{.rate_hz = 100.0},
                                   LinearDrive{.rate_hz = 100.0, .noise_m = 3e-5}}) {
    const auto [bench, run] = recorded(drive);
    const auto found = inverse_dynamics(bench, {run});
    ASSERT_TRUE(found.has_value()) << drive.rate_hz;
    EXPECT_NEAR(found->armature_kg_m2.value, kMass_kg, 0.01 * kMass_kg) << drive.rate_hz << ", " << drive.noise_m;
    EXPECT_NEAR(found->viscous_Nm_s_per_rad.value, kViscous_N_s_per_m, 0.02 * kViscous_N_s_per_m)
        << drive.rate_hz << ", " << drive.noise_m;
    EXPECT_NEAR(found->coulomb_Nm.value, 20.0, 0.3) << drive.rate_hz << ", " << drive.noise_m;
    EXPECT_NEAR(found->offset_Nm.value, 3.0, 0.1) << drive.rate_hz << ", " << drive.noise_m;
    EXPECT_LT(found->armature_kg_m2.deviation, 1.0);
    EXPECT_EQ(calib::meaning_of_negative(*found), "");
  }
}

TEST(InverseDynamics, NeedsTheDrivesOutputInNewtonMetres) {
  auto [bench, run] = recorded({});
  bench.unknown = {"drive.torque_per_unit_Nm"};
  EXPECT_FALSE(inverse_dynamics(bench, {run}).has_value());
  bench.unknown = {};
  run.recording.drive_V.clear();
  EXPECT_FALSE(inverse_dynamics(bench, {run}).has_value());
}

/// A pendulum that hangs at that angle, under a torque.
std::pair<bench::Bench, bench::BenchRun> hanging(double hangs_at_rad, bool held) {
  bench::Bench bench;
  bench.law = held ? bench::DriveLaw::kTorque : bench::DriveLaw::kPositionPd;
  bench.sample_rate_hz = 100.0;
  bench::BenchRun run;
  run.load = {0.05, 2.0, hangs_at_rad};
  const auto torque_Nm = [&](double t) {
    const double q = hangs_at_rad + 0.8 * std::sin(3.0 * t), v = 2.4 * std::cos(3.0 * t), a = -7.2 * std::sin(3.0 * t);
    return (0.05 + 0.02) * a + 2.0 * std::sin(q - hangs_at_rad) + 0.1 * v + (v > 0.0 ? 0.3 : -0.3);
  };
  for (int k = 0; k < 3000; ++k) {
    const double t = k / bench.sample_rate_hz;
    run.recording.t_s.push_back(t);
    run.recording.q_cmd_rad.push_back(0.0);
    run.recording.q_rad.push_back(hangs_at_rad + 0.8 * std::sin(3.0 * t));
    run.recording.valid.push_back(true);
    run.recording.torque_Nm.push_back(torque_Nm(held ? t + 0.5 / bench.sample_rate_hz : t));
  }
  return {bench, run};
}

// A robot's joint hangs at an angle of its own. A torque that is commanded holds until the next sample; one that is
// measured is of its sample.
TEST(InverseDynamics, KnowsWhereTheLoadHangsAndHowLongATorqueHolds) {
  for (const double hangs_at_rad : {0.0, 0.4}) {
    for (const bool held : {false, true}) {
      const auto [bench, run] = hanging(hangs_at_rad, held);
      const auto found = inverse_dynamics(bench, {run});
      ASSERT_TRUE(found.has_value());
      EXPECT_NEAR(found->armature_kg_m2.value, 0.02, 5e-4) << hangs_at_rad << ", " << held;
      EXPECT_NEAR(found->viscous_Nm_s_per_rad.value, 0.1, 2e-3) << hangs_at_rad << ", " << held;
      EXPECT_NEAR(found->coulomb_Nm.value, 0.3, 5e-3) << hangs_at_rad << ", " << held;
      EXPECT_NEAR(found->offset_Nm.value, 0.0, 5e-3) << hangs_at_rad << ", " << held;
    }
  }
}

// Friction below zero is no friction: the tool says what is wrong with the recording instead, and takes nothing of it.
TEST(InverseDynamics, SaysWhatNegativeFrictionMeans) {
  // 50 ms too early, acceleration times mass passes for -50 ms (11 rad/s)^2 mass of viscous friction.
  auto [bench, run] = recorded({.force_late_s = -0.05});
  const auto early = inverse_dynamics(bench, {run});
  ASSERT_TRUE(early.has_value());
  ASSERT_LT(early->viscous_Nm_s_per_rad.value, 0.0);
  EXPECT_THAT(calib::meaning_of_negative(*early),
              AllOf(HasSubstr("Viscous friction below zero: no joint has that"), HasSubstr("early or late")));
  calib::JointModel start;
  calib::Unknowns unknowns = {calib::unknown("transmission.armature_kg_m2", bench)};
  EXPECT_FALSE(calib::take_inverse_dynamics(*early, bench, start, unknowns));
  EXPECT_EQ(start.actuator, model::ActuatorParameters{});
  EXPECT_EQ(unknowns.size(), 4U) << "inertia, both frictions and the offset: rollouts look for them";

  // Sines of 7 Hz and 25 Hz are too fast for 80 samples a second.
  auto [slow_bench, slow_run] = recorded({.rate_hz = 80.0, .force_late_s = -0.01, .pace = 14.0});
  const auto coarse = inverse_dynamics(slow_bench, {slow_run});
  ASSERT_TRUE(coarse.has_value());
  ASSERT_FALSE(calib::impossible_estimates(*coarse).empty());
  EXPECT_THAT(calib::meaning_of_negative(*coarse), HasSubstr("too fast for 80 samples a second"));

  calib::InverseDynamics small;
  small.viscous_Nm_s_per_rad = {-0.01, 0.02};
  EXPECT_THAT(calib::meaning_of_negative(small),
              AllOf(HasSubstr("Viscous friction"), HasSubstr("too small to be seen")));
  EXPECT_TRUE(calib::take_inverse_dynamics(small, bench, start, unknowns));
  EXPECT_EQ(start.actuator.friction.viscous_Nm_s_per_rad, 0.0);
}

// Janot, Gautier, Brunot 2019 publish M 95.1 kg, Fv 203.5 N s/m, Fc 20.4 N, offset -3.16 N of the opposing force.
TEST(MeasuredBench, OfALinearDriveGivesThePublishedParameters) {
  PMG_NEEDS_BENCH("emps");
  const bench::Bench bench = bench::read_bench(test::recorded_bench("emps"));
  const auto found = inverse_dynamics(bench, bench.read_runs(bench::RowFilter("")));
  ASSERT_TRUE(found.has_value());
  EXPECT_NEAR(found->armature_kg_m2.value / 95.1, 1.0, 0.03);
  EXPECT_NEAR(found->viscous_Nm_s_per_rad.value / 203.5, 1.0, 0.03);
  EXPECT_NEAR(found->coulomb_Nm.value / 20.4, 1.0, 0.03);
  EXPECT_NEAR(found->offset_Nm.value / 3.16, 1.0, 0.03);
}

// At 20 points a window sums that only approximate the integrals took a constant speed for an acceleration of 0.4/s
// times it.
TEST(TorqueBalance, ConstantSpeedsAndAccelerationsAreWhatTheyAre) {
  for (const double rate_hz : {60.0, 100.0, 125.0, 1000.0}) {
    bench::Bench bench;
    bench.law = bench::DriveLaw::kTorque;
    bench.sample_rate_hz = rate_hz;
    bench::BenchRun run;
    for (int k = 0; k < static_cast<int>(4.0 * rate_hz); ++k) {
      const double t = k / rate_hz;
      run.recording.t_s.push_back(t);
      run.recording.q_cmd_rad.push_back(0.0);
      run.recording.q_rad.push_back(0.5 + 0.7 * t + 0.5 * 0.3 * t * t);
      run.recording.torque_Nm.push_back(1.0);
      run.recording.valid.push_back(true);
    }
    const std::vector<bench::BenchRun> runs = {run};
    const TorqueBalance balance(bench, runs, {});
    ASSERT_GT(balance.windows(), 10U);
    const Column one = balance.integral([](const BalancePoint&) { return 1.0; }), speed = balance.speed_rad_s(),
                 middle = balance.integral([](const BalancePoint&p) { return p.dq_rad_s; }),
                 acceleration = balance.acceleration_rad_s2();
    for (Eigen::Index i = 0; i < one.size(); ++i) {
      EXPECT_NEAR(one[i], 1.0, 1e-12) << rate_hz;
      EXPECT_NEAR(speed[i], middle[i], 1e-9) << rate_hz;
      EXPECT_NEAR(acceleration[i], 0.3, 1e-8) << rate_hz;
    }
  }
}

}  // namespace
}  // namespace pmg::evidence
