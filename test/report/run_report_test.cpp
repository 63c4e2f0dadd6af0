#include "report/run_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "report/run_figures.hpp"
#include "small_log.hpp"

namespace pmg::report {
namespace {

namespace fs = std::filesystem;
using test::SmallLog;
using testing::HasSubstr;
using testing::Not;

class RunReport : public testing::Test {
 protected:
  RunReport() { fs::create_directories(folder_); }
  ~RunReport() override { fs::remove_all(folder_); }

  RunSeries run(const SmallLog& log, const std::string& name = "log.lcm") const {
    log.write(folder_ / name);
    return read_run(folder_ / name);
  }
  const fs::path folder_ = fs::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(RunReport, ShowsEverySection) {
  const std::string html = run_report({run({})}).html();
  for (const char* text :
       {"No fault, did not fall", "Timeline", "Forward velocity vx [m/s]", "Feet on the ground",
        "Slip of the left foot", "Tracking error, RMS", "left_joint, position [rad]", "right_joint, torque [Nm]",
        "Joints whose target was limited", "Temperatures", "2 walk forward", "The 3 steps of scenario small",
        "speed in 10 ticks", "Mean absolute errors over 3.0 s", "Whole tick", "bundle 0123456789ab",
        "1 cycles woke more than 2 ms late"}) {
    EXPECT_THAT(html, HasSubstr(text));
  }
}

TEST_F(RunReport, ShowsAFaultInItsWords) {
  const std::string html = run_report({run({.fault_at = 200})}).html();
  EXPECT_THAT(html, HasSubstr("FAULT at 2.00 s: tilt: the IMU&#39;s link leans 1.20 rad from upright"));
  EXPECT_THAT(html, HasSubstr("class=\"verdict bad\""));
  EXPECT_THAT(html, Not(HasSubstr("class=\"verdict good\"")));
  EXPECT_THAT(html, HasSubstr("[[2.0,\"tilt\"]]")) << "a mark in the timeline";
}

TEST_F(RunReport, NamesBothRunsThatItLaysOverEachOther) {
  const std::string html =
      run_report({run({}, "first.lcm"), run({.robot = "other", .fault_at = 10}, "second.lcm")}).html();
  EXPECT_THAT(html, testing::AllOf(HasSubstr("first.lcm"), HasSubstr("second.lcm")));
  EXPECT_THAT(html, testing::AllOf(HasSubstr("\"measured A\""), HasSubstr("\"measured B\"")));
  EXPECT_THAT(html, testing::AllOf(HasSubstr("class=\"verdict good\""), HasSubstr("class=\"verdict bad\"")));
}

TEST_F(RunReport, LaysRobotsOfOtherJointsOverEachOther) {
  const std::string html = run_report({run({}), run({.joints = {"right_joint", "third", "fourth"}}, "b.lcm")}).html();
  for (const char* joint : {"left_joint, position", "right_joint, position", "fourth, torque"})
    EXPECT_THAT(html, HasSubstr(joint));
}

TEST_F(RunReport, MissingChannelsAreNoError) {
  for (const char* channel : {"ROBOT_INFO", "STATE", "TICK", "REFERENCE", "STATUS", "TIMING", "GROUND_TRUTH"}) {
    EXPECT_THAT(run_report({run({.left_out = {channel}})}).html(), HasSubstr("Timeline")) << channel;
  }
  const RunSeries bare = run({.left_out = {"ROBOT_INFO", "STATE", "TICK", "REFERENCE", "TIMING", "GROUND_TRUTH"}});
  const std::string html = run_report({bare}).html();
  EXPECT_THAT(html, HasSubstr("The log has no joints"));
  EXPECT_THAT(html, HasSubstr("No wall-clock times"));
}

TEST_F(RunReport, TellsWhatCouldNotBeRead) {
  const fs::path log = folder_ / "cut.lcm";
  SmallLog{}.write(log);
  fs::resize_file(log, fs::file_size(log) - 100);
  EXPECT_THAT(run_report({read_run(log)}).html(), HasSubstr("a log file ends in the middle of an event"));
}

TEST_F(RunReport, NamesOfALogNeverBecomeMarkup) {
  const std::string evil = "</script><img src=x onerror=alert(1)>";
  const std::string html =
      run_report({run({.robot = evil, .joints = {evil, "b"}, .fault_at = 100, .fault_text = evil})}).html();
  EXPECT_THAT(html, Not(HasSubstr("<img")));
  EXPECT_THAT(html, HasSubstr("&lt;img"));
}

TEST_F(RunReport, StaysSmall) {
  SmallLog log{.ticks = 9000};
  for (int joint = 2; joint < 31; ++joint) log.joints.push_back("joint_" + std::to_string(joint));
  EXPECT_LT(run_report({run(log)}).html().size(), 6'000'000U) << "90 s of 31 joints";
}

TEST_F(RunReport, RefusesNoneAndTooMany) {
  EXPECT_THROW(run_report({}), std::invalid_argument);
  EXPECT_THROW(run_report(std::vector<RunSeries>(kMostRuns + 1)), std::invalid_argument);
}

TEST_F(RunReport, OfALogThatWasNotReadToItsEndNoLineIsGreen) {
  RunSeries whole = run({});
  EXPECT_THAT(run_report({whole}).html(), HasSubstr("class=\"verdict good\""));
  RunSeries cut = whole, ended = whole;
  cut.problems = {"a log file ends in the middle of an event: its end is missing"};
  ended.interrupted = true;
  EXPECT_EQ(worth_of_reading(cut).exit_code(), 1);
  EXPECT_EQ(worth_of_reading(ended).exit_code(), 130);
  for (const RunSeries& series : {cut, ended}) {
    EXPECT_THAT(run_report({whole, series}).html(), Not(HasSubstr("class=\"verdict good\"")));
    EXPECT_EQ(run_json(series)["worth"], work::name(worth_of_reading(series).grade()));
  }
  EXPECT_EQ(worth_of_reading(run({.fault_at = 200})).sentence(), "")
      << "the log was read; what it shows is another thing";
}

TEST_F(RunReport, SaysThatReadingWasInterrupted) {
  SmallLog{.ticks = 9000}.write(folder_ / "long.lcm");
  const RunSeries run = read_run(folder_ / "long.lcm", {.report = {}, .interrupted = [] { return true; }});
  EXPECT_EQ(worth_of_reading(run).grade(), work::Grade::kInterrupted);
}

}  // namespace
}  // namespace pmg::report
