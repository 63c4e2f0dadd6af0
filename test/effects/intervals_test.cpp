// Intervals of a fit's numbers where rollouts jump, and where the simulation's step is coarse.
#include "effects/intervals.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "calib/step_choice.hpp"
#include "calib/synthetic_bench.hpp"
#include "calib/unknown.hpp"
#include "effects/alike_numbers.hpp"
#include "effects/folds.hpp"
#include "fitting/covariance.hpp"
#include "fitting/f_distribution.hpp"

namespace pmg::effects {
namespace {

constexpr double kNoise_rad = 1e-4, kNoise_rad2 = kNoise_rad * kNoise_rad, kDelay_s = 0.02;

calib::JointModel dry_joint() { return test::plain_joint(0.2); }

calib::JointModel delayed_joint() {
  calib::JointModel model = dry_joint();
  model.actuator.friction.coulomb_Nm = 0.0;
  model.actuator.command.delay_s = kDelay_s;
  return model;
}

/// Fits of one number.
struct Fitted {
  bench::Bench bench = test::pd_bench(true);
  calib::JointModel truth;
  NestedFit fit;
  calib::Unknown number;

  Fitted(const char* name, double recorded_step_s, double fitted_step_s, calib::JointModel joint = dry_joint())
      : truth(joint),
        fit(calib::with_step(bench, test::record(bench, truth, 4, kNoise_rad, 1, recorded_step_s), fitted_step_s), 1),
        number(unknown(name, bench, scale_of(bench, fit.runs(), truth))) {}

