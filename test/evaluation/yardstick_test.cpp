// The ends of the error scale, and errors that are counted separately.
#include "evaluation/yardstick.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "evaluation/step_measure.hpp"
#include "evaluation/table1.hpp"
#include "pmg/blending.hpp"

namespace pmg::evaluation {
namespace {

constexpr double kTick_s = 0.01;

sil::ScenarioStep scenario_step(double start_s, double duration_s, control::Mode mode, const Command& command,
                                bool beyond_reach = false) {
  sil::ScenarioStep made;
  made.start_s = start_s;
  made.duration_s = duration_s;
  made.text = "step";
  made.mode = mode;
  made.command = command;
  made.beyond_reach = beyond_reach;
  return made;
}

Command of(Channel channel, double value) {
  Command command;
  command[channel] = value;
  return command;
}

TEST(Yardstick, DoingNothingAndFollowingAreThoseWorkedOutByHand) {
  Command both = of(kVx, 0.4);
  both[kPitch] = 0.2;
  const sil::Scenario scenario{.name = "hand",
                               .steps = {scenario_step(0.0, 1.0, control::Mode::kStand, {}),
                                         scenario_step(1.0, 4.0, control::Mode::kWalk, both)}};
  const Yardstick between = yardstick({"none", {}}, scenario, {});
  ASSERT_TRUE(between.nothing.complete);
  // Walking begins some ticks into the second step (entry into the mode), so the first one has less than 4 s.
  const double judged_s = between.nothing.judged_s;
  EXPECT_NEAR(judged_s, 5.0, 0.05);
  const double walked_s = judged_s * between.nothing.errors_raw[kLinVel] / 0.4;
  EXPECT_NEAR(walked_s, 4.0, 0.05) << "raw: 0.4 m/s in every tick of walking, nothing in standing";
  EXPECT_NEAR(between.nothing.errors_raw[kPitchError], 0.2 * walked_s / judged_s, 1e-9);
  EXPECT_NEAR(between.nothing.errors[kHeightError], 0.0, 1e-12);
  // 0.2 rad at 0.4 rad/s takes 50 ticks; after the first one 0.004 rad less is missing. It is over long before the end,
  // so averages over a gait period add up to the same, but for the few ticks in which the period itself changes.
  const double missing_rad_s = 0.2 * 0.5 - 0.004 * kTick_s * (50.0 * 51.0 / 2.0);
  EXPECT_NEAR(between.follower.errors_raw[kPitchError] * judged_s, missing_rad_s, 1e-6);
  EXPECT_NEAR(between.follower.errors[kPitchError] * judged_s, missing_rad_s, 1e-4);
  // 0.4 m/s at 0.8 m/s^2 falls 0.1 m short, and up to 1 / 0.15 of that in double support.
  const double short_m = between.follower.errors_raw[kLinVel] * judged_s;
  EXPECT_GT(short_m, 0.099);
  EXPECT_LT(short_m, 0.35);
  // The average over a gait period delays the errors by up to one period: the sum stays, less the part cut off at the
  // end.
  EXPECT_NEAR(between.nothing.errors[kLinVel] * judged_s, 0.4 * (walked_s - 0.5 * 1.1), 0.03);
  EXPECT_NEAR(between.nothing.errors[kPitchError] * judged_s, 0.2 * (walked_s - 0.5 * 1.1), 0.015);
}

TEST(Yardstick, AFollowerThatTurnsIsJudgedInItsOwnHeading) {
  Command circle = of(kVx, 0.5);
  circle[kOmega] = 0.5;
  const sil::Scenario scenario{.name = "circle",
                               .steps = {scenario_step(0.0, 1.0, control::Mode::kStand, {}),
                                         scenario_step(1.0, 12.0, control::Mode::kWalk, circle)}};
  const Yardstick between = yardstick({"none", {}}, scenario, {});
  // The heading's average over a period lags by half a period's turn: 0.28 rad times 0.5 m/s is 0.14 m/s, no more.
  EXPECT_LT(between.follower.errors[kLinVel], 0.17);
  EXPECT_LT(between.follower.errors[kYawVel], 0.06);
}

TEST(Yardstick, ShareLeftIsZeroForAFollowerAndOneForDoingNothing) {
  Yardstick between;
  between.nothing.errors = {0.5, 0.4, 0.1, 0.2, 0.0};
  between.follower.errors = {0.1, 0.1, 0.0, 0.05, 0.0};
  const Errors follower = share_left(between.follower.errors, between),
               nothing = share_left(between.nothing.errors, between);
  for (const std::size_t e : {kLinVel, kYawVel, kRollError, kPitchError}) {
    EXPECT_NEAR(follower[e], 0.0, 1e-15);
    EXPECT_NEAR(nothing[e], 1.0, 1e-15);
  }
  EXPECT_NEAR(share_left({0.2, 0.0, 0.0, 0.0, 0.0}, between)[kLinVel], 0.25, 1e-12);
  EXPECT_TRUE(std::isnan(share_left({}, between)[kHeightError])) << "nothing was asked of it";
}

/// A body that moves forward and alternates from tick to tick: its speed by +-0.1 m/s, its yaw rate by 0.1 rad/s, its
/// torso's roll and pitch by 0.1 rad, its height by 0.1 m.
model::GroundTruth going(double speed_m_s, int tick, double height_m) {
  const double off = tick % 2 == 0 ? 0.1 : -0.1;
  model::GroundTruth truth;
  truth.p_WB.z() = height_m + off;
  truth.v_WB_W.x() = speed_m_s + off;
  truth.omega_WB_B.z() = off;
  truth.q_WT = Eigen::AngleAxisd(off, Eigen::Vector3d::UnitY()) * Eigen::AngleAxisd(off, Eigen::Vector3d::UnitX());
  return truth;
}

TEST(StepMeasure, RawErrorsAndStepsBeyondReachAreKeptApart) {
  const model::RobotModel robot = model::load_robot(model::find_robot("z1"));
  const sil::Scenario scenario{.name = "hand",
                               .steps = {scenario_step(0.0, 10.0, control::Mode::kWalk, of(kVx, 0.3)),
                                         scenario_step(10.0, 10.0, control::Mode::kWalk, of(kVx, 0.8), true)}};
  StepMeasure measure(robot, scenario);
  control::TickResult result;
  result.mode = control::Mode::kWalk;
  for (int tick = 0; tick < 2000; ++tick) {
    const double time_s = tick * kTick_s;
    measure.add(time_s, result, going(0.3, tick, robot.standing_height_m), false, scenario.at(time_s + 1e-6));
  }
  TrialResult report;
  measure.report(report);
  EXPECT_NEAR(report.judged_s, 20.0, 1e-9);
  for (std::size_t e = 0; e < kErrors; ++e) {
    // Over an even number of ticks the +-0.1 cancel; the first period averages over fewer ticks.
    EXPECT_LT(report.errors[e], 0.003) << kErrorNames[e];
    EXPECT_NEAR(report.errors_raw[e], 0.1, 1e-9) << kErrorNames[e] << ": each tick is 0.1 off";
  }
  ASSERT_TRUE(report.errors_beyond_reach.has_value());
  EXPECT_NEAR((*report.errors_beyond_reach)[kLinVel], 0.5 * (1.0 - 0.5 * 0.1), 0.01) << "but for the averaging's start";
  ASSERT_EQ(report.step_errors.size(), 2U);
  EXPECT_EQ(report.step_errors[1][kLinVel], (*report.errors_beyond_reach)[kLinVel]);
}

TEST(Phases, EachWalkBeginsTheNextStepLaterAndTheCourseIsTheSame) {
  const sil::Scenario course{.name = "hand",
                             .steps = {scenario_step(0.0, 2.0, control::Mode::kStand, {}),
                                       scenario_step(2.0, 4.0, control::Mode::kWalk, of(kVx, 0.3)),
                                       scenario_step(6.0, 4.0, control::Mode::kWalk, of(kVx, -0.3)),
                                       scenario_step(10.0, 4.0, control::Mode::kWalk, of(kPitch, 0.3)),
                                       scenario_step(14.0, 4.0, control::Mode::kWalk, of(kOmega, 0.3))}};
  const std::vector<sil::Scenario> all = in_phases(course, 4);
  ASSERT_EQ(all.size(), 4U);
  for (std::size_t k = 0; k < all.size(); ++k) {
    const double later_s = 0.25 * static_cast<double>(k);
    const std::vector<sil::ScenarioStep>& steps = all[k].steps;
    ASSERT_EQ(steps.size(), course.steps.size());
    for (std::size_t s = 0; s < steps.size(); ++s) {
      EXPECT_EQ(steps[s].command.u, course.steps[s].command.u);
      EXPECT_DOUBLE_EQ(steps[s].duration_s - steps[s].unjudged_s, course.steps[s].duration_s);
      EXPECT_DOUBLE_EQ(steps[s].unjudged_s, s == 1 || s == 4 ? later_s : 0.0) << s;
    }
    EXPECT_DOUBLE_EQ(steps[2].start_s, 6.0 + later_s);
    EXPECT_DOUBLE_EQ(steps[4].start_s, 14.0 + later_s);
  }
}

TEST(Phases, WhatAStepLastsLongerIsNotJudged) {
  const model::RobotModel robot = model::load_robot(model::find_robot("z1"));
  sil::Scenario scenario{.name = "hand",
                         .steps = {scenario_step(0.0, 12.0, control::Mode::kWalk, of(kVx, 0.3)),
                                   scenario_step(12.0, 10.0, control::Mode::kWalk, of(kVx, 0.3))}};
  scenario.steps[0].unjudged_s = 2.0;
  StepMeasure measure(robot, scenario);
  control::TickResult result;
  result.mode = control::Mode::kWalk;
  for (int tick = 0; tick < 2200; ++tick) {
    const double time_s = tick * kTick_s;
    const double speed_m_s = time_s > 9.995 && time_s < 11.5 ? 5.0 : 0.3;  // until a period before the next step
    measure.add(time_s, result, going(speed_m_s, tick, robot.standing_height_m), false, scenario.at(time_s + 1e-6));
  }
  TrialResult report;
  measure.report(report);
  EXPECT_NEAR(report.judged_s, 20.0, 1e-9);
  EXPECT_NEAR(report.errors_raw[kLinVel], 0.1, 1e-9);
  ASSERT_EQ(report.step_errors.size(), 2U);
  EXPECT_NEAR(report.step_errors[0][kPitchError], report.step_errors[1][kPitchError], 0.01);
}

TEST(Phases, TheYardstickIsTheMeanOverThem) {
  Yardstick first, second;
  first.nothing.errors = {0.4};
  second.nothing.errors = {0.2};
  first.follower.errors_raw = {0.1};
  first.nothing.complete = second.nothing.complete = first.follower.complete = true;
  const Yardstick both = mean({first, second});
  EXPECT_DOUBLE_EQ(both.nothing.errors[kLinVel], 0.3);
  EXPECT_DOUBLE_EQ(both.follower.errors_raw[kLinVel], 0.05);
  EXPECT_TRUE(both.nothing.complete);
  EXPECT_FALSE(both.follower.complete);
}

TEST(Table1, OffTheGentleSequenceTheShareLeftIsJudged) {
  Table1 table;
  table.scenario = {.name = "full", .steps = {scenario_step(0.0, 1.0, control::Mode::kWalk, of(kVx, 0.5))}};
  table.cases = {{.name = "pmg", .candidate = {"none", {}}, .plants = {}}};
  Yardstick between;
  between.nothing.errors = {0.5, 0.5, 0.1, 0.1, 0.1};
  between.follower.errors = {0.1, 0.1, 0.02, 0.02, 0.02};
  between.nothing.complete = true;
  table.yardsticks = {between};
  TrialResult run;
  run.complete = true;
  run.judged_s = 1.0;
  run.errors = {0.15, 0.15, 0.035, 0.031, 0.031};  // shares 0.125, 0.125, 0.1875, 0.1375, 0.1375
  run.errors_raw = {0.2, 0.2, 0.035, 0.031, 0.031};
  table.campaign.runs = {{run, run}};
  evaluate(table);
  EXPECT_TRUE(table.all_reached());
  const nlohmann::ordered_json json = to_json(table);
  const nlohmann::ordered_json& policy = json["policies"][0];
  EXPECT_NEAR(policy["share"]["lin_vel_m_s"].get<double>(), 0.125, 1e-12);
  EXPECT_EQ(policy["nothing"]["yaw_vel_rad_s"], 0.5);
  EXPECT_EQ(policy["follower"]["roll_rad"], 0.02);
  EXPECT_NEAR(policy["errors_raw"]["lin_vel_m_s"]["mean"].get<double>(), 0.2, 1e-12);
  EXPECT_EQ(json["limits"]["of"], "share");
  table.campaign.runs[0][0].errors[kPitchError] = table.campaign.runs[0][1].errors[kPitchError] = 0.034;  // 0.175
  evaluate(table);
  EXPECT_FALSE(table.reached(kPitchError));
  EXPECT_TRUE(table.reached(kRollError)) << "its limit is 0.2";
}

TEST(Scenario, TheFullTableStaysWithinReachButForWhatSaysSo) {
  const sil::Scenario scenario = sil::load_scenario("config/scenarios/table1_full.yaml");
  const model::RobotModel robot = model::load_robot(model::find_robot("z1"));
  int beyond = 0;
  std::array<bool, 2 * kChannels> end_met{};
  for (const sil::ScenarioStep& one : scenario.steps) {
    double sum = 0.0;
    for (std::size_t c = 0; c < kChannels; ++c) {
      const double u = one.command.u[c];
      const double end = u < 0.0 ? robot.command_limits.lower[c] : robot.command_limits.upper[c];
      if (c < kVelocityChannels && u != 0.0) sum += u / end;
      if (u != 0.0 && std::abs(u - end) < 1e-9) end_met[2 * c + (u < 0.0 ? 1U : 0U)] = true;
    }
    EXPECT_EQ(one.beyond_reach, sum > kCornerReach + 1e-9) << one.text;
    beyond += one.beyond_reach ? 1 : 0;
  }
  EXPECT_GE(beyond, 5);
  for (std::size_t i = 0; i < end_met.size(); ++i) {
    const double end = i % 2 == 0 ? robot.command_limits.upper[i / 2] : robot.command_limits.lower[i / 2];
    EXPECT_TRUE(end_met[i] || end == 0.0) << kChannelNames[i / 2] << (i % 2 == 0 ? " up" : " down");
  }
}

}  // namespace
}  // namespace pmg::evaluation
