#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "io/log_reader.hpp"
#include "io/log_writer.hpp"
#include "pmg_msgs/fault_t.hpp"
#include "pmg_msgs/motor_command_t.hpp"

namespace pmg {
namespace {

class Log : public testing::Test {
 protected:
  Log() : folder_(std::filesystem::temp_directory_path() / ("pmg_log_test_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~Log() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
};

pmg_msgs::motor_command_t motor_command(int joints) {
  pmg_msgs::motor_command_t message;
  message.stamp_ns = 5;
  message.bus_sample = 9;
  message.joint_count = joints;
  for (auto* values :
       {&message.q_rad, &message.dq_rad_s, &message.kp_Nm_per_rad, &message.kd_Nm_s_per_rad, &message.torque_ff_Nm}) {
    for (int i = 0; i < joints; ++i) values->push_back(0.1 * i + 1.0 / 3.0);
  }
  return message;
}

TEST_F(Log, ReaderGivesBackWhatWasWritten) {
  const auto path = folder_ / "log.lcm";
  // More joints than any robot: the message outgrows the writer's first buffer.
  const pmg_msgs::motor_command_t written = motor_command(400);
  pmg_msgs::fault_t fault;
  fault.stamp_ns = 12;
  fault.code = 3;
  fault.text = "joint_limit: left_knee";
  {
    io::LogWriter writer(path);
    writer.write("MOTOR_COMMAND", 10'000'000, written);
    writer.write("FAULT", 20'000'000, fault);
  }
  io::LogReader reader(path);
  ASSERT_TRUE(reader.next());
  EXPECT_EQ(reader.channel(), "MOTOR_COMMAND");
  EXPECT_EQ(reader.stamp_ns(), 10'000'000);
  EXPECT_FALSE(reader.decode<pmg_msgs::fault_t>().has_value()) << "another type's bytes";
  const auto read = reader.decode<pmg_msgs::motor_command_t>();
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->q_rad, written.q_rad) << "doubles survive bit by bit";
  EXPECT_EQ(read->torque_ff_Nm, written.torque_ff_Nm);
  EXPECT_EQ(read->bus_sample, written.bus_sample);
  ASSERT_TRUE(reader.next());
  EXPECT_EQ(reader.decode<pmg_msgs::fault_t>()->text, fault.text);
  EXPECT_FALSE(reader.next());
}

TEST_F(Log, HoldsNothingOfTheTimeOfWriting) {
  const auto write = [&](const char* name) {
    io::LogWriter writer(folder_ / name);
    for (int k = 0; k < 100; ++k) writer.write("MOTOR_COMMAND", k * 10'000'000LL, motor_command(31));
  };
  const auto bytes = [&](const char* name) {
    std::ifstream file(folder_ / name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  write("a.lcm");
  write("b.lcm");
  EXPECT_GT(bytes("a.lcm").size(), 100'000u);
  EXPECT_EQ(bytes("a.lcm"), bytes("b.lcm"));
}

TEST_F(Log, SaysWhichFileCannotBeMadeOrOpened) {
  try {
    io::LogWriter writer(folder_ / "absent" / "log.lcm");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("absent/log.lcm"), std::string::npos) << error.what();
  }
  EXPECT_THROW(io::LogReader(folder_ / "absent.lcm"), std::runtime_error);
}

}  // namespace
}  // namespace pmg
