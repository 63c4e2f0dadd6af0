// The messages to an operator whose command the robot can't follow exactly.
#include "operator/taken_command.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "networked_robot.hpp"
#include "operator/drive.hpp"
#include "operator/robot_board.hpp"

namespace pmg::ops {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class TakenCommandTest : public testing::Test {
 protected:
  TakenCommandTest() {
    nlohmann::json options;
    const CommandLimits& limits = robot_.robot.command_limits;
    for (std::size_t i = 0; i < kChannels; ++i) {
      options["command"]["lower"][kChannelNames[i]] = limits.lower[i];
      options["command"]["upper"][kChannelNames[i]] = limits.upper[i];
    }
    robot_.run.options = options.dump();  // as control::control_json writes it
    for (int k = 0; k < 3; ++k) network_.advance();
  }
  /// Walks with this command; returns every line of output, repetitions included.
  std::vector<std::string> told(const Command& asked, double seconds) {
    Drive drive(source_, "biped", asked, {.duration_s = seconds, .climb = true});
    TakenCommand taken(asked);
    std::vector<std::string> lines;
    Progress progress = Progress::kPending;
    while (progress == Progress::kPending) {
      network_.advance();
      const bool driving = drive.driving();
      progress = drive.step();
      if (!driving) continue;
      const std::string line = taken.step(board_.robots().at("biped"), network_.clock.now_ns(), !drive.driving());
      if (!line.empty()) lines.push_back(line);
    }
    EXPECT_EQ(progress, Progress::kReached) << drive.text();
    return lines;
  }

  test::Network network_;
  test::NetworkedRobot& robot_ = network_.add_robot("biped");
  OperatorSource source_{network_.link, "pmg_send.1", 1, network_.clock};
  RobotBoard board_{network_.link, network_.clock};
};

TEST_F(TakenCommandTest, BeyondTheRangeTheRangeAndWhatIsDrivenAreSaidOnce) {
  const double most = robot_.robot.command_limits.upper[kVx];
  const auto lines = told(Command{{50.0}}, 5.0);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_THAT(lines[0], StartsWith(fmt::format("limited: vx 50 -> {:.3g} m/s (range ", most)));
  EXPECT_THAT(lines[0], HasSubstr(fmt::format(" to {:.3g})", most)));
  EXPECT_THAT(lines[0], Not(HasSubstr("vy")));
  EXPECT_THAT(lines[0], Not(HasSubstr("more than the clips"))) << "the range explains it";
}

TEST_F(TakenCommandTest, TogetherTooMuchIsSaidOfEachChannel) {
  const CommandLimits& limits = robot_.robot.command_limits;
  Command asked;
  asked[kVx] = limits.upper[kVx];
  asked[kOmega] = limits.upper[kOmega];
  const auto lines = told(asked, 5.0);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_THAT(lines[0],
              AllOf(HasSubstr("vx "), HasSubstr("omega "), HasSubstr("; together they are more than the clips")));
}

TEST_F(TakenCommandTest, WhereTheReachIsPublishedItIsTheReason) {
  nlohmann::json options = nlohmann::json::parse(robot_.run.options);
  options["command"]["velocities_together"] = 1.0;
  robot_.run.options = options.dump();
  for (int k = 0; k < 120; ++k) network_.advance();  // ROBOT_INFO is repeated each second
  const CommandLimits& limits = robot_.robot.command_limits;
  Command asked;
  asked[kVx] = 5.0 * limits.upper[kVx];
  asked[kOmega] = 0.75 * limits.lower[kOmega];
  const auto lines = told(asked, 5.0);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_THAT(lines[0], HasSubstr("; the velocities together are 175 % of their ranges, the clips give 100 %"))
      << "what is beyond one range doesn't count twice";
  const RobotNews& news = board_.robots().at("biped");
  Command within;
  within[kVx] = 0.5 * limits.upper[kVx];
  within[kOmega] = 0.5 * limits.upper[kOmega];
  EXPECT_EQ(beyond_reach(within.u.data(), news), "");
  within[kPitch] = 10.0;
  EXPECT_EQ(beyond_reach(within.u.data(), news), "") << "postures are no velocities";
}

TEST_F(TakenCommandTest, AChannelThatWasNotAskedForIsNotMentioned) {
  Command asked;
  asked[kVx] = 0.9 * robot_.robot.command_limits.upper[kVx];
  asked[kOmega] = 0.9 * robot_.robot.command_limits.upper[kOmega];
  const auto lines = told(asked, 5.0);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_THAT(lines[0], Not(HasSubstr("vy")));
  EXPECT_THAT(lines[0], Not(HasSubstr("(range"))) << "each is within its own";
}

TEST_F(TakenCommandTest, WhatIsTakenAsAskedIsNotMentioned) {
  EXPECT_THAT(told(Command{{0.5 * robot_.robot.command_limits.upper[kVx]}}, 2.0), testing::IsEmpty());
}

TEST_F(TakenCommandTest, TheLastWordsOfADriveSayHowLongAndWhatWasTaken) {
  const auto words = [&](const Command& asked, double seconds) {
    Drive drive(source_, "biped", asked, {.duration_s = seconds, .climb = true});
    Progress progress = Progress::kPending;
    while (progress == Progress::kPending) {
      network_.advance();
      progress = drive.step(&board_.robots().at("biped"));
    }
    return drive.last_words();
  };
  EXPECT_EQ(words(Command{{0.2}}, 1.0), "drove for 1.0 s");
  const double most = robot_.robot.command_limits.upper[kVx];
  EXPECT_THAT(words(Command{{50.0}}, 2.0),
              StartsWith(fmt::format("drove for 2.0 s; limited: vx 50 -> {:.3g} m/s (range ", most)));
  EXPECT_THAT(words(Command{{50.0}}, 0.1),
              AllOf(StartsWith("drove for 0.1 s; limited: vx 50 -> "), HasSubstr(" m/s so far (range ")));
}

TEST_F(TakenCommandTest, AShortDriveIsToldTooAtItsEnd) {
  const auto lines = told(Command{{50.0}}, 0.1);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_THAT(lines[0], AllOf(StartsWith("limited: vx 50 -> 0."), HasSubstr(" m/s so far (range ")));
}

}  // namespace
}  // namespace pmg::ops
