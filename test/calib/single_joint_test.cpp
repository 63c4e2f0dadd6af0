// One joint's simulation: where a rollout begins, how it swings, and which samples count.
#include "calib/single_joint.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "calib/synthetic_bench.hpp"

namespace pmg {
namespace {

/// A joint that has been told for a second to be where its reading is.
calib::SingleJoint resting(const bench::Bench& bench, double q_rad, double hangs_at_rad) {
  bench::BenchRun run;
  run.kp = 20.0, run.kd = 0.8;
  run.load = {0.02, 1.0, hangs_at_rad};
  for (int k = 0; k < 100; ++k) {
    run.recording.t_s.push_back(0.01 * k);
    run.recording.q_cmd_rad.push_back(q_rad);
    run.recording.q_rad.push_back(q_rad);
    run.recording.valid.push_back(true);
  }
  return {bench, run, calib::simulation_step_s(bench)};
}

// Of a sensor on the motor the joint's own angle is not known. Where its load hangs, it may be anywhere in the play.
TEST(SingleJoint, RestsBehindItsPlayAtTheReadingOfItsMotor) {
  constexpr double kHalfPlay_rad = 0.03;
  for (const double hangs_at_rad : {0.0, -0.4, 6.0}) {
    for (const double from_there_rad : {0.0, 0.01, -0.02, 0.032, -0.05, 0.8, -2.0}) {
      const double reading_rad = hangs_at_rad + from_there_rad;
      const calib::SingleJoint joint = resting(test::pd_bench(true), reading_rad, hangs_at_rad);
      calib::JointModel model;
      model.actuator.sensor.on_motor = 1.0;
      model.actuator.friction.coulomb_Nm = 1.5;  // holds the motor under any load
      model.actuator.transmission = {.armature_kg_m2 = 0.02,
                                     .stiffness_Nm_per_rad = 300.0,
                                     .damping_Nm_s_per_rad = 0.5,
                                     .backlash_rad = 2.0 * kHalfPlay_rad};
      for (const double q_rad : joint.rollout(model)) EXPECT_NEAR(q_rad, reading_rad, 1e-6) << from_there_rad;
      const double twist_rad = reading_rad - joint.start(model).q_rad;
      const double wound_rad = std::max(0.0, std::abs(twist_rad) - kHalfPlay_rad);
      const double load_Nm = std::abs(std::sin(joint.start(model).q_rad - hangs_at_rad));
      EXPECT_NEAR(300.0 * wound_rad, load_Nm, 1e-6) << "the shaft carries the load at " << from_there_rad;
    }
  }
}

TEST(SingleJoint, RestsOnItsFrictionUntilItIsMoved) {
  const bench::Bench bench = test::pd_bench(true);
  bench::BenchRun run;
  run.kp = 20.0, run.kd = 0.8;
  run.load = {0.02, 1.0, 0.0};
  for (int k = 0; k < 200; ++k) {
    run.recording.t_s.push_back(0.01 * k);
    run.recording.q_cmd_rad.push_back(0.5);
    run.recording.q_rad.push_back(0.465);  // 0.45 Nm of weight less 0.7 Nm of drive
    run.recording.valid.push_back(true);
  }
  const calib::SingleJoint joint(bench, run, calib::simulation_step_s(bench));
  calib::JointModel model;
  model.actuator.transmission.armature_kg_m2 = 0.02;
  model.actuator.friction.coulomb_Nm = 0.3;
  const auto moved_rad = [&] { return std::abs(joint.rollout(model).back() - 0.465); };
  EXPECT_LT(moved_rad(), 1e-9);
  model.actuator.command.delay_s = 0.03;
  EXPECT_LT(moved_rad(), 1e-9) << "told for long: nothing is underway";
  model.actuator.friction.coulomb_Nm = 0.2;
  EXPECT_GT(moved_rad(), 1e-3) << "more than friction can carry";
  model.actuator.friction.coulomb_Nm = 0.3;
  model.actuator.transmission.stiffness_Nm_per_rad = 200.0;
  model.actuator.transmission.backlash_rad = 0.02;
  EXPECT_LT(moved_rad(), 1e-9) << "on the side of its play where the weight lies, and wound by it";
}

TEST(SingleJoint, SwingsWithThePeriodOfAPendulum) {
  const bench::Bench bench = test::pd_bench(true);
  bench::BenchRun run;
  run.kp = run.kd = 0.0;
  run.load = {0.05, 2.0, 0.0};
  run.recording = test::excitation(0);
  run.recording.q_rad.assign(300, 0.05);
  const std::vector<double> q_rad = calib::SingleJoint(bench, run, 0.0005).rollout({});
  int crossings = 0;
  double last_s = 0.0, first_s = 0.0;
  for (std::size_t k = 1; k < q_rad.size(); ++k) {
    if (q_rad[k - 1] * q_rad[k] > 0.0) continue;
    last_s = run.recording.t_s[k];
    if (crossings++ == 0) first_s = last_s;
  }
  const double period_s = 2.0 * (last_s - first_s) / (crossings - 1);
  EXPECT_NEAR(period_s, 2.0 * M_PI * std::sqrt(0.05 / 2.0), 0.01) << "of small swings; samples are 10 ms apart";
}

TEST(SingleJoint, LeavesASensorsDropoutsOut) {
  const bench::Bench bench = test::pd_bench(false);
  calib::JointModel model;
  model.actuator.transmission.armature_kg_m2 = 0.02;
  bench::BenchRun run = test::record(bench, model, 1).front().run();
  run.recording.q_rad[100] = -3.14;
  run.recording.valid[100] = false;
  const calib::RolloutError error = calib::SingleJoint(bench, run, 0.002).error(model);
  EXPECT_EQ(error.samples, 299U);
  EXPECT_LT(error.mean_absolute_rad(), 1e-12);
}

TEST(SingleJoint, ABeginningIsTheRunUntilThen) {
  const bench::Bench bench = test::pd_bench(true);
  calib::JointModel model;
  model.actuator.transmission.armature_kg_m2 = 0.02;
  const calib::SingleJoint whole = test::record(bench, model, 1).front();
  const calib::SingleJoint beginning = whole.beginning(1.0);
  const std::vector<double> all_rad = whole.rollout(model), first_rad = beginning.rollout(model);
  ASSERT_EQ(first_rad.size(), 101U) << "samples are 10 ms apart";
  EXPECT_EQ(beginning.run().recording.q_rad.size(), 101U);
  EXPECT_LT(beginning.steps(), whole.steps());
  for (std::size_t k = 0; k < first_rad.size(); ++k) EXPECT_EQ(first_rad[k], all_rad[k]) << k;
  EXPECT_EQ(whole.beginning(100.0).rollout(model), all_rad);
}

}  // namespace
}  // namespace pmg
