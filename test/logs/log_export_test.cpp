// Exports of a log contain its data, as other programs read them.
#include "logs/log_export.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "io/mcap_writer.hpp"
#include "log_surgery.hpp"
#include "pmg_msgs/robot_state_t.hpp"
#include "recorded_run.hpp"

namespace pmg::logs {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::vector<std::string> lines_of(const fs::path& file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return cells;
}

class LogExport : public testing::Test {
 protected:
  LogExport() {
    fs::create_directories(folder_);
    test::record_run(log_);
  }
  ~LogExport() override { fs::remove_all(folder_); }

  /// Contents by the MCAP project's own reader.
  nlohmann::json read_mcap(const fs::path& file) const {
    const fs::path out = folder_ / "read.json";
    const std::string command = std::string("PYTHONPATH=") + PMG_SOURCE_DIR + "/third_party/prefix/python python3 " +
                                PMG_SOURCE_DIR + "/test/logs/read_mcap.py " + file.string() + " >" + out.string();
    const int status = std::system(command.c_str());
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    std::ifstream in(out);
    return nlohmann::json::parse(in, nullptr, false);
  }

  fs::path folder_ = fs::temp_directory_path() / ("pmg_export_test_" + std::to_string(getpid()));
  fs::path log_ = folder_ / "log.lcm";
};

TEST_F(LogExport, CsvHasARowAMessageAndColumnsByJointName) {
  const ExportReport report = export_csv({log_}, folder_ / "csv");
  EXPECT_EQ(report.unknown, 0);
  EXPECT_EQ(report.messages.at("STATE"), 260);
  const std::vector<test::LogEvent> events = test::read_events(log_);
  const auto joints = model::load_robot(test::kRecordedRobot).joint_index.names();
  for (const auto& [channel, count] : report.messages) {
    const auto lines = lines_of(folder_ / "csv" / (channel + ".csv"));
    EXPECT_EQ(std::ssize(lines), count + 1) << channel;
    EXPECT_EQ(count, std::ranges::count(events, channel, &test::LogEvent::channel));
    EXPECT_THAT(lines.front(), ::testing::StartsWith("time_s,"));
  }
  const auto lines = lines_of(folder_ / "csv/STATE.csv");
  const auto columns = cells_of(lines.front());
  std::int64_t row = 0;
  for (const test::LogEvent& event : events) {
    if (event.channel != "STATE") continue;
    const auto state = event.as<pmg_msgs::robot_state_t>();
    const auto cells = cells_of(lines[static_cast<std::size_t>(++row)]);
    ASSERT_EQ(cells.size(), columns.size());
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (columns[i] == "q_rad." + joints[3]) {
        EXPECT_EQ(std::strtod(cells[i].c_str(), nullptr), state.q_rad[3]) << "bit by bit";
      }
      if (columns[i] == "time_s") {
        EXPECT_NEAR(std::strtod(cells[i].c_str(), nullptr), 0.01 * static_cast<double>(row), 1e-5);
      }
    }
  }
}

