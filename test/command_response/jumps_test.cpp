#include "command_response/jumps.hpp"

#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>

#include "command_response/command_box.hpp"

namespace pmg::command_response {
namespace {

TEST(Jumps, EveryHalfSecondEveryVelocityIsAtAnEndOrZeroAndEachOccurs) {
  const sil::Scenario scenario = jump_scenario(box(), 1, 60.0);
  ASSERT_EQ(scenario.steps.size(), 122U) << "120 jumps between standing and rest";
  EXPECT_EQ(scenario.steps.front().mode, control::Mode::kStand);
  std::array<std::array<int, 3>, kVelocityChannels> met{};
  for (std::size_t i = 1; i < 121; ++i) {
    const sil::ScenarioStep& step = scenario.steps[i];
    EXPECT_EQ(step.mode, control::Mode::kWalk);
    EXPECT_EQ(step.duration_s, kJump_s);
    EXPECT_NEAR(step.start_s, 1.5 + kJump_s * static_cast<double>(i - 1), 1e-9);
    for (std::size_t c = 0; c < kVelocityChannels; ++c) {
      const double u = step.command.u[c];
      ASSERT_TRUE(u == box().lower[c] || u == 0.0 || u == box().upper[c]);
      ++met[c][u < 0.0 ? 0 : u > 0.0 ? 2 : 1];
    }
    for (std::size_t c = kVelocityChannels; c < kChannels; ++c) EXPECT_EQ(step.command.u[c], 0.0);
  }
  // 120 draws of three: each 40 times, with a standard deviation of 5.2.
  for (const auto& channel : met) {
    for (const int count : channel) EXPECT_NEAR(count, 40, 20);
  }
  EXPECT_EQ(scenario.steps.back().command.u, Command{}.u);
  EXPECT_NEAR(scenario.duration_s(), 1.5 + 60.0 + 3.0, 1e-9);
}

TEST(Jumps, EvenSeedsMovePosturesTooAndSeedsDiffer) {
  const sil::Scenario scenario = jump_scenario(box(), 2, 60.0);
  std::array<bool, kChannels> low{}, high{};
  for (const sil::ScenarioStep& step : scenario.steps) {
    for (std::size_t c = 0; c < kChannels; ++c) {
      low[c] = low[c] || step.command.u[c] == box().lower[c];
      high[c] = high[c] || step.command.u[c] == box().upper[c];
    }
  }
  for (std::size_t c = 0; c < kChannels; ++c) EXPECT_TRUE(low[c] && high[c]) << kChannelNames[c];
  const sil::Scenario one = jump_scenario(box(), 1, 5.0), again = jump_scenario(box(), 1, 5.0),
                      three = jump_scenario(box(), 3, 5.0);
  bool differ = false;
  for (std::size_t i = 0; i < one.steps.size(); ++i) {
    EXPECT_EQ(one.steps[i].command.u, again.steps[i].command.u);
    differ = differ || one.steps[i].command.u != three.steps[i].command.u;
  }
  EXPECT_TRUE(differ);
}

// Without a policy the robot can stand and can't walk, so jumps fell it: the runs reach the simulation.
TEST(Jumps, ARobotThatCannotWalkFallsAndThatIsCounted) {
  JumpTest test;
  test.robot = "z1";
  test.evaluated = {.name = "none", .candidate = {"none", {.clips = {}, .policy = "none"}}, .plants = {}};
  test.seeds = 2;
  test.duration_s = 5.0;
  run_jumps(test, {.jobs = 2});
  ASSERT_TRUE(test.complete());
  EXPECT_FALSE(test.all_survived());
  const nlohmann::ordered_json json = to_json(test);
  ASSERT_EQ(json["runs"].size(), 2U);
  EXPECT_FALSE(json["runs"][0]["postures_jump"]);
  EXPECT_TRUE(json["runs"][1]["postures_jump"]);
  EXPECT_FALSE(json["all_survived"]);
}

TEST(Jumps, AFallOfOneRobotIsEnough) {
  JumpTest test;
  evaluation::TrialResult good;
  good.complete = true;
  test.runs = {good, good};
  EXPECT_TRUE(test.all_survived());
  test.runs[1].fell = true;
  EXPECT_FALSE(test.all_survived());
  test.runs[1].fell = false;
  test.runs[1].faults = {"TILT: 61 degrees"};
  EXPECT_FALSE(test.all_survived());
}

}  // namespace
}  // namespace pmg::command_response