  NestedModel from(double value) const {
    calib::JointModel start = truth;
    calib::set(start, number.name, value);
    NestedModel model = fit.fit(start, {number}, 15);
    fit.linearise(model);
    return model;
  }
  evidence::Interval interval(const NestedModel& model) const {
    return parameter_intervals(model, folds(fit), kNoise_rad2).front();
  }
};

TEST(WideDifferences, AreAsWideAsTheNumberIsUnsure) {
  Fitted of("friction.coulomb_Nm", 1e-3, 1e-3);
  of.number.difference = 1e-9;  // a joint that sticks doesn't feel it, or jumps by it
  const NestedModel narrow = of.from(0.21);
  const NestedModel wide = with_wide_differences(of.fit, narrow, folds(of.fit), kNoise_rad2);
  EXPECT_LE(wide.squares, narrow.squares);
  const double deviation = coordinate_deviations(wide, folds(of.fit), kNoise_rad2)[0];
  EXPECT_GT(wide.unknowns.front().difference, 0.3 * deviation);
  EXPECT_EQ(wide.ranges.front().step, wide.unknowns.front().difference);
  const evidence::Interval found = of.interval(wide);
  EXPECT_LT(found.low, 0.2);
  EXPECT_GT(found.high, 0.2);
}

TEST(WideDifferences, StayWhereTheyAreWideEnough) {
  Fitted of("friction.coulomb_Nm", 1e-3, 1e-3);
  of.number.difference = 0.05;  // far wider than what these runs leave open
  const NestedModel fitted = of.from(0.21);
  EXPECT_EQ(with_wide_differences(of.fit, fitted, folds(of.fit), kNoise_rad2).unknowns.front().difference, 0.05);
}

TEST(Intervals, HaveAWidthWhereTheFitEndsAtTheEdgeOfItsRange) {
  Fitted of("friction.coulomb_Nm", 1e-3, 1e-3);
  of.number.upper = 0.19;
  const NestedModel at_upper = of.from(0.1);
  ASSERT_EQ(at_upper.model.actuator.friction.coulomb_Nm, of.number.upper);
  const evidence::Interval upper = of.interval(at_upper);
  EXPECT_LT(upper.low, 0.99 * upper.value);
  EXPECT_GT(upper.low, 0.5 * upper.value) << "these runs show friction well";
  EXPECT_EQ(upper.high, of.number.upper) << "beyond its range nothing is said";
  Fitted none("friction.viscous_Nm_s_per_rad", 1e-3, 1e-3);
  none.truth.actuator.friction.viscous_Nm_s_per_rad = 0.0;
  none.number.lower = 0.0;
  const NestedModel at_zero = none.fit.fit(none.truth, {none.number}, 0);
  NestedModel linearised = at_zero;
  none.fit.linearise(linearised);
  const evidence::Interval zero = none.interval(linearised);
  EXPECT_EQ(zero.low, 0.0);
  EXPECT_GT(zero.high, 0.0);
}

TEST(Intervals, AreToldWiderThanTheyDecideWithinTheirRange) {
  Fitted of("friction.coulomb_Nm", 1e-3, 1e-3);
  of.number.lower = 0.17, of.number.upper = 10.0;
  const NestedModel fitted = of.from(0.21);
  IntervalOptions options;
  options.told_width = 2.0;
  const double value = fitted.model.actuator.friction.coulomb_Nm;
  const evidence::Interval found = told({{value, value - 0.01, value + 0.02}}, fitted, options).front();
  EXPECT_NEAR(found.low, value - 0.02, 1e-12);
  EXPECT_NEAR(found.high, value + 0.04, 1e-12);
  EXPECT_EQ(found.value, value);
  EXPECT_EQ(told({{value, value - 0.1, value}}, fitted, options).front().low, value - 0.1) << "where it was beyond";
  EXPECT_EQ(told({{value, 0.171, value}}, fitted, options).front().low, 0.17);
}

/// A constant torque and friction that differs by direction are the same torque.
TEST(Intervals, ReachOnAsFarAsTheOtherNumbersMakeUpForIt) {
  const bench::Bench bench = test::pd_bench(true);
  const NestedFit fit(test::record(bench, dry_joint(), 4, 20.0 * kNoise_rad), 1);
  const BenchScale scale = scale_of(bench, fit.runs(), dry_joint());
  const auto half_widths = [&](const std::vector<std::string>& names, const std::vector<std::string>& reaching_on) {
    calib::Unknowns unknowns;
    for (const std::string& name : names) unknowns.push_back(unknown(name, bench, scale));
    NestedModel model = fit.fit(dry_joint(), unknowns, 10);
    fit.linearise(model);
    std::vector<evidence::Interval> narrow;
    for (std::size_t i = 0; i < names.size(); ++i) {
      const double value = unknowns[i].value(model.coordinates[static_cast<Eigen::Index>(i)]);
      narrow.push_back({value, value - 0.05, value + 0.05});
    }
    const evidence::Interval offset = reaching(fit, model, narrow, reaching_on).front();
    return std::pair(offset.value - offset.low, offset.high - offset.value);
  };
  const auto alone = half_widths({"ripple.offset_Nm"}, {"ripple.offset_Nm"});
  EXPECT_NEAR(alone.first, 0.05, 1e-9) << "0.05 Nm are far more than noise hides";
  EXPECT_NEAR(alone.second, 0.05, 1e-9);
  const auto beside = half_widths({"ripple.offset_Nm", "friction.asymmetry"}, {"ripple.offset_Nm"});
  EXPECT_NEAR(beside.first, 0.15, 1e-9) << "three times as wide";
  EXPECT_NEAR(beside.second, 0.15, 1e-9);
  const auto other = half_widths({"ripple.offset_Nm", "friction.asymmetry"}, {"friction.asymmetry"});
  EXPECT_NEAR(other.first, 0.05, 1e-9) << "of the parameters that are asked for";
}

// Euler's steps of 4 ms act like 2 ms less delay; a fit makes up for them.
TEST(Intervals, AreStudentsWithTheBlocksThatDetermineTheNumber) {
  const Fitted of("friction.coulomb_Nm", 1e-3, 1e-3);
  const NestedModel fitted = of.from(0.21);
  const double freedom = fitting::effective_blocks(fitted, fitting::cluster_robust_covariance(fitted, {0}))[0];
  EXPECT_LT(freedom, 0.9 * static_cast<double>(fitted.blocks.size())) << "not every block shows dry friction alike";
  const evidence::Interval found = of.interval(fitted);
  const double deviation = coordinate_deviations(fitted, folds(of.fit), kNoise_rad2)[0];
  EXPECT_NEAR(found.high - found.value, fitting::student95(freedom) * deviation + 0.03 * found.value, 1e-9);
}

TEST(Chance, OfTwoNumbersThatDoTheSameBothMayBeUnsureAndTheirSumSure) {
  const bench::Bench bench = test::pd_bench(true);
  const std::vector<calib::SingleJoint> runs = test::record(bench, dry_joint(), 1, kNoise_rad);
  NestedModel model;
  for (const char* name : {"friction.load_driving", "friction.load_backdriving"})
    model.unknowns.push_back(unknown(name, bench, scale_of(bench, runs, dry_joint())));
  model.ranges = calib::ranges(model.unknowns);
  model.coordinates = Eigen::Vector2d(0.3, 0.3);
  model = test::with_alike_numbers(model, 100);
  const Eigen::VectorXd none = Eigen::Vector2d::Zero();
  for (const evidence::Interval& each : parameter_intervals(model, {}, 1.0)) EXPECT_LE(each.low, 0.0);
  EXPECT_LT(chance_of(model, {0, 1}, none, 1.0), 1e-4);
  EXPECT_GT(chance_of(model, {1}, none.head(1), 1.0), 0.2) << "one alone may be none";
  EXPECT_GT(chance_of(model, {0, 1}, Eigen::Vector2d(0.9, -0.3), 1.0), 0.2) << "their sum is what is sure";
  model.coordinates = Eigen::Vector2d(0.03, 0.03);
  EXPECT_GT(chance_of(model, {0, 1}, none, 1.0), 0.2);
  model.coordinates = none;
  EXPECT_EQ(chance_of(model, {0, 1}, none, 1.0), 1.0) << "both at the end of their ranges";
}

TEST(StepShift, ReachesFromACoarseStepsNumberToTheTruth) {
  const Fitted of("command.delay_s", 1e-4, 4e-3, delayed_joint());
  NestedModel fitted = of.from(0.02);
  const evidence::Interval before = of.interval(fitted);
  fitted.step_shift = step_shift(of.bench, of.fit, fitted);
  ASSERT_EQ(fitted.step_shift.size(), 1);
  const evidence::Interval after = of.interval(fitted);
  EXPECT_GT(before.low, kDelay_s) << "the step alone biases it";
  EXPECT_LT(after.low, kDelay_s);
  EXPECT_GT(after.high, kDelay_s);
}

TEST(StepShift, IsSmallWithAFineStep) {
  const Fitted of("command.delay_s", 1e-4, 2e-4, delayed_joint());
  const NestedModel fitted = of.from(0.02);
  const evidence::Interval found = of.interval(fitted);
  EXPECT_LT(std::abs(step_shift(of.bench, of.fit, fitted)[0]), found.high - found.low);
}

}  // namespace
}  // namespace pmg::effects
