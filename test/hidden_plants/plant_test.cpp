// The hidden plants themselves: physics that is known in closed form, and the project's own simulation as another
// witness.
#include "plant.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base_model.hpp"
#include "calib/single_joint.hpp"
#include "planting.hpp"
#include "recorder.hpp"

namespace pmg::hidden {
namespace {

PlantParameters pendulum() {
  PlantParameters p;
  p.body = {.load_inertia_kg_m2 = 0.05, .load_gravity_Nm = 2.0, .rotor_inertia_kg_m2 = 0.01};
  return p;
}

constexpr PlantCommand kFree{.enabled = false};

TEST(Plant, SwingsWithoutFrictionAtConstantEnergy) {
  Plant plant(pendulum());
  plant.reset(1.2);
  const double before_J = plant.energy_J();
  for (int k = 0; k < 100; ++k) {
    plant.advance(0.05, kFree);
    ASSERT_NEAR(plant.energy_J(), before_J, 1e-9 * before_J);  // RK4 at 1e-4 of a period: 1e-13 a swing
  }
}

TEST(Plant, KeepsTheEnergyOfASpringAndOfFlanksThatDontRub) {
  for (const double backlash_rad : {0.0, 0.05}) {
    PlantParameters p = pendulum();
    p.transmission = {.stiffness_Nm_per_rad = 200.0, .damping_Nm_s_per_rad = 0.0, .backlash_rad = backlash_rad};
    Plant plant(p);
    plant.reset(1.2);
    const double before_J = plant.energy_J();
    for (int k = 0; k < 40; ++k) plant.advance(0.05, kFree);
    EXPECT_NEAR(plant.energy_J(), before_J, 1e-4 * before_J) << backlash_rad;  // a flank's corner is met within 0.1 ms
  }
}

TEST(Plant, SmallSwingsHaveTheTextbooksPeriod) {
  Plant plant(pendulum());
  plant.reset(1e-3);
  const double period_s = 2.0 * M_PI * std::sqrt(0.06 / 2.0);
  plant.advance(period_s / 4.0, kFree);
  EXPECT_NEAR(plant.q_rad(), 0.0, 1e-8);
  plant.advance(3.0 * period_s / 4.0, kFree);
  EXPECT_NEAR(plant.q_rad(), 1e-3, 1e-8);
}

TEST(Plant, SticksUnderAnyLoadBelowItsFrictionAndNeverCreeps) {
  PlantParameters p = pendulum();
  p.friction.coulomb_Nm = 0.5;
  Plant plant(p);
  plant.reset(std::asin(0.49 / 2.0));
  const double before_rad = plant.q_rad();
  plant.advance(10.0, kFree);
  EXPECT_EQ(plant.q_rad(), before_rad);
  EXPECT_TRUE(plant.sticks());
  plant.reset(std::asin(0.51 / 2.0));
  plant.advance(0.5, kFree);
  EXPECT_LT(plant.q_rad(), std::asin(0.5 / 2.0));
}

TEST(Plant, CoulombFrictionTakesTheSameFromEachSwing) {
  PlantParameters p = pendulum();
  p.friction.coulomb_Nm = 0.002;
  Plant plant(p);
  plant.reset(0.02);
  // A spring of 2 Nm/rad and 0.002 Nm: the amplitude falls by 2 F / k a half swing, to rest within F / k.
  const double half_s = M_PI * std::sqrt(0.06 / 2.0), each_rad = 2.0 * 0.002 / 2.0;
  for (int half = 1; half <= 9; ++half) {
    plant.advance(half_s, kFree);
    EXPECT_NEAR(std::abs(plant.q_rad()), 0.02 - half * each_rad, 1e-5) << half;  // sin q is not quite q
  }
  plant.advance(5.0, kFree);
  EXPECT_TRUE(plant.sticks());
  EXPECT_LE(std::abs(plant.q_rad()), 0.001 + 1e-5);
}

TEST(Plant, LessComesOutOfAGearThanGoesIn) {
  PlantParameters p = pendulum();
  const double efficiency = 0.7, push_Nm = 1.0;
  p.body.load_gravity_Nm = 0.0;
  p.friction.load_driving = 1.0 / efficiency - 1.0;
  p.drive.limit = push_Nm;
  Plant plant(p);
  plant.advance(0.1, {.q_rad = 100.0, .kp = 1e6});
  // push = J_rotor a + J_load a / efficiency
  EXPECT_NEAR(plant.dq_rad_s(), 0.1 * push_Nm / (0.01 + 0.05 / efficiency), 1e-6);
}

TEST(Plant, BackdrivesOnlyAgainstWhatTheGearHolds) {
  PlantParameters p = pendulum();
  p.friction.load_backdriving = 0.4;
  Plant plant(p);
  plant.reset(1.0);
  plant.advance(0.01, kFree);
  // The load's torque less two fifths turns the rotor: J_load a = -2 sin q - T, J_rotor a = 0.6 T.
  const double expected_rad_s = -0.01 * 2.0 * std::sin(1.0) / (0.05 + 0.01 / 0.6);
  EXPECT_NEAR(plant.dq_rad_s(), expected_rad_s, 1e-3 * std::abs(expected_rad_s));
}

TEST(Plant, BacklashIsAsWideAsPlanted) {
  PlantParameters p = pendulum();
  p.body.load_gravity_Nm = 0.0;
  p.transmission = {.stiffness_Nm_per_rad = 1e4, .damping_Nm_s_per_rad = 2.0, .backlash_rad = 0.04};
  p.friction.viscous_Nm_s_per_rad = 0.1;
  p.drive.limit = 0.05;
  Plant plant(p);
  plant.advance(3.0, {.q_rad = 100.0, .kp = 1.0});  // pushed on one flank
  const double ahead_rad = plant.rotor_rad() - plant.q_rad();
  plant.advance(6.0, {.q_rad = -100.0, .kp = 1.0});  // and on the other
  const double behind_rad = plant.rotor_rad() - plant.q_rad();
  EXPECT_NEAR(ahead_rad - behind_rad, 0.04, 2e-5);  // the flanks give 0.05 Nm / 1e4 Nm/rad each
}

TEST(Plant, DelayIsAsLongAsPlanted) {
  for (const double delay_s : {0.0, 0.0123}) {
    PlantParameters p = pendulum();
    p.body.load_gravity_Nm = 0.0;
    p.command.delay_s = delay_s;
    p.friction.coulomb_Nm = 0.01;  // holds it until then
    Plant plant(p);
    plant.advance(0.1, {.q_rad = 0.0, .kp = 10.0});
    double moved_s = 0.0;
    while (plant.q_rad() == 0.0) {
      plant.advance(Plant::kStep_s, {.q_rad = 1.0, .kp = 10.0});
      moved_s += Plant::kStep_s;
    }
    EXPECT_NEAR(moved_s, delay_s + Plant::kStep_s, 1.01 * Plant::kStep_s);
  }
}

TEST(Plant, RateLimitTurnsAStepIntoARamp) {
  PlantParameters p = pendulum();
  p.body.load_gravity_Nm = 0.0;
  p.command.rate_limit_rad_s = 2.0;
  Plant plant(p);
  plant.advance(0.4, {.q_rad = 1.5, .kp = 2000.0, .kd = 22.0});
  const double lag_rad = 22.0 / 2000.0 * 2.0;  // a PD without commanded speed trails a ramp by kd/kp
  EXPECT_NEAR(plant.q_rad(), 0.8 - lag_rad, 2e-3);
  plant.advance(1.0, {.q_rad = 1.5, .kp = 2000.0, .kd = 22.0});
  EXPECT_NEAR(plant.q_rad(), 1.5, 1e-4);
}

TEST(Plant, DeadBandLeavesSmallErrors) {
  PlantParameters p = pendulum();
  p.body.load_gravity_Nm = 0.0;
  p.drive.dead_band_rad = 0.03;
  Plant plant(p);
  plant.advance(1.0, {.q_rad = 0.0299, .kp = 50.0});
  EXPECT_EQ(plant.q_rad(), 0.0);
  plant.advance(0.1, {.q_rad = 0.0301, .kp = 50.0});
  EXPECT_GT(plant.q_rad(), 0.0);
}

TEST(Plant, SensorPlayShowsAtReversals) {
  PlantParameters p = pendulum();
  p.sensor.play_rad = 0.02;
  Plant plant(p);
  plant.reset(0.5);
  const double period_s = 2.0 * M_PI * std::sqrt(0.06 / 2.0);
  plant.advance(period_s / 4.0, kFree);  // on its way there
  EXPECT_NEAR(plant.reading_rad() - plant.q_rad(), 0.01, 1e-9);
  plant.advance(period_s / 2.0, kFree);  // on its way back
  EXPECT_NEAR(plant.reading_rad() - plant.q_rad(), -0.01, 1e-9);
}

TEST(Plant, SlipElementsAndBristlesEndUpAtCoulombsLevel) {
  for (const bool maxwell : {false, true}) {
    PlantParameters p = pendulum();
    p.body.load_gravity_Nm = 0.0;
    p.friction.coulomb_Nm = 0.4;
    (maxwell ? p.strange.maxwell_width_rad : p.strange.lugre_width_rad) = 0.1;
    p.drive.limit = 1.0;
    Plant plant(p);
    const PlantCommand push{.q_rad = 1e6, .kp = 1.0};
    plant.advance(0.02, push);
    const double early_rad_s = plant.dq_rad_s();
    EXPECT_GT(early_rad_s, 0.9 * 0.02 * 1.0 / 0.06) << maxwell;  // hardly any friction yet
    plant.advance(0.5, push);
    const double before_rad_s = plant.dq_rad_s();
    plant.advance(0.1, push);
    EXPECT_NEAR(plant.dq_rad_s() - before_rad_s, 0.1 * (1.0 - 0.4) / 0.06, 1e-6) << maxwell;
  }
}

TEST(Plant, WarmFrictionIsLess) {
  PlantParameters p = pendulum();
  p.body.load_gravity_Nm = 0.0;
  p.friction.coulomb_Nm = 0.5;
  p.thermal.friction_per_K = -0.02;
  p.drive.limit = 1.0;
  Plant plant(p);
  plant.reset(0.0, 25.0 + 30.0);
  plant.advance(0.1, {.q_rad = 100.0, .kp = 100.0});
  EXPECT_NEAR(plant.dq_rad_s(), 0.1 * (1.0 - 0.5 * std::exp(-0.6)) / 0.06, 1e-9);
}

/// A rig without noise, and the same run in the project's simulation at the plant's step.
double difference_from_single_joint_rad(PlantParameters plant, double kd, Rig rig = {}) {
  plant.drive.limit = 20.0;
  rig.healthy = plant;
  rig.noise = {.sensor_rad = 0.0, .push_Nm = 0.0, .push_corner_s = 1.0, .start_rad = 0.0};
  const RigLoad load{1.0, 0.2, plant.body.load_inertia_kg_m2, plant.body.load_gravity_Nm};
  PlantRun run;
  run.kp = plant.drive.servo ? 8.0 : 25.0;
  run.kd = kd;
  run.load = load;
  for (int k = 0; k < 600; ++k) {
    const double t_s = k / rig.sample_rate_hz;
    run.command.q_rad.push_back(t_s < 0.2 ? 0.0 : t_s < 1.5 ? 0.9 : 0.6 * std::sin(4.0 * t_s));
  }
  const PlantRecording recording = record(plant, rig, 1, run);

  bench::Bench bench;
  bench.law = plant.drive.servo ? bench::DriveLaw::kServoVoltage : bench::DriveLaw::kPositionPd;
  bench.supply_V = rig.bus_V;
  bench::BenchRun same;
  same.kp = run.kp;
  same.kd = run.kd;
  same.load = {load.inertia_kg_m2, load.gravity_Nm};
  same.recording.t_s = recording.t_s;
  same.recording.q_cmd_rad = recording.q_cmd_rad;
  same.recording.q_rad = recording.q_rad;
  same.recording.valid.assign(recording.t_s.size(), true);
  calib::JointModel model{.actuator = nominal_model(rig)};
  model.actuator.friction.presliding_rad = 1e-5;  // the plant has none
  const std::vector<double> q_rad = calib::SingleJoint(bench, same, Plant::kStep_s).rollout(model);
  double most_rad = 0.0;
  for (std::size_t k = 0; k < q_rad.size(); ++k) most_rad = std::max(most_rad, std::abs(q_rad[k] - recording.q_rad[k]));
  return most_rad;
}

// Two formulations of the same physics: what remains is the drive's 0.1 ms and Euler's step of as much, half of each as
// a delay of the damping, on a joint that moves at up to 10 rad/s.
TEST(Plant, NeutralPlantMovesAsTheProjectsSimulationDoes) {
  EXPECT_LT(difference_from_single_joint_rad(pendulum(), 0.8), 1e-3);
}

TEST(Plant, KnownFrictionDelayServoAndSagMoveAsTheProjectsSimulationDoes) {
  PlantParameters p = pendulum();
  p.friction = {.coulomb_Nm = 0.3, .viscous_Nm_s_per_rad = 0.1, .stribeck_Nm = 0.1, .stribeck_rad_s = 0.3};
  p.command.delay_s = 0.004;
  EXPECT_LT(difference_from_single_joint_rad(p, 0.8), 1e-3);
  p.friction.load_driving = 0.2;
  p.friction.load_backdriving = 0.15;
  EXPECT_LT(difference_from_single_joint_rad(p, 0.8), 1e-3);
  PlantParameters servo = pendulum();
  servo.drive = {.servo = true, .kp_factor = 0.16, .torque_Nm_per_V = 0.3, .back_emf_V_s_per_rad = 1.2};
  Rig rig;
  rig.bus_V = 12.0;
  EXPECT_LT(difference_from_single_joint_rad(servo, 0.0, rig), 1e-3);
  servo.drive.sag_per_Nm = 0.3;  // 3.6 Nm of full duty at rest become 1.7
  EXPECT_LT(difference_from_single_joint_rad(servo, 0.0, rig), 1e-3);
}

TEST(HiddenPlants, TheSameSeedHidesTheSame) {
  const HiddenPlant a = hide(3), b = hide(3), c = hide(4);
  EXPECT_EQ(a.effects.front().name, b.effects.front().name);
  const PlantRecording first = record(a.plant, a.rig, 3, run_of(a, 0)), again = record(b.plant, b.rig, 3, run_of(b, 0));
  EXPECT_EQ(first.q_rad, again.q_rad);
  EXPECT_NE(a.rig.gains.front().kp, c.rig.gains.front().kp);
}

TEST(HiddenPlants, EveryEffectHasItsTurn) {
  const std::vector<std::string> names = planted_effects();
  for (std::uint64_t turn = 0; turn < 3; ++turn) {
    std::vector<std::string> in_turn;
    for (std::uint64_t k = 0; k < names.size(); ++k) in_turn.push_back(effect_in_turn(turn * names.size() + k));
    EXPECT_THAT(in_turn, testing::UnorderedElementsAreArray(names));
  }
}

}  // namespace
}  // namespace pmg::hidden
