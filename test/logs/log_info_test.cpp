// pmg_log info reports who ran and what happened, from complete, rotated, cut and foreign logs.
#include "logs/log_info.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "io/log_series.hpp"
#include "log_surgery.hpp"
#include "pmg_msgs/timing_t.hpp"
#include "recorded_run.hpp"

namespace pmg::logs {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class LogInfo : public testing::Test {
 protected:
  LogInfo() {
    fs::create_directories(folder_);
    test::record_run(log_);
  }
  ~LogInfo() override { fs::remove_all(folder_); }

  fs::path folder_ = fs::temp_directory_path() / ("pmg_info_test_" + std::to_string(getpid()));
  fs::path log_ = folder_ / "log.lcm";
};

TEST_F(LogInfo, SaysWhoRanWhatAndWhatHappened) {
  const LogSummary summary = summarise_logs({log_});
  ASSERT_EQ(summary.runs.size(), 1u);
  const RunSummary& run = summary.runs.front();
  EXPECT_EQ(run.info->robot, "biped-7");
  EXPECT_EQ(run.info->bundle, test::recorded_run_info().bundle);
  EXPECT_TRUE(run.from_the_start);
  EXPECT_EQ(run.ticks, 260);
  EXPECT_EQ(run.lost_ticks, 0);
  EXPECT_NEAR(run.duration_s, test::kRecorded_s, 1e-9);
  EXPECT_EQ(run.messages.at("STATE"), 260);
  std::vector<std::string> modes;
  for (const RunSummary::At& mode : run.modes) modes.push_back(mode.text);
  EXPECT_THAT(modes, ElementsAre("passive", "damping", "stand", "walk", "fault", "damping", "stand", "damping"));
  ASSERT_EQ(run.faults.size(), 1u);
  EXPECT_THAT(run.faults[0].text, HasSubstr("temperature"));
  EXPECT_NEAR(run.faults[0].time_s, test::kRecordedFault_s, 0.02) << "found in the tick after";

  const std::string text = to_text(summary);
  for (const char* part : {"biped-7", "policy none", "clips/forward.csv", "walk", "temperature", "260 ticks"}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
  EXPECT_EQ(text.find("duration"), 0u) << "what happened comes first";
  const auto place = [&](const char* part) { return text.find(part); };
  EXPECT_LT(place("\nfaults"), place("\ndriven by"));
  EXPECT_LT(place("\ndriven by"), place("\nrobot"));
  EXPECT_LT(place("\nmessages"), place("\nbundle")) << "hashes come last";
  EXPECT_EQ(text.find('\n', place("\nbundle") + 1), text.find('\n', place(run.info->bundle.c_str())));
  const auto json = to_json(summary)["runs"][0];
  EXPECT_GT(json["driven_s"].size(), 0u) << "somebody drove";
  EXPECT_EQ(json["bundle_files"].size(), run.info->bundle_file.size());
  EXPECT_EQ(json["options"]["blend"], "gain") << "the configuration as JSON, not as text";
  EXPECT_EQ(json["modes"].size(), 8u);
}

TEST_F(LogInfo, LostTicksAreCountedByTheirNumbers) {
  std::int64_t tick = -1;
  test::copy_log(log_, folder_ / "holed.lcm", [&tick](test::LogEvent& event) {
    if (event.channel == "STATE") ++tick;
    return tick < 100 || tick >= 103;
  });
  EXPECT_EQ(summarise_logs({folder_ / "holed.lcm"}).runs.front().lost_ticks, 3);
}

TEST_F(LogInfo, ALogThatBeginsAfterItsFaultStillTellsIt) {
  bool faulted = false;
  test::copy_log(log_, folder_ / "late.lcm", [&faulted](test::LogEvent& event) {
    if (event.channel == "FAULT") {
      faulted = true;
      return false;
    }
    return faulted || event.channel == "ROBOT_INFO";
  });
  const RunSummary run = summarise_logs({folder_ / "late.lcm"}).runs.front();
  ASSERT_EQ(run.faults.size(), 1u);
  EXPECT_THAT(run.faults[0].text, HasSubstr("latched before this log: temperature"));
  EXPECT_EQ(run.modes.front().text, "fault");
}

TEST_F(LogInfo, ALogThatBeginsWithItsFaultTellsItOnce) {
  // From the tick on that latched the fault: its STATUS is before its FAULT.
  std::int64_t faults = 0;
  std::vector<std::size_t> first_of_tick;
  std::size_t index = 0, from = 0;
  test::copy_log(log_, folder_ / "counted.lcm", [&](test::LogEvent& event) {
    if (event.channel == "STATE") first_of_tick.push_back(index);
    if (event.channel == "FAULT" && faults++ == 0) from = first_of_tick.back();
    ++index;
    return true;
  });
  index = 0;
  test::copy_log(log_, folder_ / "from.lcm",
                 [&](test::LogEvent& event) { return index++ >= from || event.channel == "ROBOT_INFO"; });
  const RunSummary run = summarise_logs({folder_ / "from.lcm"}).runs.front();
  ASSERT_EQ(run.faults.size(), 1u);
  EXPECT_EQ(run.faults[0].text.find("temperature"), 0u);
}

TEST_F(LogInfo, PercentilesAreNearestRanksOfTiming) {
  {
    io::LogWriter writer(folder_ / "timing.lcm");
    for (int k = 1; k <= 100; ++k) {
      pmg_msgs::timing_t timing{};
      timing.wake_ns = 1000 * k;
      timing.tick_ns = 5000;
      timing.missed_ticks = k / 50;
      writer.write("TIMING", 10'000'000LL * k, timing);
    }
  }
  const RunSummary run = summarise_logs({folder_ / "timing.lcm"}).runs.front();
  EXPECT_FALSE(run.info.has_value());
  EXPECT_EQ(run.missed_ticks, 2);
  ASSERT_EQ(run.timing.size(), 2u) << "stages that never ran have no line";
  EXPECT_EQ(run.timing[0].name, "wake");
  EXPECT_DOUBLE_EQ(run.timing[0].p50_us, 50.0);
  EXPECT_DOUBLE_EQ(run.timing[0].p99_us, 99.0);
  EXPECT_DOUBLE_EQ(run.timing[0].max_us, 100.0);
  EXPECT_DOUBLE_EQ(run.timing[1].p99_us, 5.0);
}

TEST_F(LogInfo, FoldersAreReadInTheOrderOfRotationAndRunsAreToldApart) {
  io::LogWriter third(folder_ / "log-10000.lcm"), second(folder_ / "log-9999.lcm");
  test::record_run(second, [&](recording::TickLog& log, double time_s) {
    if (time_s == 1.0) log.continue_in(third, 1'000'000'000);
  });
  second.flush();
  third.flush();
  const auto files = io::log_files({folder_});
  ASSERT_EQ(files.size(), 3u);
  EXPECT_EQ(files[1].filename(), "log-9999.lcm") << "by number, not by letters";
  const LogSummary summary = summarise_logs(files);
  ASSERT_EQ(summary.runs.size(), 2u) << "log.lcm is another run: its clock began anew";
  EXPECT_EQ(summary.runs[1].ticks, 260);
  EXPECT_EQ(summary.runs[1].lost_ticks, 0);
  EXPECT_EQ(summary.runs[1].files.size(), 2u);
}

TEST_F(LogInfo, ACutTailIsToldAndTolerated) {
  fs::resize_file(log_, fs::file_size(log_) - 10);
  const LogSummary summary = summarise_logs({log_});
  EXPECT_TRUE(summary.cut_short);
  EXPECT_EQ(summary.runs.front().ticks, 260);
  EXPECT_THAT(to_text(summary), HasSubstr("the last event is incomplete"));
  EXPECT_EQ(to_json(summary)["cut_short"], true);
}

TEST_F(LogInfo, WhatIsNoLogIsRefusedByName) {
  std::ofstream(folder_ / "letter.lcm") << "Dear robot";
  EXPECT_THROW(summarise_logs({folder_ / "letter.lcm"}), std::runtime_error);
  fs::create_directories(folder_ / "empty");
  for (const fs::path& nothing : {folder_ / "empty", folder_ / "absent"}) {
    try {
      io::log_files({nothing});
      FAIL() << nothing;
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), HasSubstr(nothing.string()));
    }
  }
}

}  // namespace
}  // namespace pmg::logs
