#include "sil/scenario.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "control/fixtures.hpp"
#include "files/config_error.hpp"
#include "folders.hpp"
#include "temporary_folder.hpp"

namespace pmg::sil {
namespace {

class ScenarioFile : public testing::Test {
 protected:
  Scenario load(const std::string& text) {
    std::ofstream(file_) << text;
    return load_scenario(file_);
  }
  std::string refusal(const std::string& text) {
    try {
      load(text);
    } catch (const files::ConfigError& error) {
      return error.what();
    }
    return "accepted";
  }
  void expect_refusal(const std::string& text, const std::string& place, const std::string& key) {
    const std::string said = refusal(text);
    EXPECT_EQ(said.find(file_.string() + place), 0u) << said;
    EXPECT_NE(said.find(key), std::string::npos) << said;
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.file("scenario.yaml");
};

constexpr const char* kGood = R"(name: short
steps:
  - {for_s: 1.0, text: stand, mode: stand}
  - {for_s: 2.0, text: walk, mode: walk, command: {vx_m_s: 0.4, pitch_rad: -0.1}, hoist_without_policy: true}
  - {for_s: 0.5, text: stop}
)";

TEST_F(ScenarioFile, MoreThanADayOrTenThousandStepsIsRefused) {
  EXPECT_NE(refusal("name: long\nsteps:\n  - {for_s: 1e9, text: a}\n").find("a day (86400 s) at most"),
            std::string::npos);
  std::string many = "name: many\nsteps:\n";
  for (int k = 0; k < 10'001; ++k) many += "  - {for_s: 1, text: a}\n";
  EXPECT_NE(refusal(many).find("steps: has 10001; expected 10000 at most"), std::string::npos);
}

TEST_F(ScenarioFile, ModesAndHoistHoldOnWhileCommandsDoNot) {
  const Scenario scenario = load(kGood);
  EXPECT_EQ(scenario.name, "short");
  EXPECT_DOUBLE_EQ(scenario.duration_s(), 3.5);
  EXPECT_EQ(scenario.at(0.0).mode, control::Mode::kStand);
  EXPECT_EQ(scenario.at(0.999).text, "stand");
  EXPECT_EQ(scenario.at(1.0).text, "walk");
  EXPECT_DOUBLE_EQ(scenario.at(2.0).command[kVx], 0.4);
  EXPECT_DOUBLE_EQ(scenario.at(2.0).command[kPitch], -0.1);
  EXPECT_DOUBLE_EQ(scenario.at(2.0).command[kVy], 0.0);
  EXPECT_EQ(scenario.at(3.2).mode, control::Mode::kWalk);
  EXPECT_TRUE(scenario.at(3.2).hoist_without_policy);
  EXPECT_EQ(scenario.at(3.2).command, Command{});
  EXPECT_EQ(scenario.at(99.0).text, "stop");
}

TEST_F(ScenarioFile, RefusalsNameFileLineAndKey) {
  expect_refusal("name: x\nsteps:\n  - {for_s: 1, text: a, command: {vx: 0.4}}\n", ":3:", "vx");
  expect_refusal("name: x\nsteps:\n  - {for_s: 1, text: a, speed: 1}\n", ":3:", "speed");
  expect_refusal("name: x\nsteps:\n  - {text: a}\n", ":3:", "for_s");
  expect_refusal("name: x\nsteps:\n  - {for_s: 1}\n", ":3:", "text");
  expect_refusal("name: x\nsteps:\n  - {for_s: 0, text: a}\n", ":3:", "for_s");
  expect_refusal("name: x\nsteps:\n  - {for_s: -2, text: a}\n", ":3:", "for_s");
  expect_refusal("name: x\nsteps:\n  - {for_s: .nan, text: a}\n", ":3:", "for_s");
  expect_refusal("name: x\nsteps:\n  - {for_s: soon, text: a}\n", ":3:", "for_s");
  expect_refusal("name: x\nsteps:\n  - {for_s: 1, text: a, mode: run}\n", ":3:", "mode");
  expect_refusal("name: x\nsteps:\n  - {for_s: 1, text: a, mode: fault}\n", ":3:", "mode");
  expect_refusal("name: x\nsteps:\n  - {for_s: 1, text: a, hoist_without_policy: maybe}\n",
                 ":3:", "hoist_without_policy");
  expect_refusal("name: x\nsteps:\n  - {for_s: 1, text: a, command: {height_m: .inf}}\n", ":3:", "height_m");
  expect_refusal("steps:\n  - {for_s: 1, text: a}\n", ":", "name");
  expect_refusal("name: x\n", ":", "steps");
  expect_refusal("name: x\nsteps: []\n", ":2:", "steps");
  expect_refusal("name: x\nextra: 1\nsteps:\n  - {for_s: 1, text: a}\n", ":2:", "extra");
  expect_refusal("name: x\nsteps: [\n", ":", "");
  EXPECT_THROW(load_scenario(file_.string() + ".absent"), files::ConfigError);
}

TEST(Scenarios, ThoseOfTheProjectLoadAndTheTourVisitsEveryChannel) {
  const std::filesystem::path folder = std::filesystem::path(pmg::test::project_folder()) / "config/scenarios";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) EXPECT_NO_THROW(load_scenario(entry.path()));
  const Scenario tour = load_scenario(folder / "tour.yaml");
  EXPECT_GE(tour.duration_s(), 90.0);
  EXPECT_LE(tour.duration_s(), 110.0);
  for (std::size_t channel = 0; channel < kChannels; ++channel) {
    const bool up = std::ranges::any_of(tour.steps, [&](const auto& step) { return step.command.u[channel] > 0.0; });
    const bool down = std::ranges::any_of(tour.steps, [&](const auto& step) { return step.command.u[channel] < 0.0; });
    EXPECT_TRUE(up || down) << kChannelNames[channel];
    EXPECT_TRUE(channel >= kVelocityChannels || (up && down)) << kChannelNames[channel];
  }
  for (const ScenarioStep& step : tour.steps) {
    const bool walks = step.command[kVx] != 0.0 || step.command[kVy] != 0.0 || step.command[kOmega] != 0.0;
    EXPECT_TRUE(!walks || step.hoist_without_policy) << step.text << " needs somebody who balances";
  }
}

TEST(ScenarioPlayer, IsAnOperatorWhoNeverFallsSilent) {
  Scenario scenario;
  scenario.steps.resize(2);
  scenario.steps[0].duration_s = scenario.steps[1].start_s = scenario.steps[1].duration_s = 1.0;
  scenario.steps[1].mode = control::Mode::kWalk;
  scenario.steps[1].command[kVy] = 0.2;
  ScenarioPlayer player(scenario);
  std::int64_t sequence = 0;
  for (int k = 0; k < 200; ++k) {
    player.step(0.01 * k, 10'000'000 * k);
    EXPECT_GT(player.drive().sequence, sequence);
    sequence = player.drive().sequence;
    EXPECT_GT(player.drive().lease_s, 0.2);
    EXPECT_EQ(player.drive().source, player.request().source);
    EXPECT_EQ(player.drive().received_ns, 10'000'000 * k);
    EXPECT_EQ(player.request().received_ns, 10'000'000 * k);
  }
  EXPECT_EQ(player.request().mode, control::Mode::kWalk);
  EXPECT_DOUBLE_EQ(player.drive().command[kVy], 0.2);
}

}  // namespace
}  // namespace pmg::sil
