// The files of a run: every tick is in them, in spite of failures of disk, log thread or process; and the half minute
// before a fault.
#include "recording/recorder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <memory>
#include <optional>
#include <vector>

#include "io/log_reader.hpp"
#include "pmg_msgs/fault_t.hpp"
#include "pmg_msgs/robot_info_t.hpp"
#include "pmg_msgs/tick_input_t.hpp"
#include "pmg_msgs/timing_t.hpp"
#include "recording/full_disk.hpp"
#include "recording/record_source.hpp"

namespace pmg::recording {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class RecorderTest : public testing::Test {
 protected:
  RecorderTest() { fs::create_directories(folder_); }
  ~RecorderTest() override { fs::remove_all(folder_); }

  RecorderOptions options() const { return {.directory = folder_, .spare_bytes = 0}; }
  std::unique_ptr<Recorder> recorder(const RecorderOptions& options) {
    return std::make_unique<Recorder>(*outbox_, robot_, run_, source_.clock, options,
                                      [this](const std::string& text) { said_.push_back(text); });
  }
  /// Runs ticks; the recorder makes a pass every other tick, as in the log's thread.
  void run(int ticks, Recorder& recorder) {
    for (int k = 0; k < ticks; ++k) {
      source_.tick(*outbox_);
      if (k % 2 == 1) recorder.drain();
    }
    recorder.drain();
  }

  /// Files of the folder whose names begin so, sorted.
  std::vector<std::string> files(const std::string& beginning) const {
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with(beginning)) names.push_back(name);
    }
    std::ranges::sort(names);
    return names;
  }
  struct Contents {
    std::vector<std::string> channels;
    std::vector<std::int64_t> ticks;
    std::vector<pmg_msgs::timing_t> timings;
    std::vector<pmg_msgs::fault_t> faults;
    std::optional<pmg_msgs::robot_info_t> info;
  };
  Contents read(const std::string& name) const {
    io::LogReader reader(folder_ / name);
    Contents contents;
    while (reader.next()) {
      contents.channels.push_back(reader.channel());
      if (reader.channel() == "TICK") contents.ticks.push_back(reader.decode<pmg_msgs::tick_input_t>()->tick);
      if (reader.channel() == "TIMING") contents.timings.push_back(*reader.decode<pmg_msgs::timing_t>());
      if (reader.channel() == "FAULT") contents.faults.push_back(*reader.decode<pmg_msgs::fault_t>());
      if (reader.channel() == "ROBOT_INFO") contents.info = reader.decode<pmg_msgs::robot_info_t>();
    }
    EXPECT_EQ(reader.skipped_bytes(), 0) << name;
    return contents;
  }
  std::string text(const std::string& name) const {
    std::ifstream file(folder_ / name);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  static std::vector<std::int64_t> range(std::int64_t from, std::int64_t to) {
    std::vector<std::int64_t> numbers;
    for (std::int64_t k = from; k < to; ++k) numbers.push_back(k);
    return numbers;
  }

  fs::path folder_ = fs::temp_directory_path() / ("pmg_recorder_test_" + std::to_string(getpid()));
  const model::RobotModel& robot_ = test::biped();
  RunInfo run_{.robot = "biped-2", .session = 42, .policy = "none", .bundle = "abc"};
  std::unique_ptr<control::ControllerOutbox> outbox_ = std::make_unique<control::ControllerOutbox>();
  test::RecordSource source_{robot_};
  std::vector<std::string> said_;
};

