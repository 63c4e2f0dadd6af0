#include "effects/nested_fit.hpp"

#include <gtest/gtest.h>

#include "calib/synthetic_bench.hpp"
#include "calib/unknown.hpp"
#include "effects/folds.hpp"
#include "effects/intervals.hpp"

namespace pmg::diagnosis {
namespace {

calib::JointModel healthy() {
  calib::JointModel model;
  model.actuator.transmission.armature_kg_m2 = 0.01;
  model.actuator.friction.viscous_Nm_s_per_rad = 0.1;
  return model;
}

struct Setting {
  bench::Bench bench = test::pd_bench(true);
  effects::NestedFit fit;
  effects::BenchScale scale;
  explicit Setting(const calib::JointModel& truth)
      : fit(test::record(bench, truth, 4, 1e-4), 1), scale(effects::scale_of(bench, fit.runs(), healthy())) {}
};

TEST(NestedFit, FindsFrictionAndDelayWithinTheirIntervals) {
  calib::JointModel truth = healthy();
  truth.actuator.friction.coulomb_Nm = 0.3;
  truth.actuator.command.delay_s = 0.012;
  const Setting s(truth);
  effects::NestedModel fitted = s.fit.fit(healthy(),
                                          {effects::unknown("friction.coulomb_Nm", s.bench, s.scale),
                                           effects::unknown("command.delay_s", s.bench, s.scale)},
                                          20);
  s.fit.linearise(fitted);
  const std::vector<evidence::Interval> found = parameter_intervals(fitted, folds(s.fit), 1e-8);
  EXPECT_LT(found[0].low, 0.3);
  EXPECT_GT(found[0].high, 0.3);
  EXPECT_LT(found[1].low, 0.012);
  EXPECT_GT(found[1].high, 0.012);
  EXPECT_LT(found[0].high - found[0].low, 0.1 * 0.3);
}

TEST(NestedFit, NeverEndsWorseThanItsStart) {
  const Setting s(healthy());
  calib::JointModel start = healthy();
  const double before = fitting::sum_of_squares(s.fit.residuals(start));
  for (const char* name : {"friction.coulomb_Nm", "command.rate_limit_rad_s", "drive.kp_scale"}) {
    // Within the range of the unknown: an infinite rate limit begins at its end.
    const calib::Unknown u = effects::unknown(name, s.bench, s.scale);
    calib::JointModel inside = start;
    calib::set(inside, name, u.value(u.coordinate(calib::value(start, name))));
    EXPECT_LE(s.fit.fit(inside, {u}, 5).squares, fitting::sum_of_squares(s.fit.residuals(inside))) << name;
  }
  EXPECT_LE(s.fit.fit(start, {}, 5).squares, before);
}

// What pushes a joint away from a place is its load or a form that the search lacks.
TEST(NestedFit, ASpringPullsAndNeverPushes) {
  for (const double spring_Nm_per_rad : {0.8, -0.8}) {
    calib::JointModel truth = healthy();
    truth.actuator.ripple.spring_Nm_per_rad = spring_Nm_per_rad;
    const Setting s(truth);
    const auto found = s.fit.fit(healthy(), {effects::unknown("ripple.spring_Nm_per_rad", s.bench, s.scale)}, 20);
    EXPECT_NEAR(found.model.actuator.ripple.spring_Nm_per_rad, std::max(0.0, spring_Nm_per_rad), 0.02);
  }
}

TEST(NestedFit, StepsStayInTheRangesAndTheOthersMakeUpForIt) {
  Eigen::Matrix2d information;
  information << 1.0, 0.5, 0.5, 1.0;
  const Eigen::Vector2d gradient(-3.0, 0.0), at(0.0, 0.0);
  const fitting::Coordinate x{.lower = -1.0, .upper = 1.0};
  const Eigen::VectorXd step = fitting::bounded_step(information, gradient, {x, x}, at, 0.0);
  EXPECT_DOUBLE_EQ(step[0], 1.0);
  EXPECT_NEAR(step[1], -0.5, 1e-6);  // the optimum along the edge
}

TEST(Folds, LeaveOutEachGainEachLoadAndEachTrajectory) {
  const Setting s(healthy());
  std::size_t gains = 0, loads = 0, trajectories = 0;
  for (const fitting::Fold& fold : folds(s.fit)) {
    gains += fold.name == "gain" ? 1 : 0;
    loads += fold.name == "load" ? 1 : 0;
    trajectories += fold.name == "trajectory" ? 1 : 0;
    EXPECT_FALSE(fold.blocks.empty());
  }
  EXPECT_EQ(gains, 4U);  // kp and kd of the synthetic bench
  EXPECT_EQ(loads, 4U);
  EXPECT_EQ(trajectories, 4U);
}

TEST(Folds, WhatOnlyFitsNoiseGainsNothingOnBlocksLeftOut) {
  const Setting s(healthy());
  const std::vector<fitting::Fold> left_out = folds(s.fit);
  effects::NestedModel base = s.fit.fit(healthy(), {}, 1);
  effects::NestedModel extended = s.fit.fit(healthy(), {effects::unknown("ripple.offset_Nm", s.bench, s.scale)}, 10);
  s.fit.linearise(base);
  s.fit.linearise(extended);
  const fitting::BlockComparison compare(s.fit.blocks(), left_out, 1e-8);
  const fitting::Comparison found =
      compare(s.fit.held_out_squares(base, left_out), s.fit.held_out_squares(extended, left_out));
  EXPECT_LT(found.deviations, 2.5);
  EXPECT_LT(found.log_gain, 0.02);
}

}  // namespace
}  // namespace pmg::diagnosis
