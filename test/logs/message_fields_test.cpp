// Every field of every message type in msgs/ is exported under its own name.
#include "topics/message_fields.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <map>
#include <set>
#include <sstream>

#include "folders.hpp"
#include "log_surgery.hpp"
#include "pmg_msgs/ack_t.hpp"
#include "pmg_msgs/arms_input_t.hpp"
#include "pmg_msgs/arms_state_t.hpp"
#include "pmg_msgs/arms_t.hpp"
#include "pmg_msgs/claim_t.hpp"
#include "pmg_msgs/hoist_state_t.hpp"
#include "pmg_msgs/hoist_t.hpp"
#include "pmg_msgs/limited_t.hpp"
#include "pmg_msgs/link_t.hpp"
#include "pmg_msgs/reference_t.hpp"
#include "pmg_msgs/robot_info_t.hpp"
#include "pmg_msgs/robot_state_t.hpp"
#include "pmg_msgs/scenario_step_t.hpp"
#include "pmg_msgs/timing_t.hpp"
#include "recorded_run.hpp"
#include "temporary_folder.hpp"

namespace pmg::topics {
namespace {

namespace fs = std::filesystem;

const std::map<std::string_view, std::string> kTypes = {{"ROBOT_INFO", "robot_info_t"},
                                                        {"SCENARIO", "scenario_step_t"},
                                                        {"STATE", "robot_state_t"},
                                                        {"COMMAND", "command_t"},
                                                        {"MODE", "mode_t"},
                                                        {"ARMS", "arms_t"},
                                                        {"ARMS_INPUT", "arms_input_t"},
                                                        {"ARMS_STATE", "arms_state_t"},
                                                        {"TICK", "tick_input_t"},
                                                        {"REFERENCE", "reference_t"},
                                                        {"STATUS", "status_t"},
                                                        {"MOTOR_COMMAND", "motor_command_t"},
                                                        {"LIMITED", "limited_t"},
                                                        {"FAULT", "fault_t"},
                                                        {"TIMING", "timing_t"},
                                                        {"GROUND_TRUTH", "ground_truth_t"},
                                                        {"ACK", "ack_t"},
                                                        {"LINK", "link_t"},
                                                        {"HOIST", "hoist_t"},
                                                        {"HOIST_STATE", "hoist_state_t"},
                                                        {"CLAIM", "claim_t"}};
// Behind other messages, and pictures: on the network only.
const std::set<std::string> kNotLogged = {"seal_t", "proof_t", "camera_t"};

/// Names of a type's fields, except lengths of others. Read word by word, because GCC 12 gives false warnings on
/// std::regex under sanitizers.
std::vector<std::string> fields_of(const std::string& type) {
  const std::set<std::string> types = {"int8_t", "int16_t", "int32_t", "int64_t", "byte",
                                       "double", "float",   "boolean", "string"};
  std::ifstream file(fs::path(pmg::test::project_folder()) / "msgs" / (type + ".lcm"));
  std::vector<std::string> names;
  std::set<std::string> lengths;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string word, name;
    if (!(words >> word >> name) || !types.contains(word)) continue;  // a comment, a constant, a brace
    name.erase(name.find(';'));
    const std::size_t bracket = name.find('[');
    names.push_back(name.substr(0, bracket));
    if (bracket != std::string::npos) lengths.insert(name.substr(bracket + 1, name.find(']') - bracket - 1));
  }
  std::erase_if(names, [&](const std::string& name) { return lengths.contains(name); });
  return names;
}

/// A message of this type with all numbers zero and all vectors of two entries.
template <typename Message>
std::vector<std::uint8_t> bytes_of(const Message& message) {
  test::LogEvent event;
  event.set(message);
  return event.data;
}

class MessageFields : public testing::Test {
 protected:
  MessageFields() {
    const test::TemporaryFolder folder;
    const fs::path file = folder.file("run.lcm");
    test::record_run(file);
    for (const test::LogEvent& event : test::read_events(file)) examples_.emplace(event.channel, event.data);
    // Messages that the run doesn't contain.
    examples_.emplace("SCENARIO", bytes_of(pmg_msgs::scenario_step_t{}));
    examples_.emplace("ARMS", bytes_of(pmg_msgs::arms_t{}));
    examples_.emplace("ARMS_INPUT", bytes_of(pmg_msgs::arms_input_t{}));
    examples_.emplace("ARMS_STATE", bytes_of(pmg_msgs::arms_state_t{}));
    examples_.emplace("LIMITED", bytes_of(pmg_msgs::limited_t{}));
    examples_.emplace("TIMING", bytes_of(pmg_msgs::timing_t{}));
    examples_.emplace("GROUND_TRUTH", bytes_of(pmg_msgs::ground_truth_t{}));
    examples_.emplace("ACK", bytes_of(pmg_msgs::ack_t{}));
    examples_.emplace("LINK", bytes_of(pmg_msgs::link_t{}));
    examples_.emplace("HOIST", bytes_of(pmg_msgs::hoist_t{}));
    examples_.emplace("HOIST_STATE", bytes_of(pmg_msgs::hoist_state_t{}));
    examples_.emplace("CLAIM", bytes_of(pmg_msgs::claim_t{}));
  }
  std::map<std::string, std::vector<std::uint8_t>> examples_;
  const std::vector<std::string> joints_ = model::load_robot(test::kRecordedRobot).joint_index.names();
};

TEST_F(MessageFields, NamesAreThoseOfTheMessageFilesInTheirOrder) {
  ASSERT_EQ(known_channels().size(), kTypes.size());
  std::size_t types = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(fs::path(pmg::test::project_folder()) / "msgs")) {
    types += entry.path().extension() == ".lcm" ? 1 : 0;
  }
  EXPECT_EQ(types, kTypes.size() + kNotLogged.size()) << "a message type that no log tool knows";
  for (const std::string_view channel : known_channels()) {
    std::vector<Field> fields;
    ASSERT_TRUE(read_fields(channel, examples_.at(std::string(channel)), joints_, fields)) << channel;
    std::vector<std::string> names;
    for (const Field& field : fields) {
      if (names.empty() || names.back() != field.name) names.push_back(field.name);
    }
    EXPECT_EQ(names, fields_of(kTypes.at(channel))) << channel;
  }
}