TEST_F(LogExport, TextWithCommasAndQuotesStaysOneCell) {
  export_csv({log_}, folder_ / "csv");
  const std::string info = lines_of(folder_ / "csv/ROBOT_INFO.csv").at(1);
  EXPECT_THAT(info, HasSubstr(R"("{""robot"":""test/data/robots/biped"",)"));
}

TEST_F(LogExport, McapIsWhatItsOwnReaderReads) {
  const ExportReport report = export_mcap({log_}, folder_ / "log.mcap");
  const nlohmann::json read = read_mcap(folder_ / "log.mcap");
  ASSERT_TRUE(read.is_object());
  EXPECT_EQ(read["topics"].size(), report.messages.size());
  for (const auto& [channel, count] : report.messages) EXPECT_EQ(read["topics"][channel]["count"], count) << channel;
  const auto joints = model::load_robot(test::kRecordedRobot).joint_index.names();
  const auto& state = read["topics"]["STATE"];
  for (const test::LogEvent& event : test::read_events(log_)) {
    if (event.channel != "STATE") continue;
    EXPECT_EQ(state["first"]["q_rad"][joints[3]].get<double>(), event.as<pmg_msgs::robot_state_t>().q_rad[3]);
    break;
  }
  // The session is the start time of the run: 1 ns after 1970.
  EXPECT_EQ(state["first_ns"], 10'000'000 + test::kRecordedSession);
  EXPECT_EQ(state["last_ns"], 2'600'000'000 + test::kRecordedSession);
  EXPECT_EQ(read["start_ns"], test::kRecordedSession);
  EXPECT_EQ(read["topics"]["REFERENCE"]["first"]["contact"]["left"], true);
}

TEST_F(LogExport, NumbersThatAreNoneAreNullInJson) {
  const fs::path broken = folder_ / "broken.lcm";
  test::copy_log(log_, broken, [](test::LogEvent& event) {
    if (event.channel != "STATE") return true;
    auto state = event.as<pmg_msgs::robot_state_t>();
    state.torque_Nm[0] = std::numeric_limits<double>::quiet_NaN();
    state.torque_Nm[1] = std::numeric_limits<double>::infinity();
    event.set(state);
    return true;
  });
  export_mcap({broken}, folder_ / "broken.mcap");
  const auto joints = model::load_robot(test::kRecordedRobot).joint_index.names();
  const auto torque = read_mcap(folder_ / "broken.mcap")["topics"]["STATE"]["first"]["torque_Nm"];
  EXPECT_TRUE(torque[joints[0]].is_null());
  EXPECT_TRUE(torque[joints[1]].is_null());
  EXPECT_TRUE(torque[joints[2]].is_number());
}

TEST_F(LogExport, McapOfManyChunksAndNoneReadsBack) {
  const auto write = [&](const char* name, int messages) {
    io::McapWriter writer(folder_ / name);
    const auto schema =
        writer.add_schema("s", "jsonschema", R"({"type": "object", "properties": {"x": {"type": "string"}}})");
    const auto channel = writer.add_channel(schema, "T", "json");
    const std::string text = R"({"x": ")" + std::string(3000, 'a') + R"("})";
    for (int k = 0; k < messages; ++k) writer.write(channel, 1000 + k, text);
    writer.close();
  };
  write("many.mcap", 1000);
  const nlohmann::json many = read_mcap(folder_ / "many.mcap");
  EXPECT_EQ(many["topics"]["T"]["count"], 1000);
  EXPECT_EQ(many["chunks"], 3) << "a megabyte each";
  EXPECT_EQ(many["end_ns"], 1999);
  io::McapWriter(folder_ / "none.mcap").close();
  EXPECT_TRUE(read_mcap(folder_ / "none.mcap")["topics"].empty());
}

TEST_F(LogExport, UnknownChannelsAreLeftOutAndCounted) {
  const fs::path mixed = folder_ / "mixed.lcm";
  test::copy_log(log_, mixed, [](test::LogEvent& event) {
    if (event.channel == "STATUS") event.channel = "CAMERA";
    return true;
  });
  const ExportReport report = export_csv({mixed}, folder_ / "csv");
  EXPECT_EQ(report.unknown, 260);
  EXPECT_FALSE(fs::exists(folder_ / "csv/CAMERA.csv"));
}

TEST_F(LogExport, InterruptedItKeepsWhatWasDone) {
  const ExportReport report = export_mcap({log_}, folder_ / "part.mcap", {.interrupted = [] { return true; }});
  const std::int64_t kept = report.messages.at("STATE");
  EXPECT_GT(kept, 0);
  EXPECT_LT(kept, 260);
  EXPECT_EQ(read_mcap(folder_ / "part.mcap")["topics"]["STATE"]["count"], kept) << "a whole file";
}

TEST_F(LogExport, WhatCannotBeWrittenOrReadIsTold) {
  EXPECT_THROW(export_mcap({log_}, folder_ / "absent" / "log.mcap"), std::runtime_error);
  EXPECT_THROW(export_mcap({log_}, "/dev/full"), std::runtime_error);
  EXPECT_THROW(export_csv({"/dev/null"}, folder_ / "csv"), std::runtime_error);
}

}  // namespace
}  // namespace pmg::logs
