#include "report/run_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "report/run_figures.hpp"
#include "small_log.hpp"
#include "temporary_folder.hpp"

namespace pmg::report {
namespace {

namespace fs = std::filesystem;
using test::SmallLog;
using testing::HasSubstr;
using testing::Not;

class RunReport : public testing::Test {
 protected:
  RunReport() { fs::create_directories(folder_); }

  RunSeries run(const SmallLog& log, const std::string& name = "log.lcm") const {
    log.write(folder_ / name);
    return read_run(folder_ / name);
  }
  const test::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.file("run");
};

TEST_F(RunReport, ShowsEverySection) {
  const std::string html = run_report({run({})}).html();
  for (const char* text :
       {"No fault, did not fall", "Timeline", "Forward velocity vx [m/s]", "Feet on the ground",
        "Slip of the left foot", "Tracking error, RMS", "left_joint, position [rad]", "right_joint, torque [Nm]",
        "Joints whose target was limited", "Temperatures", "2 walk forward", "The 3 steps of scenario small",
        "speed in 10 ticks", "Mean absolute errors over 3.0 s", "Whole tick", "bundle 0123456789ab",
        "1 cycle woke more than 2 ms late"}) {
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

TEST_F(RunReport, ARunThatWasAskedForMoreThanItsRobotCanDoIsNotGreenAndSaysSoFirst) {
  const RunSeries cut = run({.beyond_vx_m_s = 50.0});
  const std::string html = run_report({cut}).html();
  EXPECT_THAT(html, Not(HasSubstr("class=\"verdict good\"")));
  EXPECT_THAT(html, HasSubstr("class=\"verdict unfinished\">PARTIAL: the command was cut, and the robot did what was "
                              "admitted: forward 50 m/s asked, 0.5 m/s admitted. "));
  EXPECT_THAT(verdict(cut), HasSubstr("did not fall. COMMAND CUT for 2.0 s: forward 50 m/s asked, 0.5 m/s admitted."));
  EXPECT_EQ(run_json(cut)["command_cut"]["text"], "forward 50 m/s asked, 0.5 m/s admitted");
  EXPECT_EQ(worth_of_reading(cut).exit_code(), 0) << "the log was read";
  EXPECT_TRUE(run_json(run({}))["command_cut"].is_null());
  EXPECT_THAT(verdict(run({})), Not(HasSubstr("CUT")));
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

/// Where these texts begin in the page, which has each of them.
std::vector<std::size_t> places(const std::string& html, const std::vector<std::string>& texts) {
  std::vector<std::size_t> found;
  for (const std::string& text : texts) {
    found.push_back(html.find(text));
    EXPECT_NE(found.back(), std::string::npos) << text;
  }
  return found;
}

TEST_F(RunReport, WhatHappenedStandsInOrderOfTime) {
  RunSeries one = run({.fault_at = 200}), other = run({}, "b.lcm");
  one.guard_trips = {{0.75, "the guard acted"}};
  one.stops = {{2.5, "somebody stopped it"}, {0.25, "stopped early"}};
  other.stops = {{1.5, "the other was stopped"}};
  const std::vector<std::size_t> at =
      places(run_report({one, other}).html(), {"<td>0.25 A</td><td>stopped early", "<td>0.75 A</td><td>the guard acted",
                                               "<td>1.50 B</td><td>the other was stopped", "<td>2.00 A</td><td>tilt",
                                               "<td>2.50 A</td><td>somebody stopped it"});
  EXPECT_TRUE(std::ranges::is_sorted(at));
}

TEST_F(RunReport, NamesTheStepsWhoseNumbersTheTimelineShows) {
  const std::string html = run_report({run({}), run({}, "b.lcm")}).html();
  const std::string names = "<p>Steps A: 1\u00a0stand, 2\u00a0walk forward, 3\u00a0walk forward.</p>";
  EXPECT_THAT(html, HasSubstr(names));
  EXPECT_THAT(html, Not(HasSubstr("Steps B"))) << "the same steps are told once";
}

/// The drawings of the page's charts, by title.
std::map<std::string, nlohmann::json> charts(const std::string& html) {
  std::map<std::string, nlohmann::json> found;
  const std::string open = "<script type=\"application/json\">";
  for (std::size_t at = html.find(open); at != std::string::npos; at = html.find(open, at + 1)) {
    const std::size_t begin = at + open.size(), title = html.rfind("<h3>", at) + 4;
    found[html.substr(title, html.find("</h3>", title) - title)] =
        nlohmann::json::parse(html.substr(begin, html.find("</script>", begin) - begin));
  }
  return found;
}

TEST_F(RunReport, ALimitHasOneColourInEveryPicture) {
  const auto drawn = charts(run_report({run({})}).html());
  const nlohmann::json& lanes =
      drawn.at("Joints whose target was limited: by range (blue), speed (orange), torque (red)");
  const nlohmann::json& counts = drawn.at("How many joints&#39; targets were limited, and by what");
  EXPECT_EQ(lanes["lanes"][0]["stretches"][0][3], pages::colour::kOrange) << "speed";
  for (const auto& [name, colour] :
       {std::pair{"range", pages::colour::kSky}, std::pair{"speed", pages::colour::kOrange},
        std::pair{"torque", pages::colour::kVermillion}}) {
    const auto line = std::ranges::find(counts["lines"], name, [](const auto& one) { return one["name"]; });
    ASSERT_NE(line, counts["lines"].end()) << name;
    EXPECT_EQ((*line)["colour"], colour) << name;
  }
}

TEST_F(RunReport, AMistypedCommandDoesNotFlattenWhatTheRobotDid) {
  RunSeries typed = run({});
  typed.reference.user[kVx].at(150) = 50.0;
  const auto lines = [](const RunSeries& series) {
    return charts(run_report({series}).html()).at("Forward velocity vx [m/s]")["lines"];
  };
  EXPECT_FALSE(lines(typed)[0].contains("widens")) << "this log doesn't say what the robot takes";
  typed.info.options = R"({"command": {"lower": {"vx_m_s": -0.5, "vy_m_s": -1, "omega_rad_s": -1, "pitch_rad": -1,
    "roll_rad": -1, "height_m": -1}, "upper": {"vx_m_s": 0.8, "vy_m_s": 1, "omega_rad_s": 1, "pitch_rad": 1,
    "roll_rad": 1, "height_m": 1}}})";
  for (const nlohmann::json& line : lines(typed)) {
    EXPECT_EQ(line.contains("widens"), line["name"] == "asked") << line["name"];
    if (!line.contains("widens")) continue;
    EXPECT_NEAR(line["widens"][0].get<double>(), -0.75, 1e-9);
    EXPECT_NEAR(line["widens"][1].get<double>(), 1.2, 1e-9) << "half as much again as the robot takes is seen";
  }
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

TEST_F(RunReport, AFilesWorthIsThatOfItsRunAndTheReadingsStandsBesideIt) {
  const nlohmann::ordered_json whole = run_json(run({})), faulted = run_json(run({.fault_at = 200}));
  EXPECT_EQ(whole["worth"], "holds");
  EXPECT_EQ(faulted["worth"], "missed") << "as its line of the page";
  EXPECT_EQ(faulted["reservations"][0]["why"], "the robot faulted");
  EXPECT_EQ(faulted["reading"]["worth"], "holds");
  RunSeries cut = run({.fault_at = 200});
  cut.problems = {"its end is missing"};
  EXPECT_EQ(run_json(cut)["worth"], "missed");
  EXPECT_EQ(run_json(cut)["reservations"].size(), 2U);
  EXPECT_EQ(run_json(cut)["reading"]["worth"], "partial");
}

TEST_F(RunReport, SaysThatReadingWasInterrupted) {
  SmallLog{.ticks = 9000}.write(folder_ / "long.lcm");
  const RunSeries run = read_run(folder_ / "long.lcm", {.report = {}, .interrupted = [] { return true; }});
  EXPECT_EQ(worth_of_reading(run).grade(), work::Grade::kInterrupted);
}

}  // namespace
}  // namespace pmg::report