TEST_F(MessageFields, VectorsAreLabelledByJointFootAxisAndChannel) {
  std::vector<Field> fields;
  ASSERT_TRUE(read_fields("STATE", examples_.at("STATE"), joints_, fields));
  std::set<std::string> paths;
  for (const Field& field : fields) paths.insert(field.path());
  for (const std::string& joint : joints_) EXPECT_TRUE(paths.contains("q_rad." + joint)) << joint;
  EXPECT_TRUE(paths.contains("gyro_rad_s.z"));
  EXPECT_TRUE(paths.contains("orientation_WI.w"));
  ASSERT_TRUE(read_fields("REFERENCE", examples_.at("REFERENCE"), joints_, fields));
  paths.clear();
  for (const Field& field : fields) paths.insert(field.path());
  EXPECT_TRUE(paths.contains("contact.left"));
  EXPECT_TRUE(paths.contains("optimised.height_m"));
}

TEST_F(MessageFields, ValuesAreTheMessages) {
  std::vector<Field> fields;
  auto state = test::LogEvent{"STATE", 0, examples_.at("STATE")}.as<pmg_msgs::robot_state_t>();
  ASSERT_TRUE(read_fields("STATE", examples_.at("STATE"), joints_, fields));
  for (const Field& field : fields) {
    if (field.path() == "q_rad." + joints_[4]) {
      EXPECT_EQ(std::get<double>(field.value), state.q_rad[4]);
    }
    if (field.name == "bus_sample") {
      EXPECT_EQ(std::get<std::int64_t>(field.value), state.bus_sample);
    }
  }
  EXPECT_EQ(to_text(Field::Value(0.1)), "0.1");
  EXPECT_EQ(to_text(Field::Value(1.0 / 3.0)), "0.3333333333333333") << "reads back exactly";
  EXPECT_EQ(to_text(Field::Value(true)), "1");
  EXPECT_EQ(to_text(Field::Value(std::vector<std::string>{"a", "b"})), "a;b");
}

TEST_F(MessageFields, StrangeChannelsAndBytesAreNoMessage) {
  std::vector<Field> fields;
  EXPECT_FALSE(read_fields("CHATTER", examples_.at("STATE"), joints_, fields));
  EXPECT_FALSE(read_fields("REFERENCE", examples_.at("STATE"), joints_, fields)) << "another type's bytes";
  EXPECT_FALSE(read_fields("STATE", std::vector<std::uint8_t>{1, 2, 3}, joints_, fields));
  std::vector<std::uint8_t> damaged = examples_.at("STATE");
  // joint_count becomes negative; before it are hash, robot's name (with length and closing zero), stamp and sample
  const auto state = test::LogEvent{"STATE", 0, damaged}.as<pmg_msgs::robot_state_t>();
  damaged[8 + 4 + state.robot.size() + 1 + 8 + 8] = 0xff;
  EXPECT_FALSE(read_fields("STATE", damaged, joints_, fields));
}

}  // namespace
}  // namespace pmg::topics
