// A log is enough to compute every tick again; missing and different data are found and named.
#include "logs/replay.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <bit>
#include <fstream>
#include <iostream>

#include "log_surgery.hpp"
#include "pmg_msgs/motor_command_t.hpp"
#include "pmg_msgs/robot_info_t.hpp"
#include "pmg_msgs/robot_state_t.hpp"
#include "pmg_msgs/status_t.hpp"
#include "pmg_msgs/tick_input_t.hpp"
#include "recorded_run.hpp"

namespace pmg::logs {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class ReplayTest : public testing::Test {
 protected:
  ReplayTest() {
    fs::create_directories(folder_);
    test::record_run(log_);
  }
  ~ReplayTest() override { fs::remove_all(folder_); }

  fs::path copy(const std::function<bool(test::LogEvent&)>& keep) const {
    test::copy_log(log_, folder_ / "copy.lcm", keep);
    return folder_ / "copy.lcm";
  }
  static std::string refusal(const std::vector<fs::path>& files) {
    try {
      replay(files, {});
    } catch (const std::exception& error) {
      return error.what();
    }
    return "was replayed";
  }

  fs::path folder_ = fs::temp_directory_path() / ("pmg_replay_test_" + std::to_string(getpid()));
  fs::path log_ = folder_ / "log.lcm";
};

TEST_F(ReplayTest, ARecordedRunIsTheSameAgainBitForBit) {
  const ReplayReport report = replay({log_}, {});
  EXPECT_TRUE(report.equal()) << report.first->channel << " " << report.first->field << " at " << report.first->time_s;
  EXPECT_EQ(report.ticks, 260);
  EXPECT_EQ(report.compared_messages, 3 * 260);
  EXPECT_TRUE(report.notes.empty()) << report.notes.front();
}

TEST_F(ReplayTest, TheRunHasWalkingAFaultAndItsResetInIt) {
  std::vector<int> modes;
  for (const test::LogEvent& event : test::read_events(log_)) {
    if (event.channel != "STATUS") continue;
    const int mode = event.as<pmg_msgs::status_t>().mode;
    if (modes.empty() || modes.back() != mode) modes.push_back(mode);
  }
  EXPECT_EQ(modes, (std::vector<int>{0, 1, 2, 3, 4, 1, 2, 1})) << "passive to walk, fault, reset, stand, stop";
}

TEST_F(ReplayTest, TheCommittedLogIsWhatThisControllerDoes) {
  const ReplayReport report = replay({test::kCommittedLog}, {});
  const char* how_to =
      "\nIf the controller is meant to behave differently now, record it anew: test_logs "
      "--gtest_also_run_disabled_tests --gtest_filter='*RecordTheCommittedLog'";
  for (const std::string& note : report.notes) std::cout << "note: " << note << '\n';
  // Another compiler's or C library's sines and square roots may differ in the last bit. The joints' angles then differ
  // by less than a nanoradian.
  EXPECT_LE(report.largest_difference(), 1e-9)
      << report.first->channel << " " << report.first->field << " at " << report.first->time_s << " s: logged "
      << report.first->logged << ", replayed " << report.first->replayed << how_to;
  std::cout << (report.equal() ? "the same, bit for bit\n" : "not bit for bit: another compiler or C library?\n");
  EXPECT_GT(report.ticks, 200);
}

TEST_F(ReplayTest, DISABLED_RecordTheCommittedLog) { test::record_run(fs::path(test::kCommittedLog)); }

TEST_F(ReplayTest, OneBitOfAStateIsNoticedAndNamed) {
  // While damping, the drives' command contains the measured angles.
  std::int64_t ticks = -1;
  const fs::path spoilt = copy([&ticks](test::LogEvent& event) {
    if (event.channel != "STATE" || ++ticks != 165) return true;
    auto state = event.as<pmg_msgs::robot_state_t>();
    state.q_rad[3] = std::bit_cast<double>(std::bit_cast<std::uint64_t>(state.q_rad[3]) ^ 1);
    event.set(state);
    return true;
  });
  const ReplayReport report = replay({spoilt}, {});
  ASSERT_FALSE(report.equal());
  EXPECT_EQ(report.different_messages, 1);
  EXPECT_EQ(report.first->tick, 165);
  EXPECT_EQ(report.first->channel, "MOTOR_COMMAND");
  EXPECT_EQ(report.first->field, "q_rad." + model::load_robot(test::kRecordedRobot).joint_index.name(3));
  EXPECT_NE(report.first->logged, report.first->replayed) << "digits enough to tell them apart";
  EXPECT_NEAR(report.first->time_s, 1.66, 1e-6);
  EXPECT_GT(report.largest_difference(), 0.0);
  EXPECT_LT(report.largest_difference(), 1e-15);
}

TEST_F(ReplayTest, AnotherInputWhileWalkingIsNoticedToTheEnd) {
  const fs::path spoilt = copy([](test::LogEvent& event) {
    if (event.channel != "COMMAND") return true;
    auto command = event.as<pmg_msgs::command_t>();
    if (command.sequence == 100) command.vx_m_s += 1e-12;
    event.set(command);
    return true;
  });
  const ReplayReport report = replay({spoilt}, {});
  ASSERT_FALSE(report.equal());
  EXPECT_EQ(report.first->channel, "REFERENCE");
  EXPECT_GE(report.different_messages, 1);
}

TEST_F(ReplayTest, EveryInputOfATickCounts) {
  // Each change alone must change an output; otherwise it is not replayed at all.
  const auto differs = [&](const char* what, const std::function<void(pmg_msgs::tick_input_t&)>& change) {
    const fs::path spoilt = copy([&](test::LogEvent& event) {
      if (event.channel != "TICK") return true;
      auto input = event.as<pmg_msgs::tick_input_t>();
      if (input.tick >= 100 && input.tick < 110) change(input);
      event.set(input);
      return true;
    });
    EXPECT_FALSE(replay({spoilt}, {}).equal()) << what;
  };
  differs("bus", [](auto& input) { input.bus = pmg_msgs::tick_input_t::LOST; });
  differs("guard_trip", [](auto& input) { input.guard_trip = pmg_msgs::tick_input_t::CONTROL_FROZEN; });
  differs("stop", [](auto& input) { input.stop = 1; });
  differs("late_ns", [](auto& input) { input.late_ns = 20'000'000; });
  differs("stamp_ns", [](auto& input) { input.stamp_ns += 100'000'000; });
  differs("command_received_ns", [](auto& input) {
    for (std::int64_t& received_ns : input.command_received_ns) received_ns -= 300'000'000;
  });
}

TEST_F(ReplayTest, AMissingTickIsToldWithItsNumber) {
  std::int64_t tick = -1;
  const fs::path holed = copy([&tick](test::LogEvent& event) {
    if (event.channel == "STATE") ++tick;
    return tick != 120 && tick != 121;
  });
  EXPECT_THAT(refusal({holed}), HasSubstr("ticks 120 to 121 are missing"));
}

TEST_F(ReplayTest, MissingMessagesOfATickAreTold) {
  const fs::path holed = copy([](test::LogEvent& event) {
    return event.channel != "COMMAND" || event.as<pmg_msgs::command_t>().sequence != 120;
  });
  EXPECT_THAT(refusal({holed}), HasSubstr("not all in the log"));
}

TEST_F(ReplayTest, WithoutItsBeginningALogIsRefused) {
  std::int64_t tick = -1;
  const fs::path tail = copy([&tick](test::LogEvent& event) {
    if (event.channel == "STATE") ++tick;
    return event.channel == "ROBOT_INFO" || tick >= 50;
  });
  EXPECT_THAT(refusal({tail}), HasSubstr("begins with tick 50"));
  const fs::path nameless = copy([](test::LogEvent& event) { return event.channel != "ROBOT_INFO"; });
  EXPECT_THAT(refusal({nameless}), HasSubstr("ROBOT_INFO"));
  const fs::path empty = copy([](test::LogEvent&) { return false; });
  EXPECT_THAT(refusal({empty}), HasSubstr("no tick"));
}

TEST_F(ReplayTest, ACutLogIsReplayedUpToItsEnd) {
  fs::resize_file(log_, fs::file_size(log_) * 3 / 4);
  const ReplayReport report = replay({log_}, {});
  EXPECT_TRUE(report.equal());
  EXPECT_TRUE(report.cut_short);
  EXPECT_GT(report.ticks, 150);
  EXPECT_LT(report.ticks, 260);
}

TEST_F(ReplayTest, ARotatedLogIsReplayedAsOne) {
  io::LogWriter first(folder_ / "log-0000.lcm"), second(folder_ / "log-0001.lcm");
  test::record_run(first, [&](recording::TickLog& log, double time_s) {
    if (time_s == 1.0) log.continue_in(second, 1'000'000'000);
  });
  first.flush();
  second.flush();
  const ReplayReport report = replay({first.path(), second.path()}, {});
  EXPECT_TRUE(report.equal());
  EXPECT_EQ(report.ticks, 260);
  EXPECT_THAT(refusal({second.path()}), HasSubstr("begins with tick 100"));
  EXPECT_THAT(refusal({first.path(), first.path()}), HasSubstr("more than one run"));
}

TEST_F(ReplayTest, ChangedFilesAreNamedBeforeAnythingElse) {
  const fs::path robot = folder_ / "robot";
  fs::copy(test::kRecordedRobot, robot, fs::copy_options::recursive);
  std::ofstream(robot / "clips/forward.yaml", std::ios::app) << "# a comment\n";
  const ReplayReport report = replay({log_}, {.robot = robot.string(), .clips = {}});
  EXPECT_TRUE(report.equal()) << "only a comment changed";
  EXPECT_THAT(report.notes, Contains(StartsWith("clips/forward.yaml is not the file")));
}

TEST_F(ReplayTest, TheLogsConfigurationIsReplayedAndWhatIsUncommonInItNamed) {
  const auto with_option = [&](const char* group, const char* name, double value) {
    return copy([=](test::LogEvent& event) {
      if (event.channel != "ROBOT_INFO") return true;
      auto info = event.as<pmg_msgs::robot_info_t>();
      auto options = nlohmann::ordered_json::parse(info.options);
      options[group][name] = value;
      info.options = options.dump();
      event.set(info);
      return true;
    });
  };
  const ReplayReport milder = replay({with_option("faults", "temperature_degC", 96.0)}, {});
  EXPECT_THAT(milder.notes, Contains("option faults/temperature_degC is the log's 96.0, not 90.0"));
  EXPECT_FALSE(milder.equal()) << "with that limit there would have been no fault";
  EXPECT_NEAR(milder.first->time_s, test::kRecordedFault_s, 0.02);
  const ReplayReport other = replay({with_option("entry", "longest_s", 9.0)}, {});
  EXPECT_TRUE(other.equal()) << "not used in this run";
}

TEST_F(ReplayTest, AnotherRobotIsRefused) {
  try {
    replay({log_}, {.robot = "z1", .clips = {}});
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("other joints"));
  }
}

}  // namespace
}  // namespace pmg::logs
