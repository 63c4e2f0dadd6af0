// Each evaluation once from end to end, short: a crossed wire (the reference for the measurement, the true robot for
// its calibrated simulation, a condition that doesn't reach the world) changes what these tests see.
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numeric>

#include "evaluation/gait.hpp"
#include "evaluation/push.hpp"
#include "evaluation/robustness.hpp"
#include "evaluation/table2.hpp"
#include "model/robot_model.hpp"

namespace pmg::evaluation {
namespace {

namespace fs = std::filesystem;

Candidate pmg_policy() { return {"pmg", {.clips = {}, .policy = "pmg"}}; }

sil::ScenarioStep step(double start_s, double duration_s, control::Mode mode, double vx_m_s) {
  sil::ScenarioStep made{.start_s = start_s,
                         .duration_s = duration_s,
                         .text = "step",
                         .mode = mode,
                         .command = {},
                         .hoist_without_policy = false};
  made.command[kVx] = vx_m_s;
  return made;
}

double rms(const std::vector<double>& a, const std::vector<double>& b) {
  const double squares = std::inner_product(a.begin(), a.end(), b.begin(), 0.0, std::plus<>(),
                                            [](double x, double y) { return (x - y) * (x - y); });
  return std::sqrt(squares / static_cast<double>(a.size()));
}

TEST(Wiring, AGaitThatIsInterruptedBeforeTwoStepsIsNoRobotThatCannotWalk) {
  GaitTest test;
  test.robot = "z1";
  test.evaluated = {.name = "pmg", .candidate = pmg_policy(), .plants = {}};
  test.norms = built_in_norms();
  int questions = 0;
  const Supervision supervision{.jobs = 1, .progress = {.report = {}, .interrupted = [&] { return ++questions > 20; }}};
  EXPECT_THROW(run_gait(test, supervision), work::Interrupted);
}

// Soft drives let a loaded leg yield by degrees. So the measured gait is near the reference, and never the reference.
TEST(Wiring, GaitComparesTheMeasuredJointsWithTheReferenceAndBothWithThePublishedMeans) {
  GaitTest test;
  test.robot = "z1";
  test.evaluated = {.name = "pmg", .candidate = pmg_policy(), .plants = {}};
  test.steady_s = 3.0;
  test.norms = built_in_norms();
  run_gait(test, {});
  for (const Foot foot : {kLeft, kRight}) {
    const FootGait& gait = test.feet[foot];
    for (std::size_t joint = 0; joint < kGaitJoints; ++joint) {
      const double apart_deg = rms(gait.measured_deg[joint], gait.reference_deg[joint]);
      EXPECT_GT(apart_deg, 0.5) << kGaitJointNames[joint];
      EXPECT_LT(apart_deg, 10.0) << kGaitJointNames[joint];
      EXPECT_NEAR(gait.measured[joint].rms_deg, rms(gait.measured_deg[joint], test.norms.deg[joint]), 1e-9);
      EXPECT_NEAR(gait.reference[joint].rms_deg, rms(gait.reference_deg[joint], test.norms.deg[joint]), 1e-9);
    }
  }
  // The clip's pelvis tilts forward by 8 degrees under an upright torso. Thighs are 9 and 12 degrees from the means;
  // hip joints, from which nobody takes the tilt off, 17 and 19.
  for (const Foot foot : {kLeft, kRight}) {
    EXPECT_LT(test.feet[foot].measured[kHip].rms_deg, 13.0);
    EXPECT_LT(test.feet[foot].reference[kHip].rms_deg, 15.0);
  }
  // A foot that lands 5 % early takes 0.2 off the correlations of knee and ankle.
  for (const Foot foot : {kLeft, kRight}) EXPECT_LT(std::abs(test.feet[foot].contact_late), 0.03);
  // The reference is one clip for both sides; the robot's two legs never move quite alike.
  const auto sides_apart_deg = [&](auto curves) {
    return rms((test.feet[kLeft].*curves)[1], (test.feet[kRight].*curves)[1]);
  };
  EXPECT_LT(sides_apart_deg(&FootGait::reference_deg), 2.0);
  EXPECT_NEAR(test.walked_m_s, 0.8, 0.15);
}

TEST(Wiring, EveryConditionOfRobustnessReachesTheSimulatedWorld) {
  const model::RobotModel robot = model::load_robot(model::find_robot("z1"));
  const std::vector<Case> cases = robustness_cases({"none", {.clips = {}, .policy = "none"}}, {});
  ASSERT_EQ(cases.size(), 6U);
  const sim::WorldOptions usual = cases[0].plants.of(robot, 1);
  const auto of = [&](std::size_t condition) { return cases[condition].plants.of(robot, 1); };
  const auto payload_kg = [](const sim::WorldOptions& world) { return world.variation.hand_payload_kg[kLeft]; };
  for (const std::size_t loaded : {1U, 5U}) {
    EXPECT_EQ(of(loaded).variation.hand_payload_kg[kLeft], 1.5);
    EXPECT_EQ(of(loaded).variation.hand_payload_kg[kRight], 1.5);
  }
  EXPECT_EQ(of(2).floor_friction, 0.4);
  EXPECT_EQ(of(3).floor_friction, 1.2);
  EXPECT_EQ(of(4).variation.delay_s, 0.02);
  EXPECT_EQ(of(5).floor_friction, 0.4);
  EXPECT_EQ(of(5).variation.delay_s, 0.02);
  EXPECT_EQ(payload_kg(usual), 0.0);
  EXPECT_EQ(usual.variation.delay_s, 0.0);

  // And the runs themselves: each condition stands differently from the one before it.
  const sil::Scenario standing{.name = "standing", .steps = {step(0.0, 1.0, control::Mode::kStand, 0.0)}};
  const CampaignRuns runs = run_campaign(cases, {standing}, 1, false, {.jobs = 2});
  for (std::size_t c = 1; c < cases.size(); ++c) {
    EXPECT_TRUE(runs.runs[c][0].complete) << cases[c].name;
    EXPECT_NE(runs.runs[c][0].errors, runs.runs[0][0].errors) << cases[c].name;
  }
  EXPECT_NE(runs.runs[5][0].errors, runs.runs[4][0].errors) << "the delay alone and all three";
}

// 80 walking trials of a gait of 1.1 s: a tenth of the cycle that no push meets has a chance of 10 * 0.9^80, 0.2 %.
TEST(Wiring, PushesMeetEveryTenthOfAGaitCycle) {
  constexpr double kPeriod_s = 1.1;  // of the forward clip; the pushed robot walks at 0.5 m/s with its timing
  std::array<int, 10> met{};
  for (int trial = 0; trial < 160; ++trial) {
    const PushPlan plan = PushPlan::of(trial);
    if (!plan.walking) continue;
    const double phase = std::fmod(plan.at_s / kPeriod_s, 1.0);
    ++met[static_cast<std::size_t>(10.0 * phase)];
  }
  for (const int pushes : met) EXPECT_GT(pushes, 0);
}

// The calibration of motors can't remove a robot's zero offsets, that of zero points can. Were the true plant in the
// simulation, the differences below would vanish.
TEST(Wiring, TableTwoComparesTheRobotWithTheCalibratedSimulationAndNotWithItself) {
  Table2 table;
  table.robot = "z1";
  table.policy = "pmg";
  table.scenario = {.name = "walk",
                    .steps = {step(0.0, 1.5, control::Mode::kStand, 0.0), step(1.5, 4.0, control::Mode::kWalk, 0.4)}};
  table.ranges = load_plant_ranges("config/evaluation/table2.yaml");
  table.ranges.plants = 1;
  table.simulation_seeds = 1;
  const fs::path folder = fs::temp_directory_path() / ("pmg_table2_wiring_" + std::to_string(getpid()));
  fs::create_directories(folder);
  run_table2(table, folder, {.jobs = 2});
  fs::remove_all(folder);
  ASSERT_TRUE(table.complete);
  const auto sim_to_real_rad = [&](Configuration c) { return table.results[c].sim_to_real_rad.mean; };
  // Offsets of 0.02 to 0.05 rad in twelve joints move the joints by about as much.
  EXPECT_GT(sim_to_real_rad(kBaseline), 0.02);
  EXPECT_GT(sim_to_real_rad(kDynamicCalibration), 0.02) << "offsets are still in the robot, and not in its simulation";
  EXPECT_LT(sim_to_real_rad(kFullCalibration), 0.6 * sim_to_real_rad(kDynamicCalibration));
  EXPECT_GT(sim_to_real_rad(kFullCalibration), 0.002) << "backlash and load friction are in no simulation";
  EXPECT_NE(table.results[kBaseline].imitation_rad.mean, table.results[kPhysicallyInformed].imitation_rad.mean);
}

}  // namespace
}  // namespace pmg::evaluation
