// Real recordings, which are no part of the project: where they aren't there, these tests say so and are skipped.
#include <gtest/gtest.h>

#include <cmath>

#include "calib/fit_problem.hpp"
#include "recorded_benches.hpp"

namespace pmg {
namespace {

std::vector<calib::SingleJoint> joints(const bench::Bench& bench, const char* filter) {
  std::vector<calib::SingleJoint> found;
  for (bench::BenchRun& run : bench.read_runs(bench::RowFilter(filter))) {
    found.emplace_back(bench, std::move(run), calib::simulation_step_s(bench));
  }
  return found;
}

/// Fitted by pmg_calibrate_motor to kp_firmware 4, 8, 16, 32 of repeat 0.
calib::JointModel hobby_servo(const bench::Bench& bench) {
  calib::JointModel model;
  model.actuator = bench.known;
  model::ActuatorParameters& p = model.actuator;
  p.drive.kp_scale = 0.19248;
  p.drive.torque_per_unit_Nm = 0.87751;
  p.drive.back_emf_s_per_rad = 2.3475;
  p.transmission.armature_kg_m2 = 0.029751;
  p.friction.coulomb_Nm = 0.16196;
  p.friction.viscous_Nm_s_per_rad = 0.014708;
  p.friction.load_driving = 1.4626;
  p.command.delay_s = 0.027987;
  p.command.rate_limit_rad_s = 4.8961;
  return model;
}

constexpr const char* kHeldOut = "kp_firmware in 12,24 and repeat == 1";

// Open loop over 6 s, of gains and a repeat that no fit has seen. Repeats of one run differ by 9 to 10 mrad.
TEST(MeasuredBench, OfAHobbyServoIsFollowedWithin14MilliradiansOfRunsHeldOut) {
  PMG_NEEDS_BENCH("sts3215");
  const bench::Bench bench = bench::read_bench(test::recorded_bench("sts3215"));
  const calib::RolloutError error = total(calib::errors(hobby_servo(bench), joints(bench, kHeldOut), 2));
  EXPECT_EQ(error.samples, 80U * 600U - 12U) << "12 readings are dropouts";
  EXPECT_LT(error.mean_absolute_rad(), 0.0140);
}

TEST(MeasuredBench, OfAHobbyServoNeedsItsRateLimitAndItsLoadsFriction) {
  PMG_NEEDS_BENCH("sts3215");
  const bench::Bench bench = bench::read_bench(test::recorded_bench("sts3215"));
  const std::vector<calib::SingleJoint> runs = joints(bench, kHeldOut);
  const auto error_rad = [&](const char* without, double neutral) {
    calib::JointModel model = hobby_servo(bench);
    calib::set(model, without, neutral);
    return total(calib::errors(model, runs, 2)).mean_absolute_rad();
  };
  EXPECT_GT(error_rad("command.rate_limit_rad_s", std::numeric_limits<double>::infinity()), 0.018);
  EXPECT_GT(error_rad("friction.load_driving", 0.0), 0.018);
  EXPECT_GT(error_rad("command.delay_s", 0.0), 0.018);
}

TEST(MeasuredBench, OfAWarmingServoIsRead) {
  PMG_NEEDS_BENCH("xl330");
  const bench::Bench bench = bench::read_bench(test::recorded_bench("xl330"));
  EXPECT_EQ(bench.read_runs(bench::RowFilter("")).size(), 16U);
  EXPECT_EQ(bench.unknown.front(), "drive.kp_scale");
}

}  // namespace
}  // namespace pmg
