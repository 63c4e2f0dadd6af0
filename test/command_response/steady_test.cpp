#include "command_response/steady.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "command_response/command_box.hpp"
#include "model/robot_model.hpp"

namespace pmg::command_response {
namespace {

const HeldCommand& named(const std::vector<HeldCommand>& commands, const std::string& text) {
  const auto found = std::ranges::find(commands, text, &HeldCommand::text);
  EXPECT_NE(found, commands.end()) << text;
  return found == commands.end() ? commands.front() : *found;
}

TEST(Steady, EveryEndEveryPairAllThreeAndSmallOnesAreAskedFor) {
  const std::vector<HeldCommand> commands = held_commands(box());
  ASSERT_EQ(commands.size(), 32U);
  const HeldCommand& back = named(commands, "vx -100 %");
  EXPECT_DOUBLE_EQ(back.command[kVx], -0.5);
  EXPECT_EQ(back.limit, 0.03);
  const HeldCommand& pair = named(commands, "vx -80 %, omega +80 %");
  EXPECT_DOUBLE_EQ(pair.command[kVx], -0.4);
  EXPECT_EQ(pair.command[kVy], 0.0);
  EXPECT_DOUBLE_EQ(pair.command[kOmega], 0.64);
  EXPECT_EQ(pair.limit, 0.10);
  const HeldCommand& all = named(commands, "vx +60 %, vy -60 %, omega -60 %");
  EXPECT_DOUBLE_EQ(all.command[kVx], 0.48);
  EXPECT_DOUBLE_EQ(all.command[kVy], -0.21);
  EXPECT_DOUBLE_EQ(all.command[kOmega], -0.48);
  EXPECT_EQ(all.limit, 0.10);
  EXPECT_FALSE(all.drift_limit);
  const HeldCommand& small = named(commands, "vx +20 %");
  EXPECT_DOUBLE_EQ(small.command[kVx], 0.16);
  EXPECT_EQ(small.limit, 0.15);
  EXPECT_EQ(small.drift_limit, 0.05);
}

TEST(Steady, ASideThatTheRobotLacksIsNotAskedFor) {
  CommandLimits limits = box();
  limits.lower[kVx] = 0.0;
  EXPECT_EQ(held_commands(limits).size(), 32U - 1U - 4U - 4U - 1U);
}

TEST(Steady, TheErrorIsTheWorstChannelsShareOfItsCommandAndTheOthersDrift) {
  const HeldCommand asked = named(held_commands(box()), "vx +80 %, omega +80 %");
  Command did;
  did[kVx] = 0.60;     // 0.04 of 0.64: 6.25 %
  did[kOmega] = 0.72;  // 0.08 of 0.64: 12.5 %
  did[kVy] = -0.07;    // 20 % of its range
  did[kPitch] = 0.3;
  EXPECT_NEAR(worst_error(asked, did), 0.125, 1e-12);
  EXPECT_NEAR(worst_drift(asked, did, box()), 0.2, 1e-12);
  EXPECT_EQ(worst_error(asked, {}), 1.0);
}

TEST(Steady, ACommandIsReachedWithinItsLimitByARobotThatStaysUp) {
  SteadyTest test;
  test.limits = box();
  test.commands = {named(held_commands(box()), "vx +100 %"), named(held_commands(box()), "vx +80 %, omega +80 %")};
  HeldResult result{.complete = true, .survived = true, .did = {}, .admitted = {}};
  result.did[kVx] = 0.78;  // 2.5 % off
  test.results.push_back(result);
  result.did[kVx] = 0.59;  // 7.8 % off
  result.did[kOmega] = 0.69;
  test.results.push_back(result);
  EXPECT_TRUE(test.all_reached());
  test.results[0].did[kVx] = 0.77;
  EXPECT_FALSE(test.reached(0)) << "3.75 % is enough for two channels and too much for one";
  EXPECT_TRUE(test.reached(1));
  test.results[1].survived = false;
  EXPECT_FALSE(test.reached(1));
  test.results[1].complete = false;
  EXPECT_FALSE(test.complete());
}

TEST(Steady, ASmallCommandIsMissedByARobotThatDriftsElsewhere) {
  SteadyTest test;
  test.limits = box();
  test.commands = {named(held_commands(box()), "vx +20 %"), named(held_commands(box()), "vx +100 %")};
  HeldResult result{.complete = true, .survived = true, .did = {}, .admitted = {}};
  result.did[kVx] = 0.16;
  result.did[kVy] = 0.017;  // 4.9 % of its range
  test.results = {result, result};
  test.results[1].did[kVx] = 0.8;
  EXPECT_TRUE(test.all_reached());
  for (HeldResult& drifting : test.results) drifting.did[kVy] = -0.018;  // 5.1 %
  EXPECT_FALSE(test.reached(0));
  EXPECT_TRUE(test.reached(1)) << "at full speed drift is shown, not judged";
}

// From end to end: what is reported is the simulated robot's motion, neither its command nor its reference. The limits
// are those of a policy that walks at all.
TEST(Steady, TheMotionIsTheRobotsOwn) {
  SteadyTest test;
  test.robot = "z1";
  test.candidate = {"pmg", {.clips = {}, .policy = "pmg"}};
  test.settle_s = 4.0;
  test.steady_s = 3.0;
  const model::RobotModel robot = model::load_robot(model::find_robot("z1"));
  test.commands = {named(held_commands(robot.command_limits), "vx +100 %"),
                   named(held_commands(robot.command_limits), "omega -100 %")};
  run_steady(test, {.jobs = 2});
  ASSERT_TRUE(test.complete());
  for (std::size_t i = 0; i < 2; ++i) {
    const HeldResult& result = test.results[i];
    const std::size_t channel = i == 0 ? kVx : kOmega;
    const double asked = test.commands[i].command.u[channel];
    EXPECT_TRUE(result.survived);
    // The command inverse asks the clips for a little more, which they can't give at the range's end.
    EXPECT_NEAR(result.admitted.u[channel], asked, 0.01 * std::abs(asked)) << "the ramp is over";
    EXPECT_NEAR(result.did.u[channel], asked, 0.25 * std::abs(asked));
    EXPECT_GT(std::abs(result.did.u[channel] - asked), 1e-4) << "no robot follows exactly";
    EXPECT_LT(std::abs(result.did.u[channel == kVx ? kOmega : kVx]), 0.1) << "and doesn't do the other";
  }
  const nlohmann::ordered_json json = to_json(test);
  EXPECT_EQ(json["commands"][1]["did"]["omega_rad_s"], test.results[1].did[kOmega]);
  EXPECT_EQ(json["commands"][0]["text"], "vx +100 %");
}

}  // namespace
}  // namespace pmg::command_response