TEST_F(RecorderTest, EveryTickIsInTheLogInOrderWithTheBusCyclesBeforeIt) {
  const auto recorder = this->recorder(options());
  source_.missed = 3;
  run(20, *recorder);
  recorder->close();
  EXPECT_EQ(recorder->written(), 20);
  const Contents log = read("log-0000.lcm");
  EXPECT_EQ(log.channels.front(), "ROBOT_INFO");
  EXPECT_EQ(log.info->robot, "biped-2");
  EXPECT_EQ(log.info->bundle, "abc");
  EXPECT_EQ(log.ticks, range(0, 20));
  ASSERT_EQ(log.timings.size(), 20u);
  for (const pmg_msgs::timing_t& timing : log.timings) {
    EXPECT_EQ(timing.bus_cycles, 5);
    EXPECT_EQ(timing.bus_wake_max_ns, 24'000);
    EXPECT_EQ(timing.bus_exchange_max_ns, 130'000);
    EXPECT_EQ(timing.bus_missed_cycles, 3);
    EXPECT_EQ(timing.wake_ns, 30'000);
    EXPECT_EQ(timing.dropped_records, 0);
  }
  EXPECT_TRUE(said_.empty());
}

TEST_F(RecorderTest, FilesOfABoundedSizeStandAloneAndTheNewestAreKept) {
  RecorderOptions small = options();
  small.file_bytes = 50'000;
  small.files = 3;
  const auto recorder = this->recorder(small);
  run(200, *recorder);
  recorder->close();
  const auto names = files("log-");
  ASSERT_EQ(names.size(), 3u);
  std::vector<std::int64_t> ticks;
  for (const std::string& name : names) {
    EXPECT_LT(fs::file_size(folder_ / name), 60'000u) << "one tick above the limit at most";
    const Contents log = read(name);
    EXPECT_EQ(log.channels.front(), "ROBOT_INFO") << name;
    ticks.insert(ticks.end(), log.ticks.begin(), log.ticks.end());
  }
  EXPECT_GT(ticks.front(), 0) << "the oldest are gone";
  EXPECT_EQ(ticks, range(ticks.front(), 200)) << "no tick is lost between files";
}

TEST_F(RecorderTest, ALaterRunInTheSameFolderOverwritesNothing) {
  for (int again = 0; again < 2; ++again) {
    const auto recorder = this->recorder(options());
    run(3, *recorder);
  }
  EXPECT_THAT(files("log-"), ElementsAre("log-0000.lcm", "log-0001.lcm"));
  EXPECT_EQ(read("log-0000.lcm").ticks, range(0, 3));
  EXPECT_EQ(read("log-0001.lcm").ticks, range(3, 6));
}

TEST_F(RecorderTest, KilledInTheMiddleTheLogHasEverythingUpToTheLastPass) {
  int told[2];
  ASSERT_EQ(pipe(told), 0);
  const pid_t child = fork();
  if (child == 0) {
    const auto recorder = this->recorder(options());
    for (std::int64_t tick = 1;; tick += 2) {
      source_.ticks(2, *outbox_);
      recorder->drain();
      if (write(told[1], &tick, sizeof tick) != sizeof tick) _exit(1);
    }
  }
  close(told[1]);
  std::int64_t last_tick = -1;
  while (last_tick < 301 && ::read(told[0], &last_tick, sizeof last_tick) == sizeof last_tick) {
  }
  ASSERT_EQ(kill(child, SIGKILL), 0);
  int status = 0;
  waitpid(child, &status, 0);
  while (::read(told[0], &last_tick, sizeof last_tick) == sizeof last_tick) {  // ticks reported until then
  }
  close(told[0]);
  ASSERT_TRUE(WIFSIGNALED(status));
  ASSERT_GE(last_tick, 301);
  // Not through read(), because the last event may be cut short.
  io::LogReader reader(folder_ / "log-0000.lcm");
  std::int64_t ticks = 0;
  while (reader.next()) ticks += reader.channel() == "STATUS" ? 1 : 0;
  EXPECT_GE(ticks, last_tick + 1) << "every tick of a pass that had returned";
}

TEST_F(RecorderTest, AFullDiskIsToldOnceAndTheLogGoesOnInANewFileThatCountsWhatIsLost) {
  const auto recorder = this->recorder(options());
  run(10, *recorder);
  {
    const test::FullDisk full;
    run(500, *recorder);
    EXPECT_EQ(said_.size(), 1u);
    EXPECT_THAT(said_.back(), HasSubstr("LOG STOPPED"));
    EXPECT_THAT(said_.back(), HasSubstr("log-0000.lcm"));
    EXPECT_THAT(files("log-"), ElementsAre("log-0000.lcm")) << "no empty files pile up";
    EXPECT_EQ(recorder->lost(), 500);
  }
  run(150, *recorder);
  recorder->close();
  ASSERT_GE(said_.size(), 2u);
  EXPECT_THAT(said_[1], HasSubstr("writing again"));
  EXPECT_THAT(files("log-"), ElementsAre("log-0000.lcm", "log-0001.lcm"));
  EXPECT_EQ(read("log-0000.lcm").ticks, range(0, 10));
  const Contents after = read("log-0001.lcm");
  EXPECT_EQ(after.channels.front(), "ROBOT_INFO");
  ASSERT_FALSE(after.ticks.empty());
  EXPECT_EQ(after.ticks, range(after.ticks.front(), 660));
  EXPECT_EQ(after.timings.back().dropped_records, after.ticks.front() - 10);
  EXPECT_THAT(said_[1], HasSubstr(std::to_string(after.ticks.front() - 10) + " ticks"));
  EXPECT_LE(after.ticks.front(), 510 + 100) << "tried again every second";
}

TEST_F(RecorderTest, AfterARefusalItWaitsForRoomToSpare) {
  RecorderOptions greedy = options();
  greedy.spare_bytes = std::int64_t{1} << 60;
  const auto recorder = this->recorder(greedy);
  {
    const test::FullDisk full;
    run(10, *recorder);
  }
  run(300, *recorder);
  EXPECT_THAT(files("log-"), ElementsAre("log-0000.lcm"));
  EXPECT_EQ(recorder->lost(), 310);
}

TEST_F(RecorderTest, AStalledLogThreadCostsRecordsNeverTimeAndSaysSo) {
  const auto recorder = this->recorder(options());
  source_.ticks(static_cast<int>(control::ControllerOutbox::kRecords) + 76, *outbox_);
  EXPECT_EQ(outbox_->dropped().records, 76) << "the control thread counts and goes on";
  recorder->drain();
  run(10, *recorder);
  recorder->close();
  ASSERT_GE(said_.size(), 1u);
  EXPECT_THAT(said_.front(), HasSubstr("76 ticks are missing"));
  const Contents log = read("log-0000.lcm");
  std::vector<std::int64_t> expected = range(0, control::ControllerOutbox::kRecords);
  const auto later = range(control::ControllerOutbox::kRecords + 76, control::ControllerOutbox::kRecords + 86);
  expected.insert(expected.end(), later.begin(), later.end());
  EXPECT_EQ(log.ticks, expected) << "order kept";
  EXPECT_EQ(log.timings.back().dropped_records, 76);
  EXPECT_EQ(log.timings.back().dropped_bus_cycles, 0) << "1100 ticks have fewer than 8192 bus cycles";
}

TEST_F(RecorderTest, AFolderThatCannotBeMadeIsAnErrorAtTheStart) {
  std::ofstream(folder_ / "file") << "";
  RecorderOptions impossible = options();
  impossible.directory = folder_ / "file" / "logs";
  EXPECT_THROW(recorder(impossible), std::runtime_error);
  impossible.directory = folder_ / "file";
  try {
    recorder(impossible);
    ADD_FAILURE() << "a file is no folder";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("a file has this name; expected a folder, or a new name"));
  }
  const test::FullDisk full;
  EXPECT_THROW(recorder(options()), std::runtime_error) << "nothing can be logged from the first tick on";
}

TEST_F(RecorderTest, AFolderThatIsDeletedIsToldAtOnceAndMadeAnew) {
  const auto recorder = this->recorder(options());
  run(10, *recorder);
  fs::remove_all(folder_);
  run(20, *recorder);
  ASSERT_GE(said_.size(), 2u);
  EXPECT_THAT(said_[0], HasSubstr("log-0000.lcm was deleted or replaced"));
  EXPECT_THAT(said_[1], HasSubstr("writing again, into " + (folder_ / "log-0001.lcm").string()));
  recorder->close();
  EXPECT_EQ(read("log-0001.lcm").ticks, range(10, 30)) << "no tick after the deletion is missing";
  EXPECT_EQ(recorder->lost(), 10) << "those before it went with the folder";
  EXPECT_FALSE(recorder->complete());
}

TEST_F(RecorderTest, AFolderThatCannotBeMadeAnewIsReplacedByAnother) {
  run_.session = getpid();
  const fs::path other = other_log_folder(run_);
  const auto recorder = this->recorder(options());
  run(10, *recorder);
  fs::remove_all(folder_);
  std::ofstream(folder_) << "no folder any more";
  run(10, *recorder);
  source_.fault(faults::FaultCode::kTilt);
  run(300, *recorder);
  recorder->close();
  EXPECT_EQ(recorder->file(), other / "log-0001.lcm");
  EXPECT_EQ(recorder->lost(), 10);
  EXPECT_EQ(recorder->flight().written(), 1) << "the flight recorder too";
  EXPECT_TRUE(std::ranges::any_of(said_, [&](const std::string& text) {
    return text.find("flight recorder: " + other.string()) != std::string::npos;
  }));
  fs::remove_all(other);
}

TEST_F(RecorderTest, WhatIsDeletedAtTheVeryEndIsMissed) {
  const auto recorder = this->recorder(options());
  run(10, *recorder);
  EXPECT_TRUE(recorder->complete());
  fs::remove(folder_ / "log-0000.lcm");
  recorder->close();
  EXPECT_FALSE(recorder->complete());
}

TEST_F(RecorderTest, AConsoleThatThrowsEndsNothing) {
  Recorder recorder(*outbox_, robot_, run_, source_.clock, options(),
                    [](const std::string&) { throw std::runtime_error("no console"); });
  {
    const test::FullDisk full;
    run(10, recorder);
  }
  run(150, recorder);
  recorder.close();
  EXPECT_FALSE(read("log-0001.lcm").ticks.empty());
}

// The flight recorder alone: the ordinary log is switched off.
class FlightRecorderTest : public RecorderTest {
 protected:
  RecorderOptions without_log() const {
    RecorderOptions result = options();
    result.log = false;
    return result;
  }
  std::string only_flight() const {
    std::vector<std::string> logs;
    for (const std::string& name : files("fault-")) {
      if (name.ends_with(".lcm")) logs.push_back(name);
    }
    EXPECT_EQ(logs.size(), 1u);
    return logs.empty() ? "" : logs.front();
  }
};

TEST_F(FlightRecorderTest, WritesHalfAMinuteBeforeAFaultAndASecondAfterIt) {
  const auto recorder = this->recorder(without_log());
  run(4000, *recorder);
  EXPECT_TRUE(files("").empty()) << "nothing without a fault";
  source_.fault(faults::FaultCode::kTemperature, 0);
  run(99, *recorder);
  EXPECT_TRUE(files("").empty()) << "the second after it is still awaited";
  run(100, *recorder);
  const Contents flight = read(only_flight());
  EXPECT_EQ(flight.ticks, range(1000, 4101)) << "fault in tick 4000";
  EXPECT_EQ(flight.timings.size(), 3101u);
  ASSERT_GE(flight.channels.size(), 2u);
  EXPECT_EQ(flight.channels[0], "ROBOT_INFO");
  EXPECT_EQ(flight.channels[1], "FAULT") << "begins with the cause";
  ASSERT_EQ(flight.faults.size(), 1u) << "and has it once";
  EXPECT_THAT(flight.faults[0].text, HasSubstr("temperature"));
  EXPECT_EQ(flight.faults[0].stamp_ns, 40'010'000'000);
  EXPECT_TRUE(files("log-").empty()) << "the ordinary log is off";
}

TEST_F(FlightRecorderTest, TheTextTellsTheOperatorWhatHappenedAndWhatToDo) {
  const auto recorder = this->recorder(without_log());
  run(200, *recorder);
  source_.fault(faults::FaultCode::kTemperature, 0);
  run(200, *recorder);
  const std::string name = only_flight();
  const std::string page = text(fs::path(name).replace_extension(".txt"));
  const std::string first_line = page.substr(0, page.find('\n'));
  EXPECT_THAT(first_line, HasSubstr(robot_.joint_index.name(0)));
  EXPECT_THAT(first_line, HasSubstr("95.0"));
  for (const char* part : {"biped-2", "Mode before  walk", "Driven by    nobody", "tester #200: vx 0.40 m/s",
                           "tester #0: walk", faults::advice(faults::FaultCode::kTemperature), "reset",
                           "301 ticks, from 2.00 s before the fault to 1.00 s after"}) {
    EXPECT_THAT(page, HasSubstr(part));
  }
  EXPECT_THAT(page, HasSubstr(name));
}

TEST_F(FlightRecorderTest, EachFaultHasItsOwnFileAndNamesSortByTime) {
  const auto recorder = this->recorder(without_log());
  std::vector<std::string> in_order;
  for (const faults::FaultCode code :
       {faults::FaultCode::kTilt, faults::FaultCode::kBusLost, faults::FaultCode::kTilt}) {
    source_.fault(code);
    run(50, *recorder);
    source_.reset();
    run(200, *recorder);
    in_order.push_back(to_string(code));
  }
  const auto names = files("fault-");
  ASSERT_EQ(names.size(), 6u) << "a log and a text each";
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_THAT(names[2 * i], ::testing::MatchesRegex("fault-[0-9]{8}T[0-9]{6}\\.[0-9]{3}Z-" + in_order[i] + "\\.lcm"));
  }
  EXPECT_EQ(read(names[4]).faults.size(), 3u) << "earlier ones of the half minute are told too";
}

TEST_F(FlightRecorderTest, ASecondFaultWithinTheFirstOnesSecondIsNotLost) {
  const auto recorder = this->recorder(without_log());
  run(50, *recorder);
  source_.fault(faults::FaultCode::kTilt);
  run(20, *recorder);
  source_.reset();
  run(5, *recorder);
  source_.fault(faults::FaultCode::kBusLost);
  run(150, *recorder);
  EXPECT_EQ(files("fault-").size(), 4u);
}

TEST_F(FlightRecorderTest, AFullDiskDelaysItAndTheHalfMinuteIsKeptMeanwhile) {
  const auto recorder = this->recorder(without_log());
  run(3500, *recorder);
  source_.fault(faults::FaultCode::kTilt);
  {
    const test::FullDisk full;
    run(6000, *recorder);  // long enough for the ring to have lost all of it
    EXPECT_EQ(recorder->flight().waiting(), 1);
    EXPECT_EQ(said_.size(), 1u) << "told once";
  }
  run(150, *recorder);
  EXPECT_EQ(recorder->flight().waiting(), 0);
  EXPECT_EQ(read(only_flight()).ticks, range(500, 3601));
  EXPECT_TRUE(files("fault-").size() == 2u) << "nothing half written is left";
}

TEST_F(FlightRecorderTest, WhatTheRunsEndInterruptsIsWrittenAtTheEnd) {
  const auto recorder = this->recorder(without_log());
  run(50, *recorder);
  source_.fault(faults::FaultCode::kTilt);
  run(3, *recorder);
  recorder->close();
  EXPECT_EQ(read(only_flight()).ticks, range(0, 53));
}

TEST_F(FlightRecorderTest, FilesAreBounded) {
  RecorderOptions few = without_log();
  few.flight.files = 2;
  few.flight.before_s = 0.5;
  few.flight.after_s = 0.1;
  const auto recorder = this->recorder(few);
  for (int k = 0; k < 5; ++k) {
    source_.fault(k < 3 ? faults::FaultCode::kTilt : faults::FaultCode::kBusLost);
    run(20, *recorder);
    source_.reset();
    run(5, *recorder);
  }
  const auto names = files("fault-");
  EXPECT_EQ(names.size(), 4u);
  for (const std::string& name : names) EXPECT_THAT(name, HasSubstr("bus_lost")) << "the newest";
}

}  // namespace
}  // namespace pmg::recording
