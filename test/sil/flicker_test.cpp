// Operators whose command flickers: Z1's policy walks on. docs/reference/safety.md: "A command that flickers".
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "sil/varied_robot.hpp"

namespace pmg::sil {
namespace {

using test::kTick_s;

/// All six channels alternate between the ends of their ranges every so many ticks; the seed draws which end is first.
Scenario flickering(const model::RobotModel& robot, std::uint64_t seed, int ticks, double for_s) {
  std::mt19937_64 random(seed);
  Command one, other;
  for (std::size_t channel = 0; channel < kChannels; ++channel) {
    const bool low = seed > 0 && random() % 2 == 0;
    one.u[channel] = low ? robot.command_limits.lower[channel] : robot.command_limits.upper[channel];
    other.u[channel] = low ? robot.command_limits.upper[channel] : robot.command_limits.lower[channel];
  }
  test::ScriptedOperator driver;
  driver.then(1.5, control::Mode::kStand);
  for (double t = 0.0; t < for_s; t += 2.0 * ticks * kTick_s) {
    driver.then(ticks * kTick_s, control::Mode::kWalk, one).then(ticks * kTick_s, control::Mode::kWalk, other);
  }
  return driver.scenario;
}

class Flicker : public testing::TestWithParam<int> {};

TEST_P(Flicker, OfAllChannelsBetweenTheirExtremesFellsNoRobot) {
  const int ticks = GetParam();
  int fell = 0;
  const std::uint64_t robots = test::campaign_robots(2);
  for (std::uint64_t seed = 0; seed < robots; ++seed) {
    test::VariedRobot it(seed);
    const Scenario scenario = flickering(it.robot, seed, ticks, robots > 2 ? 10.0 : 4.0);
    Lockstep lockstep(it.robot, it.drives, it.plant, *it.tick, scenario, nullptr, {.balanced_by_policy = true});
    const RunOutcome outcome = lockstep.run();
    const bool down = outcome.fell || !outcome.faults.empty();
    fell += down ? 1 : 0;
    if (!down) continue;
    fmt::print("{} ticks, robot {}: fell {} at {:.2f} s; {}\n", ticks, seed, outcome.fell, outcome.fell_at_s,
               outcome.faults.empty() ? "no fault" : describe(outcome.faults[0], it.robot));
  }
  EXPECT_EQ(fell, 0) << "of " << robots;
}

INSTANTIATE_TEST_SUITE_P(Ticks, Flicker, testing::Values(1, 2, 3, 5, 10));

}  // namespace
}  // namespace pmg::sil
