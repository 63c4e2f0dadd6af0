#include "evaluation/trial.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "evaluation/campaign.hpp"
#include "evaluation/push.hpp"
#include "evaluation/table1.hpp"
#include "evaluation/table2.hpp"

namespace pmg::evaluation {
namespace {

sil::ScenarioStep step(double start_s, double duration_s, control::Mode mode, const Command& command) {
  return {.start_s = start_s,
          .duration_s = duration_s,
          .text = "step",
          .mode = mode,
          .command = command,
          .hoist_without_policy = false};
}

sil::Scenario standing(double duration_s) {
  return {.name = "standing", .steps = {step(0.0, duration_s, control::Mode::kStand, {})}};
}

/// No policy balances: the drives follow the reference, which stands but can't walk.
Candidate without_policy() { return {"none", {.clips = {}, .policy = "none"}}; }

Plants varied() {
  Plants plants;
  plants.ranges = sim::load_variation_ranges("config/evaluation/variation.yaml");
  return plants;
}

TEST(Trial, StandingIsJudgedFromTheFirstTickOfStanding) {
  const TrialResult result = run_trial(without_policy(), standing(2.0), {}, {});
  EXPECT_TRUE(result.survived());
  EXPECT_NEAR(result.duration_s, 2.0, 1e-9);
  EXPECT_NEAR(result.judged_s, 2.0, 0.05) << "the first ticks find the robot's state";
  EXPECT_LT(result.errors[kPitchError], 0.05);
  ASSERT_EQ(result.step_errors.size(), 1U);
  for (std::size_t e = 0; e < kErrors; ++e) EXPECT_NEAR(result.step_errors[0][e], result.errors[e], 1e-12);
}

TEST(Trial, OnTheGantryNothingIsJudged) {
  const TrialResult result =
      run_trial(without_policy(), standing(0.5), {}, {.gantry = true, .progress = {}, .observer = {}});
  EXPECT_EQ(result.judged_s, 0.0);
  ASSERT_EQ(result.step_errors.size(), 1U);
  EXPECT_TRUE(std::isnan(result.step_errors[0][kLinVel]));
}

// No robot survives this push. The last step lies wholly after the fall, and the step before it has the same velocity
// command, so averages over a gait period contain nothing else.
TEST(Trial, AfterAFallVelocityAndHeightAreZeroAndTheRunGoesOnToItsEnd) {
  Command command;
  command[kVx] = 0.3;
  command[kVy] = -0.1;
  command[kOmega] = 0.2;
  command[kHeight] = -0.05;
  const sil::Scenario scenario{
      .name = "fall",
      .steps = {step(0.0, 0.5, control::Mode::kStand, {}), step(0.5, 4.0, control::Mode::kWalk, command),
                step(4.5, 1.0, control::Mode::kWalk, command)}};
  double standing_height_m = 0.0;
  const TrialObserver shove = [&](const sil::RunProgress& now, sim::World& world) {
    if (now.time_s < 0.1) standing_height_m = world.truth().p_WB.z();
    world.set_push(Eigen::Vector3d(now.time_s > 0.6 && now.time_s < 0.9 ? 900.0 : 0.0, 0.0, 0.0));
    return true;
  };
  const TrialResult result =
      run_trial(without_policy(), scenario, {}, {.gantry = false, .progress = {}, .observer = shove});
  ASSERT_TRUE(result.fell);
  ASSERT_LT(result.fell_at_s, 3.0) << "the last step must not see the fall";
  EXPECT_FALSE(result.survived());
  EXPECT_NEAR(result.duration_s, 5.5, 1e-9);
  ASSERT_EQ(result.step_errors.size(), 3U);
  const Errors& lying = result.step_errors[2];
  EXPECT_NEAR(lying[kLinVel], std::hypot(0.3, 0.1), 1e-9);
  EXPECT_NEAR(lying[kYawVel], 0.2, 1e-9);
  EXPECT_NEAR(lying[kHeightError], standing_height_m - 0.05, 0.02) << "of the pelvis above ground, absolute";
  EXPECT_GT(std::max(lying[kPitchError], lying[kRollError]), 0.5) << "attitude as it lies";
}

TEST(Trial, AnObserverEndsIt) {
  const TrialObserver at_once = [](const sil::RunProgress& now, sim::World&) { return now.time_s < 0.1; };
  const TrialResult result =
      run_trial(without_policy(), standing(5.0), {}, {.gantry = false, .progress = {}, .observer = at_once});
  EXPECT_TRUE(result.complete);
  EXPECT_LT(result.duration_s, 0.2);
}

TEST(Trial, AnInterruptedOneIsNotComplete) {
  const TrialResult result =
      run_trial(without_policy(), standing(5.0), {},
                {.gantry = false, .progress = {.report = {}, .interrupted = [] { return true; }}, .observer = {}});
  EXPECT_FALSE(result.complete);
  EXPECT_FALSE(result.survived());
}

/// CMU's subject 69: a policy whose clips come with its name.
Candidate another_person() { return {"cmu69", {.clips = {}, .policy = "cmu69"}}; }

TEST(AnotherPersonsStyle, WalksBackAndForthSidewaysAndTurnsByThePolicysNameAlone) {
  const auto walk = [](double start_s, Channel channel, double value) {
    Command command;
    command[channel] = value;
    return step(start_s, 3.0, control::Mode::kWalk, command);
  };
  const sil::Scenario scenario = {
      .name = "all ways",
      .steps = {step(0.0, 1.5, control::Mode::kStand, {}), walk(1.5, kVx, 0.7), walk(4.5, kVx, -0.4),
                walk(7.5, kVy, 0.3), walk(10.5, kVy, -0.3), walk(13.5, kOmega, 0.7), walk(16.5, kOmega, -0.7)}};
  const TrialResult result = run_trial(another_person(), scenario, {}, {});
  EXPECT_TRUE(result.survived()) << "fell at " << result.fell_at_s << " s";
  // Commands jump from end to end here, which their rate limits alone answer with errors of this size.
  EXPECT_LT(result.errors[kLinVel], 0.20);
  EXPECT_LT(result.errors[kYawVel], 0.20);
  EXPECT_LT(result.errors[kRollError], 0.04);
  EXPECT_LT(result.errors[kPitchError], 0.04);
}

TEST(AnotherPersonsStyle, WalksTheTourOnRobotsThatDiffer) {
  const sil::Scenario tour = sil::load_scenario("config/scenarios/tour.yaml");
  Plants plants;
  plants.ranges = sim::load_variation_ranges("training/randomization.yaml");
  const CampaignRuns campaign =
      run_campaign({{.name = "cmu69", .candidate = another_person(), .plants = plants}}, {tour}, 4, false, {.jobs = 2});
  ASSERT_EQ(campaign.runs[0].size(), 4U);
  for (const TrialResult& result : campaign.runs[0]) EXPECT_TRUE(result.survived()) << result.fell_at_s;
}

TEST(Campaign, ASeedIsTheSameRobotForEveryCaseAndResultsDontDependOnJobs) {
  const std::vector<Case> cases = {{.name = "a", .candidate = without_policy(), .plants = varied()},
                                   {.name = "b", .candidate = without_policy(), .plants = varied()}};
  const auto run = [&](int jobs) { return run_campaign(cases, {standing(0.6)}, 3, false, {.jobs = jobs}); };
  const CampaignRuns alone = run(1), together = run(3);
  ASSERT_TRUE(alone.complete);
  for (std::size_t seed = 0; seed < 3; ++seed) {
    EXPECT_EQ(alone.runs[0][seed].errors, alone.runs[1][seed].errors) << "paired";
    for (std::size_t c = 0; c < 2; ++c) EXPECT_EQ(alone.runs[c][seed].errors, together.runs[c][seed].errors);
  }
  EXPECT_NE(alone.runs[0][0].errors, alone.runs[0][1].errors) << "another seed is another robot";
  const Comparison comparison = compare(cases[0], alone.runs[0], cases[1], alone.runs[1]);
  EXPECT_EQ(comparison.pairs, 3);
  EXPECT_EQ(comparison.difference[kPitchError].mean, 0.0);
  EXPECT_FALSE(comparison.difference[kPitchError].excludes_zero());
}

TEST(Campaign, OnlyWhatBothHaveEndedIsPaired) {
  TrialResult done;
  done.complete = true;
  std::vector<TrialResult> a(3, done), b(3, done);
  a[0].errors[kRollError] = 1.0;
  b[0].complete = false;
  const Case c{.name = "c", .candidate = without_policy(), .plants = {}};
  const Comparison comparison = compare(c, a, c, b);
  EXPECT_EQ(comparison.pairs, 2);
  EXPECT_EQ(comparison.difference[kRollError].mean, 0.0);
}

TEST(Campaign, SummaryCountsFallsAndAveragesOverSeeds) {
  std::vector<TrialResult> runs(4);
  for (std::size_t seed = 0; seed < 3; ++seed) {
    runs[seed].complete = true;
    runs[seed].judged_s = 1.0;
    runs[seed].errors[kLinVel] = 0.1 * static_cast<double>(seed + 1);
    runs[seed].step_errors = {Errors{static_cast<double>(seed)}};
  }
  runs[1].fell = true;
  runs[2].faults = {"a fault"};
  runs[3].errors[kLinVel] = 100.0;  // interrupted, so not counted
  const CaseSummary summary = summarise(runs);
  EXPECT_EQ(summary.trials, 3);
  EXPECT_EQ(summary.falls, 1);
  EXPECT_EQ(summary.survived, 1);
  EXPECT_NEAR(summary.errors[kLinVel].mean, 0.2, 1e-12);
  ASSERT_EQ(summary.step_errors.size(), 1U);
  EXPECT_NEAR(summary.step_errors[0][kLinVel], 1.0, 1e-12);
}

TEST(Push, TheImpulseAskedIsTheImpulseGiven) {
  const model::RobotModel robot = model::load_robot(model::find_robot("z1"));
  sim::World world(robot, {});
  mjData* data = world.mj_data();
  data->qpos[2] += 3.0;  // in free fall, so that nothing else pushes sideways
  mj_forward(world.mj_model(), data);
  const JointVector zero = JointVector::Zero(robot.joint_index.size());
  const model::JointCommand limp{.bus_sample = 0, .q = zero, .dq = zero, .kp = zero, .kd = zero, .tau_ff = zero};
  const PushPlan plan{.direction = 1, .walking = false, .at_s = 0.05};
  constexpr double kImpulse_N_s = 20.0;
  Pusher pusher(plan, kImpulse_N_s);
  const sil::ScenarioStep scenario_step = step(0.0, 1.0, control::Mode::kStand, {});
  const control::TickResult result;
  for (int tick = 0; tick < 30; ++tick) {
    pusher({0.01 * tick, 1.0, scenario_step, result}, world);
    for (int s = 0; s < 5; ++s) world.step(limp);
  }
  mj_subtreeVel(world.mj_model(), data);
  const Eigen::Vector3d velocity(data->subtree_linvel[3], data->subtree_linvel[4], data->subtree_linvel[5]);
  const Eigen::Vector2d momentum = robot.total_mass_kg * velocity.head<2>();
  EXPECT_NEAR(momentum.x(), kImpulse_N_s * std::cos(plan.direction_rad()), 0.01 * kImpulse_N_s);
  EXPECT_NEAR(momentum.y(), kImpulse_N_s * std::sin(plan.direction_rad()), 0.01 * kImpulse_N_s);
}

TEST(Push, SixteenTrialsMeetEveryDirectionStandingAndWalking) {
  std::array<std::array<int, 2>, kPushDirections> met{};
  double earliest = 1e9, latest = 0.0;
  for (int trial = 0; trial < 16; ++trial) {
    const PushPlan plan = PushPlan::of(trial);
    ++met[static_cast<std::size_t>(plan.direction)][plan.walking ? 1 : 0];
    earliest = std::min(earliest, plan.at_s);
    latest = std::max(latest, plan.at_s);
    EXPECT_EQ(push_scenario(plan).steps[1].command[kVx] > 0.0, plan.walking);
    EXPECT_NEAR(push_scenario(plan).duration_s(), plan.at_s + 4.0, 1e-9);
  }
  for (const auto& direction : met) EXPECT_EQ(direction, (std::array{1, 1}));
  EXPECT_GT(latest - earliest, 0.5) << "moments spread over a gait period";
}

TEST(Table1, LimitsAndThePapersFiguresAreThoseOfThePolicyByName) {
  Table1 table;
  table.scenario = standing(1.0);
  table.scenario.name = kGentleScenario;
  table.yardsticks.resize(2);
  table.cases = {{.name = "without_gco", .candidate = without_policy(), .plants = {}},
                 {.name = "pmg", .candidate = without_policy(), .plants = {}}};
  TrialResult good;
  good.complete = true;
  good.judged_s = 1.0;
  good.errors = {0.05, 0.07, 0.03, 0.03, 0.01};
  TrialResult bad = good;
  bad.errors[kYawVel] = 0.09;
  table.campaign.runs = {{bad, bad}, {good, good}};
  evaluate(table);
  EXPECT_EQ(table.judged, 1U);
  EXPECT_TRUE(table.all_reached());
  EXPECT_TRUE(table.comparisons[0].difference[kYawVel].excludes_zero());
  EXPECT_LT(table.comparisons[0].difference[kYawVel].mean, 0.0);
  EXPECT_EQ((*published_errors("pmg"))[kRollError], 0.0769);
  EXPECT_FALSE(published_errors("mine").has_value());
  table.campaign.runs[1] = {good, bad};
  table.campaign.runs[1][1].fell = true;
  evaluate(table);
  EXPECT_TRUE(table.reached(kYawVel)) << "the mean counts";
  EXPECT_FALSE(table.all_reached()) << "falls do too";
}

/// What stands between these two in a page; "" where the first is missing.
std::string between(const std::string& html, const std::string& from, const std::string& to) {
  const std::size_t begin = html.find(from), end = html.find(to, begin);
  return begin == std::string::npos ? "" : html.substr(begin, end - begin);
}

TEST(Table1, ThePapersFiguresStandInTheTableWithWhatTheyAreOfAndInNoPicture) {
  Table1 table;
  table.scenario = standing(1.0);
  table.yardsticks.resize(1);
  table.cases = {{.name = "pmg", .candidate = without_policy(), .plants = {}}};
  TrialResult run;
  run.complete = true;
  run.judged_s = 1.0;
  run.errors = {0.05, 0.07, 0.03, 0.03, 0.01};
  table.campaign.runs = {{run, run}};
  table.campaign.courses.resize(1);
  for (const char* scenario : {"table1_full", kGentleScenario}) {
    table.scenario.name = scenario;
    evaluate(table);
    const std::string html = page_of(table).html();
    const std::string pictures = between(html, "<h2 id=\"s1\">Errors against the user", "The paper&#39;s figures");
    EXPECT_NE(pictures, "") << scenario << ": what they are of is said between the pictures and the table";
    EXPECT_EQ(pictures.find("paper"), std::string::npos) << scenario;
    EXPECT_NE(between(html, "The paper&#39;s figures", "</p>").find("compare the order of the policies, not the sizes"),
              std::string::npos);
    const std::string row = between(html, "<td>pmg, paper (other commands, other robot)</td>", "</tr>");
    EXPECT_NE(row.find("0.1228"), std::string::npos) << scenario;
  }
  table.cases[0].name = "mine";
  evaluate(table);
  EXPECT_EQ(page_of(table).html().find("paper"), std::string::npos) << "of a policy that it doesn't know";
}

TEST(Table1, ALimitOnAShareWhoseYardsticksAreMissingIsNotMeasuredAndNoChannelWithoutCommandIsANumber) {
  Table1 table;
  table.scenario = standing(1.0);
  table.scenario.name = "table1_full";
  table.yardsticks.resize(1);
  table.cases = {{.name = "pmg", .candidate = without_policy(), .plants = {}}};
  TrialResult run;
  run.complete = true;
  run.judged_s = 1.0;
  table.campaign.runs = {{run, run}};
  table.campaign.courses.resize(1);
  table.campaign.complete = false;
  evaluate(table);
  EXPECT_FALSE(table.all_reached());
  std::string html = page_of(table).html();
  EXPECT_NE(html.find("0.1500 not measured"), std::string::npos);
  EXPECT_EQ(html.find("0.1500 ok"), std::string::npos);
  EXPECT_EQ(worth_of(table).grade(), work::Grade::kInterrupted);
  table.yardsticks[0].nothing.complete = true;  // and 0 in every channel: nothing was asked
  table.campaign.complete = true;
  evaluate(table);
  EXPECT_TRUE(table.all_reached());
  html = page_of(table).html();
  EXPECT_NE(html.find("nothing asked"), std::string::npos);
  EXPECT_EQ(html.find("nan"), std::string::npos);
}

TEST(Table1, InterruptedItIsNotWorthWhatItsRunsSoFarAre) {
  Table1 table;
  table.scenario.name = kGentleScenario;
  table.yardsticks.resize(1);
  table.cases = {{.name = "pmg", .candidate = without_policy(), .plants = {}}};
  TrialResult good;
  good.complete = true;
  good.judged_s = 1.0;
  good.errors = {0.01, 0.01, 0.01, 0.01, 0.001};
  table.campaign.runs = {{good, good}};
  evaluate(table);
  EXPECT_EQ(worth_of(table).sentence(), "");
  table.campaign.complete = false;
  table.campaign.runs = {{good, {}}};
  evaluate(table);
  EXPECT_EQ(worth_of(table).sentence(), "INTERRUPTED: 1 of 2 runs are complete");
  table.campaign.runs = {{{}, {}}};
  evaluate(table);
  EXPECT_EQ(worth_of(table).sentence(), "INTERRUPTED: 0 of 2 runs are complete") << "and nothing of figures of no run";
  table.campaign.complete = true;
  good.errors[kRollError] = 1.0;
  table.campaign.runs = {{good, good}};
  evaluate(table);
  EXPECT_EQ(worth_of(table).grade(), work::Grade::kMissed);
}

TEST(Pushes, WithoutTheJudgedStrengthThePageIsNotGreen) {
  PushTest test;
  TrialResult good;
  good.complete = true;
  test.strengths = {{kJudgedPush_N_s + 15.0, {good, good}}};
  EXPECT_EQ(worth_of(test).grade(), work::Grade::kOpen);
  test.strengths.insert(test.strengths.begin(), {kJudgedPush_N_s, {good, good}});
  EXPECT_EQ(worth_of(test).sentence(), "");
  EXPECT_NE(page_of(test).html().find("verdict good"), std::string::npos);
  test.complete = false;
  EXPECT_EQ(worth_of(test).grade(), work::Grade::kInterrupted);
  EXPECT_EQ(page_of(test).html().find("verdict good"), std::string::npos);
}

TEST(Table2, InterruptedNothingIsCompared) {
  Table2 table;
  table.complete = false;
  EXPECT_EQ(worth_of(table).exit_code(), 130);
  EXPECT_EQ(page_of(table).html().find("verdict good"), std::string::npos);
}

}  // namespace
}  // namespace pmg::evaluation
