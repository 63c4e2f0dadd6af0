#include "can/candump.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "../sim/robots.hpp"
#include "can/can_hal.hpp"
#include "can/canopen_setup.hpp"
#include "can/cia402_emulator.hpp"
#include "can/memory_link.hpp"
#include "can/mixed_drives.hpp"
#include "drive_protocols/canopen_drive.hpp"
#include "drive_protocols/mit_drive.hpp"

namespace pmg::can {
namespace {

TEST(Candump, LinesAreThoseOfCandump) {
  for (const char* line : {"(1436509052.249713) can0 044#2A366C2B", "(1436509052.000001) can11 7FF#",
                           "(1.500000) vcan0 1F334455#1122334455667788", "(1436509053.850870) can0 123##1AABBCC",
                           "(1436509052.249713) can0 044#R", "(1436509052.249713) can0 1F334455#R8",
                           "(1436509052.249713) can0 20000004#0004000000000000"}) {
    const auto recorded = from_line(line);
    ASSERT_TRUE(recorded) << line;
    EXPECT_EQ(to_line(*recorded), line);
  }
  const auto recorded = from_line("(1436509052.249713) can0 044#2A366C2B");
  EXPECT_EQ(recorded->stamp_ns, 1436509052249713000);
  EXPECT_EQ(recorded->frame.id, 0x44u);
  EXPECT_EQ(recorded->frame.length, 4);
  EXPECT_EQ(recorded->frame.data[3], 0x2B);
}

TEST(Candump, LinesOfPythonCanAreTakenToo) {
  // As CanutilsLogWriter of python-can 4.5.0 writes them: received, sent, CAN FD, remote, error.
  const std::vector<std::pair<std::string, std::string>> lines = {
      {"(1.500000) can0 044#2A366C2B R", "(1.500000) can0 044#2A366C2B"},
      {"(1.500000) can0 044# T", "(1.500000) can0 044#"},
      {"(1.500000) can0 1F334455##1AABB R", "(1.500000) can0 1F334455##1AABB"},
      {"(1.500000) can0 044#R R", "(1.500000) can0 044#R"},
      {"(1.500000) can0 20000080#", "(1.500000) can0 20000080#"}};
  for (const auto& [theirs, ours] : lines) {
    const auto recorded = from_line(theirs);
    ASSERT_TRUE(recorded) << theirs;
    EXPECT_EQ(to_line(*recorded), ours);
  }
  EXPECT_EQ(from_line("(1.500000) can0 044#R R")->kind, RecordedFrame::Kind::kRemote);
  EXPECT_EQ(from_line("(1.500000) can0 20000080#")->kind, RecordedFrame::Kind::kError);
  EXPECT_FALSE(from_line("(1.500000) can0 044#00 X"));
}

TEST(Candump, FramesOfSeveralBusesComeInTheOrderOfTheirStamps) {
  FrameOrder order;
  int number = 0;
  for (const std::int64_t stamp_ns : {30, 10, 20, 10})
    order.put({.stamp_ns = stamp_ns, .frame = {.id = static_cast<std::uint32_t>(number++)}});
  RecordedFrame frame;
  std::vector<std::uint32_t> taken;
  while (order.take(30, frame)) taken.push_back(frame.frame.id);
  EXPECT_EQ(taken, (std::vector<std::uint32_t>{1, 3, 2})) << "a later one may still come before the one of 30";
  EXPECT_TRUE(order.take(31, frame));
  EXPECT_FALSE(order.take(1000, frame));
}

TEST(Candump, OtherLinesAreNone) {
  for (const char* line :
       {"", "can0  044   [4]  2A 36 6C 2B", "(1436509052.249713) can0 044#R9", "(1436509052.249713) can0 044#R1A",
        "(1436509052.249713) can0 044#2A3", "(1.2) can0 044#", "(1436509052.249713) can0 44#",
        "(1436509052.249713) can0 FFF#00", "(1436509052.249713) can0 044#112233445566778899",
        "(1436509052.249713)  044#00", "(-1.249713) can0 044#00", "(1436509052.249713) can0 044#2A 36",
        "(99999999999999999999.000000) can0 044#"}) {
    EXPECT_FALSE(from_line(line)) << line;
  }
}

TEST(Candump, NoTextCrashesItAndWhatItTakesComesBack) {
  std::mt19937_64 random(4);
  const std::string good = "(1436509053.850870) can0 123##1AABBCC";
  for (int i = 0; i < 100'000; ++i) {
    std::string text = good;
    for (int k = 0; k < 3; ++k) text[random() % text.size()] = static_cast<char>(random());
    text.resize(random() % (good.size() + 1));
    const auto recorded = from_line(text);
    if (!recorded) continue;
    const auto again = from_line(to_line(*recorded));
    ASSERT_TRUE(again) << text;
    ASSERT_EQ(to_line(*again), to_line(*recorded));
  }
}

/// A recording of an arm's replies, as `pmg_bus dump` and candump write it, goes into the backend.
TEST(Candump, ARecordingIsReplayedIntoTheBackend) {
  const can::DriveSetup setup = can::load_drives(z1());
  std::vector<std::unique_ptr<Link>> links, far;
  for (std::size_t b = 0; b < setup.buses.size(); ++b) {
    auto [here, there] = test::MemoryLink::pair();
    links.push_back(std::move(here));
    far.push_back(std::move(there));
  }
  const io::SimulationClock clock;
  CanHal hal(setup, z1(), clock, std::move(links));
  const drives::MitProtocol protocol(drives::as_mit(setup.buses[0].motors[3].drive)->ranges());
  std::string recording;
  for (int k = 0; k < 5; ++k) {
    const drives::MitFrame bytes =
        protocol.reply({.node = 4, .reading = {.q_rad = 0.3 + 0.001 * k, .dq_rad_s = 0.5, .temperature_degC = 40.0}});
    recording +=
        to_line({.stamp_ns = k * 2'000'000, .interface = "can0", .frame = drives::Message::of(0, bytes)}) + "\n";
  }
  model::JointCommand limp = standing_command(z1());
  limp.kp.setZero();
  model::RobotState state;
  for (std::size_t at = 0; at < recording.size();) {
    const std::size_t end = recording.find('\n', at);
    const auto recorded = from_line(std::string_view(recording).substr(at, end - at));
    ASSERT_TRUE(recorded);
    hal.send(limp);
    far[0]->send(std::span(&recorded->frame, 1));
    hal.receive(state);
    at = end + 1;
  }
  EXPECT_NEAR(hal.motor(0, 3).reading().q_rad, 0.304, protocol.position().step());
  EXPECT_EQ(hal.motor(0, 3).age_cycles(), 0);
}

/// The same of a CANopen drive: what its emulator says on the bus is written as candump does, and read again.
TEST(Candump, ARecordingOfACanopenDriveIsReplayedIntoTheBackend) {
  const can::DriveSetup setup = test::mixed_drives(z1());
  const drives::MotorSetup& motor = setup.buses[0].motors[0];
  test::Cia402Emulator drive(motor);
  const auto say = [&](const drives::Message& frame, std::string& recording) {
    test::Replies replies;
    const int count = drive.hear(frame, replies);
    for (int i = 0; i < count; ++i)
      recording += to_line({.stamp_ns = 0, .interface = "can0a", .frame = replies[static_cast<std::size_t>(i)]}) + "\n";
  };
  std::vector<std::unique_ptr<Link>> host;
  std::unique_ptr<Link> far;
  std::tie(host.emplace_back(), far) = test::MemoryLink::pair();
  const auto answer = [&] {
    std::array<drives::Message, 8> asked;
    while (const std::size_t count = far->receive(asked)) {
      for (std::size_t i = 0; i < count; ++i) {
        test::Replies replies;
        far->send(std::span(replies).first(static_cast<std::size_t>(drive.hear(asked[i], replies))));
      }
    }
  };
  can::DriveSetup one;
  one.buses.push_back(setup.buses[0]);
  one.buses[0].motors.erase(one.buses[0].motors.begin() + 1, one.buses[0].motors.end());
  set_up_nodes(one, host, answer, {});
  std::string recording;
  drive.feel(motor.transmission.to_motor(drives::MotorReading{.q_rad = 0.3, .dq_rad_s = 0.5}));
  say(drives::canopen::sync(), recording);
  ASSERT_EQ(std::ranges::count(recording, '\n'), 2) << recording;

  std::vector<std::unique_ptr<Link>> links(setup.buses.size()), robots(setup.buses.size());
  for (std::size_t b = 0; b < links.size(); ++b) std::tie(links[b], robots[b]) = test::MemoryLink::pair();
  const io::SimulationClock clock;
  CanHal hal(setup, z1(), clock, std::move(links));
  model::JointCommand limp = standing_command(z1());
  limp.kp.setZero();
  hal.send(limp);
  for (std::size_t at = 0; at < recording.size();) {
    const std::size_t end = recording.find('\n', at);
    const auto recorded = from_line(std::string_view(recording).substr(at, end - at));
    ASSERT_TRUE(recorded);
    robots[0]->send(std::span(&recorded->frame, 1));
    at = end + 1;
  }
  model::RobotState state;
  hal.receive(state);
  const auto& settings = *drives::as_cia402(motor.drive);
  EXPECT_NEAR(motor.transmission.to_joint(hal.motor(0, 0).reading()).q_rad, 0.3, settings.count_rad());
  EXPECT_NEAR(hal.motor(0, 0).reading().dq_rad_s,
              motor.transmission.to_motor(drives::MotorReading{.dq_rad_s = 0.5}).dq_rad_s,
              settings.velocity_unit_rad_s);
  EXPECT_EQ(hal.motor(0, 0).age_cycles(), 0);
}

}  // namespace
}  // namespace pmg::can
