// pmg_controller, used as by its users, on memq://, which needs no network.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <net/if.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/running_program.hpp"
#include "io/clock.hpp"
#include "io/log_reader.hpp"
#include "pmg_msgs/motor_command_t.hpp"
#include "pmg_msgs/robot_info_t.hpp"
#include "pmg_msgs/status_t.hpp"

namespace pmg {
namespace {

namespace fs = std::filesystem;
using test::RunningProgram;
using testing::HasSubstr;

class PmgController : public testing::Test {
 protected:
  PmgController() { fs::create_directories(folder_); }
  ~PmgController() override { fs::remove_all(folder_); }

  std::string log() const { return (folder_ / "log").string(); }
  fs::path log_file() const { return folder_ / "log/log-0000.lcm"; }
  std::vector<std::string> arguments(std::vector<std::string> more) const {
    std::vector<std::string> all = {"--hal", "sil", "--gantry", "--lcm-url", "memq://"};
    // Another test may run a controller beside this one, and of one name only one runs.
    if (std::ranges::find(more, "--name") == more.end()) {
      all.push_back("--name");
      all.push_back("tested_" + std::to_string(getpid()));
    }
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  test::Finished run(std::vector<std::string> more) const {
    RunningProgram program("pmg_controller", std::move(more), folder_);
    return program.finish();
  }
  void expect_refused(std::vector<std::string> more, const std::string& message) const {
    const test::Finished refused = run(std::move(more));
    EXPECT_EQ(refused.exit_code, 2) << refused.err;
    EXPECT_THAT(refused.err, HasSubstr(message));
    EXPECT_EQ(refused.out, "");
  }
  bool log_has_begun() const {
    std::error_code none;
    return fs::file_size(log_file(), none) > 200'000 && !none;
  }

  fs::path folder_ = fs::temp_directory_path() / ("pmg_controller_test_" + std::to_string(getpid()));
};

TEST_F(PmgController, HelpHasAnExampleAndTheExitCodes) {
  const test::Finished help = run({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.out, HasSubstr("Example:"));
  EXPECT_THAT(help.out, HasSubstr("Exit codes: 0"));
  EXPECT_THAT(help.out, HasSubstr("not safety-rated"));
}

TEST_F(PmgController, BadInputExitsWithTwoAndSaysWhat) {
  expect_refused({}, "--hal");
  if (if_nametoindex("can0") == 0) {  // a kernel without CAN, or without this interface
    expect_refused({"--hal", "can", "--lcm-url", "memq://", "--no-log"}, "pmg_controller: can0: ");
  }
  expect_refused({"--hal", "ethercat"}, "ethercat: ");  // not in this robot.yaml, or not in this build
  expect_refused({"--hal", "pigeon"}, "--hal");
  expect_refused(arguments({"--robot", "nobody"}), "nobody");
  expect_refused(arguments({"--policy", "runner"}), "--policy runner");
  expect_refused(arguments({"--clips", (folder_ / "none").string()}), "none");
  expect_refused(arguments({"--bus-priority", "100"}), "--bus-priority");
  expect_refused(arguments({"--control-cpu", "-7"}), "--control-cpu");
  expect_refused(arguments({"--duration", "-1"}), "--duration");
  expect_refused(arguments({"--log", log(), "--no-log"}), "--no-log");
  expect_refused({"--hal", "sil", "--lcm-url", "carrier://pigeon", "--log", log()}, "carrier://pigeon");
  EXPECT_FALSE(fs::exists(log())) << "bad input writes nothing";
}

TEST_F(PmgController, ALogFolderThatCannotBeMadeIsRefused) {
  std::ofstream(folder_ / "file") << "in the way";
  expect_refused(arguments({"--log", (folder_ / "file/log").string()}), "file/log");
}

TEST_F(PmgController, ConfigInForceIsPrinted) {
  const test::Finished printed = run(arguments({"--print-config", "--control-priority", "33", "--name", "left"}));
  ASSERT_EQ(printed.exit_code, 0) << printed.err;
  const auto config = nlohmann::json::parse(printed.out);
  EXPECT_EQ(config["name"], "left");
  EXPECT_EQ(config["lcm_url"], "memq://");
  EXPECT_EQ(config["realtime"]["control"]["priority"], 33);
  EXPECT_EQ(config["control_period_s"], 0.01);
}

TEST_F(PmgController, ThreeSecondsOfThreadsLoseNothing) {
  const test::Finished run3 = run(arguments({"--duration", "3", "--json", "--log", log(), "--name", "soaked"}));
  ASSERT_EQ(run3.exit_code, 0) << run3.err;
  const auto json = nlohmann::json::parse(run3.out);
  // Cycles run and cycles skipped add up to the elapsed time. Counts, because a shared host guarantees no times.
  for (const auto& [thread, rate_Hz] : {std::pair{"control", 100}, std::pair{"bus", 500}}) {
    const auto& cycles = json[thread];
    const std::int64_t due = cycles["cycles"].get<std::int64_t>() + cycles["missed"].get<std::int64_t>();
    EXPECT_GE(due, 3 * rate_Hz) << thread;
    EXPECT_GT(cycles["cycles"].get<std::int64_t>(), 10) << thread;
    EXPECT_GT(cycles["wake_us"]["p99"].get<double>(), 0.0) << thread;
  }
  EXPECT_EQ(json["logged_ticks"], json["control"]["cycles"]);
  EXPECT_EQ(json["lost_ticks"], 0);
  EXPECT_EQ(json["dropped_records"], 0);
  EXPECT_EQ(json["realtime"].get<bool>(), json["refused"].empty());
  EXPECT_THAT(run3.err, HasSubstr("soaked on sil, bundle "));
  for (const auto& refused : json["refused"]) EXPECT_THAT(run3.err, HasSubstr(refused.get<std::string>()));
}

TEST_F(PmgController, WithoutRealTimeItSaysSoAtTheStartAndInTheLog) {
  const test::Finished ordinary = run(arguments({"--duration", "0.2", "--json", "--log", log(), "--no-realtime"}));
  ASSERT_EQ(ordinary.exit_code, 0) << ordinary.err;
  EXPECT_THAT(ordinary.err, HasSubstr("NOT REAL-TIME: "));
  EXPECT_EQ(nlohmann::json::parse(ordinary.out)["realtime"], false);
  io::LogReader reader(log_file());
  bool told = false;
  while (reader.next()) {
    if (reader.channel() == "ROBOT_INFO") told = reader.decode<pmg_msgs::robot_info_t>().value().refused_count > 0;
    if (reader.channel() != "STATUS") continue;
    EXPECT_FALSE(reader.decode<pmg_msgs::status_t>().value().realtime);
  }
  EXPECT_TRUE(told);
}

TEST_F(PmgController, ASecondRunInOneFolderGetsAFolderOfItsOwnAndSaysSo) {
  const std::vector<std::string> same = arguments({"--duration", "0.2", "--log", log(), "--no-realtime"});
  ASSERT_EQ(run(same).exit_code, 0);
  const auto first = fs::file_size(log_file());
  const test::Finished second = run(same);
  ASSERT_EQ(second.exit_code, 0) << second.err;
  EXPECT_THAT(second.err, HasSubstr("has the log of another run: this one's goes to " + log() + "-2"));
  EXPECT_EQ(fs::file_size(log_file()), first);
  EXPECT_TRUE(fs::exists(log() + "-2/log-0000.lcm"));
}

class PmgControllerSignal : public PmgController, public testing::WithParamInterface<int> {};

TEST_P(PmgControllerSignal, DampsClosesTheLogAndExitsWithZero) {
  RunningProgram program("pmg_controller", arguments({"--log", log()}), folder_);
  ASSERT_TRUE(program.until([&] { return log_has_begun(); })) << program.err();
  program.send(GetParam());
  EXPECT_EQ(program.wait(), 0) << program.err();
  EXPECT_THAT(program.err(), HasSubstr("damping"));
  io::LogReader reader(log_file());
  pmg_msgs::status_t status{};
  pmg_msgs::motor_command_t command{};
  while (reader.next()) {
    const bool read = (reader.channel() != "STATUS" || reader.decode_into(status)) &&
                      (reader.channel() != "MOTOR_COMMAND" || reader.decode_into(command));
    ASSERT_TRUE(read);
  }
  EXPECT_EQ(status.mode, 1) << "damping";
  ASSERT_GT(command.joint_count, 0);
  for (std::size_t j = 0; j < command.kp_Nm_per_rad.size(); ++j) {
    EXPECT_EQ(command.kp_Nm_per_rad[j], 0.0);
    EXPECT_GT(command.kd_Nm_s_per_rad[j], 0.0);
  }
}

INSTANTIATE_TEST_SUITE_P(EverySignalThatEnds, PmgControllerSignal, testing::Values(SIGINT, SIGTERM, SIGHUP));

TEST_F(PmgController, AfterALogThatWasDeletedWhileItRanItsExitCodeIsOne) {
  RunningProgram program("pmg_controller", arguments({"--log", log()}), folder_);
  ASSERT_TRUE(program.until([&] { return log_has_begun(); })) << program.err();
  fs::remove_all(log());
  ASSERT_TRUE(program.until([&] { return program.err().find("was deleted") != std::string::npos; })) << program.err();
  program.send(SIGINT);
  EXPECT_EQ(program.wait(), 1) << program.err();
}

TEST_F(PmgController, KilledInTheMiddleItsLogReadsUpToTheLastSecond) {
  RunningProgram program("pmg_controller", arguments({"--log", log()}), folder_);
  ASSERT_TRUE(program.until([&] { return log_has_begun(); })) << program.err();
  const std::int64_t killed_ns = io::WallClock().now_ns();  // the clock that stamps the log
  program.send(SIGKILL);
  EXPECT_EQ(program.wait(), -SIGKILL);
  io::LogReader reader(log_file());
  std::int64_t last_ns = 0;
  while (reader.next()) last_ns = std::max(last_ns, reader.stamp_ns());
  EXPECT_GT(last_ns, killed_ns - 1'000'000'000);
}

}  // namespace
}  // namespace pmg
