#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <lcm/lcm-cpp.hpp>

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

TEST_F(Log, APipeOrADeviceIsRefusedAtOnce) {
  const auto refusal = [](const std::filesystem::path& path) -> std::string {
    try {
      io::LogReader reader(path);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "accepted";
  };
  const std::filesystem::path pipe = folder_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(refusal(pipe), pipe.string() + ": is a pipe; expected a log");
  EXPECT_EQ(refusal("/dev/zero"), "/dev/zero: is a device; expected a log");
  EXPECT_EQ(refusal(folder_), folder_.string() + ": is a folder; expected a log");
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

TEST_F(Log, IsWhatLcmItselfReads) {
  const pmg_msgs::motor_command_t written = motor_command(31);
  {
    io::LogWriter writer(folder_ / "log.lcm");
    for (int k = 0; k < 3; ++k) writer.write("MOTOR_COMMAND", 10'000'000LL * k, written);
  }
  lcm::LogFile file((folder_ / "log.lcm").string(), "r");
  ASSERT_TRUE(file.good());
  for (int k = 0; k < 3; ++k) {
    const lcm::LogEvent* event = file.readNextEvent();
    ASSERT_NE(event, nullptr);
    EXPECT_EQ(event->eventnum, k);
    EXPECT_EQ(event->timestamp, 10'000LL * k) << "microseconds";
    EXPECT_EQ(event->channel, "MOTOR_COMMAND");
    pmg_msgs::motor_command_t read;
    ASSERT_GT(read.decode(event->data, 0, event->datalen), 0);
    EXPECT_EQ(read.q_rad, written.q_rad);
  }
  EXPECT_EQ(file.readNextEvent(), nullptr);
}

/// Writes a log of this many events and returns the size of one event.
std::int64_t write_log(const std::filesystem::path& path, int events) {
  io::LogWriter writer(path);
  for (int k = 0; k < events; ++k) writer.write("MOTOR_COMMAND", 10'000'000LL * k, motor_command(31));
  return writer.bytes() / events;
}

TEST_F(Log, CutAnywhereItReadsUpToTheLastWholeEvent) {
  const auto path = folder_ / "log.lcm";
  const std::int64_t size = write_log(path, 3);
  for (const std::int64_t left : {std::int64_t{0}, std::int64_t{1}, std::int64_t{27}, std::int64_t{30}, size - 1}) {
    std::filesystem::resize_file(path, static_cast<std::uintmax_t>(2 * size + left));
    io::LogReader reader(path);
    int events = 0;
    while (reader.next()) ++events;
    EXPECT_EQ(events, 2) << left;
    EXPECT_EQ(reader.cut_short(), left > 0) << left;
    EXPECT_EQ(reader.skipped_bytes(), left);
    write_log(path, 3);
  }
}

TEST_F(Log, DamageCostsTheEventThatItHitsAndIsCounted) {
  const auto path = folder_ / "log.lcm";
  const std::int64_t size = write_log(path, 4);
  const auto spoil = [&](std::int64_t at, std::initializer_list<unsigned char> bytes) {
    std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
    file.seekp(at);
    for (const unsigned char byte : bytes) file.put(static_cast<char>(byte));
  };
  struct Case {
    const char* what = nullptr;
    std::int64_t at = 0;
    std::initializer_list<unsigned char> bytes;
  };
  for (const Case& damage : {Case{"sync word", size, {0}}, Case{"a length beyond reason", size + 24, {0xff}},
                             Case{"a length beyond the file", size + 25, {0x10}}, Case{"no channel", size + 23, {0}}}) {
    write_log(path, 4);
    spoil(damage.at, damage.bytes);
    io::LogReader reader(path);
    std::vector<std::int64_t> stamps_ns;
    while (reader.next()) stamps_ns.push_back(reader.stamp_ns());
    EXPECT_EQ(stamps_ns, (std::vector<std::int64_t>{0, 20'000'000, 30'000'000})) << damage.what;
    EXPECT_EQ(reader.skipped_bytes(), size) << damage.what;
    EXPECT_FALSE(reader.cut_short()) << damage.what;
  }
}

TEST_F(Log, WhatIsFlushedIsInTheFileAtOnce) {
  io::LogWriter writer(folder_ / "log.lcm");
  writer.write("MOTOR_COMMAND", 0, motor_command(31));
  EXPECT_EQ(std::filesystem::file_size(folder_ / "log.lcm"), 0u) << "gathered";
  writer.flush();
  EXPECT_EQ(std::filesystem::file_size(folder_ / "log.lcm"), static_cast<std::uintmax_t>(writer.bytes()));
}

TEST_F(Log, AFullDiskIsToldAndCutsNoEventInTwo) {
  // The kernel refuses to let a file of this process grow beyond the limit: EFBIG replaces ENOSPC.
  const auto path = folder_ / "log.lcm";
  const std::int64_t size = write_log(path, 1);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  rlimit small = before;
  small.rlim_cur = static_cast<rlim_t>(5 * size / 2);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  {
    io::LogWriter writer(path);
    writer.write("MOTOR_COMMAND", 0, motor_command(31));
    writer.flush();
    for (int k = 1; k < 4; ++k) writer.write("MOTOR_COMMAND", 10'000'000LL * k, motor_command(31));
    EXPECT_THROW(writer.flush(), std::runtime_error);
    EXPECT_EQ(writer.bytes(), size) << "what could not be written is forgotten";
    writer.write("MOTOR_COMMAND", 40'000'000, motor_command(31));  // there is room for one more
  }
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old_handler);
  io::LogReader reader(path);
  std::vector<std::int64_t> stamps_ns;
  while (reader.next()) stamps_ns.push_back(reader.stamp_ns());
  EXPECT_EQ(stamps_ns, (std::vector<std::int64_t>{0, 40'000'000}));
  EXPECT_EQ(reader.skipped_bytes(), 0);
}

TEST_F(Log, ADeviceThatTakesNothingIsToldToo) {
  io::LogWriter writer("/dev/full");
  writer.write("MOTOR_COMMAND", 0, motor_command(31));
  EXPECT_THROW(writer.flush(), std::runtime_error);
}

TEST_F(Log, SaysWhichFileCannotBeMadeOrOpened) {
  try {
    io::LogWriter writer(folder_ / "absent" / "log.lcm");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("absent/log.lcm"), std::string::npos) << error.what();
  }
  EXPECT_THROW(io::LogReader(folder_ / "absent.lcm"), std::runtime_error);
  EXPECT_THROW(io::LogReader{folder_}, std::runtime_error);
}

}  // namespace
}  // namespace pmg
