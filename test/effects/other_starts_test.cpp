// Fits from other values of a parameter, where rollouts' squares have more than one minimum.
#include "effects/other_starts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "calib/synthetic_bench.hpp"
#include "effects/unknowns.hpp"

namespace pmg::effects {
namespace {

constexpr int kIterations = 12;

calib::JointModel joint_with(double update_s, double order) {
  calib::JointModel model = test::plain_joint(0.05);
  model.actuator.command.update_s = update_s;
  model.actuator.ripple.amplitude_Nm = order > 0.0 ? 0.4 : 0.0;
  model.actuator.ripple.order = order > 0.0 ? order : model.actuator.ripple.order;
  return model;
}

NestedFit recorded(const calib::JointModel& truth) { return {test::record(test::pd_bench(true), truth, 6, 1e-4), 1}; }

calib::Unknowns unknowns(const NestedFit& fit, const std::vector<std::string>& parameters) {
  const bench::Bench bench = test::pd_bench(true);
  const BenchScale scale = scale_of(bench, fit.runs(), joint_with(0.0, 0.0));
  calib::Unknowns found;
  for (const std::string& parameter : parameters) found.push_back(unknown(parameter, bench, scale));
  return found;
}

TEST(OtherStarts, LeadOutOfAMinimumBesideTheBest) {
  const NestedFit fit = recorded(joint_with(0.0, 9.0));
  const std::vector<std::string> parameters = {"ripple.amplitude_Nm", "ripple.order", "ripple.phase_rad"};
  for (const auto& [order, phase_rad] : {std::pair(8.4, 2.0), {10.4, 2.0}, {12.8, 0.0}}) {
    calib::JointModel start = joint_with(0.0, order);
    start.actuator.ripple.phase_rad = phase_rad;
    const NestedModel beside = fit.fit(start, unknowns(fit, parameters), kIterations);
    ASSERT_GT(std::abs(beside.model.actuator.ripple.order - 9.0), 0.5) << "a fit alone ends beside it";
    const NestedModel best = from_other_starts(fit, beside, parameters, kIterations);
    EXPECT_NEAR(best.model.actuator.ripple.order, 9.0, 0.1);
    EXPECT_LT(best.squares, 0.05 * beside.squares);
    EXPECT_FALSE(best.blocks.empty()) << "it is linearised";
  }
}

TEST(OtherStarts, FindThePeriodOfAHold) {
  const NestedFit fit = recorded(joint_with(0.067, 0.0));
  const NestedModel beside = fit.fit(joint_with(0.0575, 0.0), unknowns(fit, {"friction.coulomb_Nm"}), kIterations);
  const NestedModel best = from_other_starts(fit, beside, {"command.update_s"}, kIterations);
  EXPECT_NEAR(best.model.actuator.command.update_s, 0.067, 0.0005);
}

/// Ten runs, of which a few are looked at; a damping makes up for half of the period.
TEST(OtherStarts, FindAPeriodOnAFewRunsForAllOfThem) {
  calib::JointModel truth = joint_with(0.0, 0.0);
  truth.actuator.sensor.hold_s = 0.018;
  const NestedFit fit(test::record(test::pd_bench(true), truth, 10, 1e-4), 1);
  calib::JointModel start = joint_with(0.0, 0.0);
  start.actuator.sensor.hold_s = 0.008;
  const NestedModel shorter = fit.fit(start, unknowns(fit, {"drive.kd_scale"}), kIterations);
  ASSERT_LT(shorter.model.actuator.drive.kd_scale, 0.93);
  const NestedModel best = from_other_periods(fit, shorter, {"sensor.hold_s"}, kIterations);
  EXPECT_NEAR(best.model.actuator.sensor.hold_s, 0.018, 0.002) << "a step of the simulation";
  EXPECT_NEAR(best.model.actuator.drive.kd_scale, 1.0, 0.05);
  EXPECT_LT(best.squares, 0.05 * shorter.squares);
  EXPECT_FALSE(best.blocks.empty()) << "it is linearised, on all runs";
  EXPECT_EQ(from_other_periods(fit, shorter, {}, kIterations).coordinates, shorter.coordinates);
}

TEST(OtherStarts, LeaveTheBestFitAsItIs) {
  const NestedFit fit = recorded(joint_with(0.0, 9.0));
  const std::vector<std::string> parameters = {"ripple.amplitude_Nm", "ripple.order", "ripple.phase_rad"};
  const NestedModel best = fit.fit(joint_with(0.0, 9.0), unknowns(fit, parameters), kIterations);
  EXPECT_EQ(from_other_starts(fit, best, parameters, kIterations).coordinates, best.coordinates);
}

}  // namespace
}  // namespace pmg::effects
