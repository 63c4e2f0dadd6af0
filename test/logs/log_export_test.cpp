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

#include "folders.hpp"
#include "log_surgery.hpp"
#include "logs/mcap_writer.hpp"
#include "pmg_msgs/ground_truth_t.hpp"
#include "pmg_msgs/robot_info_t.hpp"
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

  void SetUp() override {
    static const bool is_there = std::system("/usr/bin/python3 -c 'import zstandard' 2>/dev/null") == 0;
    if (!is_there) GTEST_SKIP() << "python3-zstandard is missing (scripts/setup --checks)";
  }

  /// Contents by the MCAP project's own reader. Foxglove's published classes read them too, where they are there.
  nlohmann::json read_mcap(const fs::path& file) const {
    const fs::path out = folder_ / "read.json";
    const std::string root = pmg::test::project_folder();
    const std::string command = "PYTHONPATH=" + root + "/third_party/prefix/python:$(" + root +
                                "/third_party/python-packages foxglove --cached 2>/dev/null) /usr/bin/python3 " + root +
                                "/test/logs/read_mcap.py " + file.string() + " >" + out.string();
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
  EXPECT_EQ(read["topics"].size(), report.messages.size() + 4) << "and Foxglove's own four";
  EXPECT_EQ(read["compressions"], nlohmann::json({"zstd"}));
  for (const auto& [channel, count] : report.messages) EXPECT_EQ(read["topics"][channel]["count"], count) << channel;
  const auto joints = model::load_robot(test::kRecordedRobot).joint_index.names();
  const auto& state = read["topics"]["STATE"];
  for (const test::LogEvent& event : test::read_events(log_)) {
    if (event.channel != "STATE") continue;
    const double q_rad = event.as<pmg_msgs::robot_state_t>().q_rad[3];
    EXPECT_EQ(state["first"]["q_rad"][joints[3]].get<float>(), static_cast<float>(q_rad)) << "a 32-bit float's digits";
    break;
  }
  // The session is the start time of the run: 1 ns after 1970.
  EXPECT_EQ(state["first_ns"], 10'000'000 + test::kRecordedSession);
  EXPECT_EQ(state["last_ns"], 2'600'000'000 + test::kRecordedSession);
  EXPECT_EQ(read["start_ns"], test::kRecordedSession);
  EXPECT_EQ(read["topics"]["REFERENCE"]["first"]["contact"]["left"], true);
}

TEST_F(LogExport, ConstantsHaveTheirNames) {
  export_mcap({log_}, folder_ / "log.mcap");
  const nlohmann::json read = read_mcap(folder_ / "log.mcap");
  EXPECT_EQ(read["topics"]["STATUS"]["first"]["mode_name"], "PASSIVE");
  EXPECT_EQ(read["topics"]["STATUS"]["last"]["mode_name"], "DAMPING");
  EXPECT_EQ(read["topics"]["REFERENCE"]["last"]["gco_status_name"], "CONVERGED");
  export_csv({log_}, folder_ / "csv");
  EXPECT_THAT(lines_of(folder_ / "csv/STATUS.csv").front(), HasSubstr(",mode,mode_name,fault_code,"));
  EXPECT_THAT(lines_of(folder_ / "csv/STATUS.csv").back(), HasSubstr(",1,DAMPING,"));
}

/// The frame of a link in the world, by walking up /tf.
Eigen::Isometry3d in_world(const nlohmann::json& message, const std::string& link) {
  if (link == "world") return Eigen::Isometry3d::Identity();
  for (const auto& one : message["transforms"]) {
    if (one["child_frame_id"] != link) continue;
    const auto &p = one["translation"], &q = one["rotation"];
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation() = Eigen::Vector3d(p["x"], p["y"], p["z"]);
    T.linear() = Eigen::Quaterniond(q["w"], q["x"], q["y"], q["z"]).toRotationMatrix();
    return in_world(message, one["parent_frame_id"]) * T;
  }
  ADD_FAILURE() << link << " has no frame";
  return Eigen::Isometry3d::Identity();
}

TEST_F(LogExport, FoxgloveGetsEveryLinkTheJointsTheLogAndTheUrdf) {
  export_mcap({log_}, folder_ / "log.mcap");
  const nlohmann::json topics = read_mcap(folder_ / "log.mcap")["topics"];
  const model::RobotModel robot = model::load_robot(test::kRecordedRobot);

  EXPECT_EQ(topics["/tf"]["schema"], "foxglove.FrameTransforms");
  EXPECT_EQ(topics["/tf"]["count"], 130) << "every second tick of 260";
  const auto& frames = topics["/tf"]["last"];
  EXPECT_EQ(frames["transforms"].size(), robot.urdf->links_.size());
  EXPECT_EQ(frames["transforms"][0]["parent_frame_id"], "world");
  EXPECT_EQ(frames["transforms"][0]["child_frame_id"], robot.base_link);
  double lowest_m = 1.0;
  for (const model::FootModel& foot : robot.feet) {
    for (const Eigen::Vector3d& corner_F : foot.sole_corners_F())
      lowest_m = std::min(lowest_m, (in_world(frames, foot.link) * corner_F).z());
  }
  EXPECT_NEAR(lowest_m, 0.0, 1e-5) << "the robot stands on the ground; numbers have seven digits";

  EXPECT_EQ(topics["/joint_states"]["schema"], "foxglove.JointStates");
  EXPECT_EQ(topics["/joint_states"]["count"], 260);
  const auto& joint = topics["/joint_states"]["first"]["joints"][3];
  EXPECT_EQ(joint["name"], robot.joint_index.name(3));
  EXPECT_EQ(joint["position"], topics["STATE"]["first"]["q_rad"][robot.joint_index.name(3)]);

  EXPECT_EQ(topics["/log"]["schema"], "foxglove.Log");
  EXPECT_EQ(topics["/log"]["first"]["message"], "mode: passive");
  EXPECT_EQ(topics["/robot_description"]["schema"], "std_msgs/String");
  EXPECT_EQ(topics["/robot_description"]["count"], 1);
  EXPECT_THAT(topics["/robot_description"]["first"]["data"].get<std::string>(), HasSubstr("<robot name=\"biped\""));
}

TEST_F(LogExport, FoxglovesSchemasAreThoseOfItsPackage) {
  export_mcap({log_}, folder_ / "log.mcap");
  const nlohmann::json read = read_mcap(folder_ / "log.mcap");
  if (read["published"].empty()) GTEST_SKIP() << "third_party/python-packages foxglove is missing";
  EXPECT_EQ(read["published"], nlohmann::json({"foxglove.FrameTransforms", "foxglove.JointStates", "foxglove.Log"}));
}

TEST_F(LogExport, ABaseThatTheSimulationKnowsIsTaken) {
  const fs::path simulated = folder_ / "simulated.lcm";
  {
    io::LogWriter log(simulated);
    for (const test::LogEvent& event : test::read_events(log_)) {
      if (event.channel != "ROBOT_INFO" && event.channel != "STATE") continue;
      if (event.channel == "ROBOT_INFO") {
        log.write("ROBOT_INFO", event.stamp_ns, event.as<pmg_msgs::robot_info_t>());
      } else {
        log.write("STATE", event.stamp_ns, event.as<pmg_msgs::robot_state_t>());
        pmg_msgs::ground_truth_t truth{};
        truth.p_WB_m[0] = 1.5;
        truth.p_WB_m[2] = 0.75;
        truth.q_WB[0] = truth.q_WT[0] = 1.0;
        log.write("GROUND_TRUTH", event.stamp_ns, truth);
      }
    }
    log.flush();
  }
  export_mcap({simulated}, folder_ / "simulated.mcap");
  const auto base = read_mcap(folder_ / "simulated.mcap")["topics"]["/tf"]["last"]["transforms"][0]["translation"];
  EXPECT_EQ(base["x"], 1.5);
  EXPECT_EQ(base["z"], 0.75);
}

TEST_F(LogExport, WithoutItsRobotALogHasNoFramesAndTheReportSaysSo) {
  const fs::path lost = folder_ / "lost.lcm";
  test::copy_log(log_, lost, [](test::LogEvent& event) {
    if (event.channel != "ROBOT_INFO") return true;
    auto info = event.as<pmg_msgs::robot_info_t>();
    info.options = "{}";
    info.model = "nobody";
    event.set(info);
    return true;
  });
  const ExportReport report = export_mcap({lost}, folder_ / "lost.mcap");
  EXPECT_THAT(report.notes, ::testing::ElementsAre(HasSubstr("robot 'nobody' is neither known nor a folder")));
  EXPECT_FALSE(read_mcap(folder_ / "lost.mcap")["topics"].contains("/tf"));
  EXPECT_TRUE(export_mcap({lost}, folder_ / "named.mcap", test::kRecordedRobot).notes.empty());
  EXPECT_TRUE(read_mcap(folder_ / "named.mcap")["topics"].contains("/tf"));
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
    McapWriter writer(folder_ / name);
    const auto schema =
        writer.add_schema("s", "jsonschema", R"({"type": "object", "properties": {"x": {"type": "string"}}})");
    const auto channel = writer.add_channel(schema, "T", "json");
    const std::string text = R"({"x": ")" + std::string(3000, 'a') + R"("})";
    for (int k = 0; k < messages; ++k) writer.write(channel, 1000 + k, text);
    writer.close();
  };
  write("many.mcap", 4000);
  const nlohmann::json many = read_mcap(folder_ / "many.mcap");
  EXPECT_EQ(many["topics"]["T"]["count"], 4000);
  EXPECT_EQ(many["chunks"], 3) << "four megabytes each";
  EXPECT_EQ(many["end_ns"], 4999);
  McapWriter(folder_ / "none.mcap").close();
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
  const ExportReport report = export_mcap({log_}, folder_ / "part.mcap", "", {.interrupted = [] { return true; }});
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
