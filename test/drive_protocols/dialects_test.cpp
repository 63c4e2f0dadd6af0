// What the dialects of the MIT protocol differ in, against bytes that others packed and values that others read.
// docs/reference/drives.md names them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <random>
#include <vector>

#include "drive_protocols/damiao.hpp"
#include "drive_protocols/mini_cheetah.hpp"
#include "drive_protocols/robstride.hpp"
#include "drives/uniform.hpp"

namespace pmg::drives {
namespace {

constexpr MitRanges kDm4310 = {
    .position_rad = 12.5, .velocity_rad_s = 30.0, .torque_Nm = 10.0, .kp_Nm_per_rad = 500.0, .kd_Nm_s_per_rad = 5.0};
constexpr MitRanges kAk80At50 = {
    .position_rad = 12.5, .velocity_rad_s = 50.0, .torque_Nm = 18.0, .kp_Nm_per_rad = 500.0, .kd_Nm_s_per_rad = 5.0};
constexpr MitRanges kRs00 = {
    .position_rad = 12.57, .velocity_rad_s = 33.0, .torque_Nm = 14.0, .kp_Nm_per_rad = 500.0, .kd_Nm_s_per_rad = 5.0};
constexpr MitRanges kRsSample = {
    .position_rad = 12.5, .velocity_rad_s = 33.0, .torque_Nm = 17.0, .kp_Nm_per_rad = 500.0, .kd_Nm_s_per_rad = 5.0};

MotorLimits whole(const MitRanges& ranges) {
  return {.q_lower_rad = -ranges.position_rad,
          .q_upper_rad = ranges.position_rad,
          .dq_rad_s = ranges.velocity_rad_s,
          .torque_Nm = ranges.torque_Nm};
}
MotorCommand full_scale(const MitRanges& ranges, double torque_Nm) {
  return {.q_rad = ranges.position_rad,
          .dq_rad_s = ranges.velocity_rad_s,
          .kp_Nm_per_rad = ranges.kp_Nm_per_rad,
          .kd_Nm_s_per_rad = ranges.kd_Nm_s_per_rad,
          .torque_Nm = torque_Nm};
}
int ones(const MitFrame& frame) {
  int count = 0;
  while (count < 8 && frame[static_cast<std::size_t>(count)] == 0xFF) ++count;
  return count;
}

struct ForeignReading {
  MitFrame bytes{};
  int node = 0;
  MotorReading reading{};
};
void expect_read(const MitDrive& drive, const ForeignReading& expected, std::size_t length = 8) {
  const auto reply = drive.read(std::span(expected.bytes).first(length));
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->node, expected.node);
  EXPECT_NEAR(reply->reading.q_rad, expected.reading.q_rad, 1e-9);
  EXPECT_NEAR(reply->reading.dq_rad_s, expected.reading.dq_rad_s, 1e-9);
  EXPECT_NEAR(reply->reading.torque_Nm, expected.reading.torque_Nm, 1e-9);
  EXPECT_NEAR(reply->reading.temperature_degC, expected.reading.temperature_degC, 1e-9);
  EXPECT_EQ(reply->reading.fault, expected.reading.fault);
  EXPECT_EQ(reply->reading.follows, expected.reading.follows);
}

struct ForeignCommand {
  MotorCommand asked{};
  MitFrame frame{};
};
/// The other packs to the code below, this project to the nearest: a step at most.
void expect_command(const MitDrive& drive, const ForeignCommand& packed) {
  const auto read = drive.codec().command(packed.frame);
  ASSERT_TRUE(read);
  EXPECT_NEAR(read->q_rad, packed.asked.q_rad, drive.codec().position().step());
  EXPECT_NEAR(read->dq_rad_s, packed.asked.dq_rad_s, drive.codec().velocity().step());
  EXPECT_NEAR(read->kp_Nm_per_rad, packed.asked.kp_Nm_per_rad, 500.0 / 4095.0);
  EXPECT_NEAR(read->kd_Nm_s_per_rad, packed.asked.kd_Nm_s_per_rad, 5.0 / 4095.0);
  EXPECT_NEAR(read->torque_Nm, packed.asked.torque_Nm, drive.codec().torque().step());
}

// damiao-motor 1.0.6 (PyPI), encode_cmd_msg() and decode_sensor_feedback().
TEST(Damiao, CommandsThatAForeignHostPackedAreReadAsItMeantThem) {
  const DamiaoDrive drive(kDm4310);
  expect_command(drive, {{0.5, -3.0, 120.0, 2.5, 4.0}, {0x85, 0x1E, 0x73, 0x23, 0xD6, 0x7F, 0xFB, 0x32}});
  expect_command(drive, {{-7.25, 20.0, 33.0, 0.4, -9.5}, {0x35, 0xC2, 0xD5, 0x41, 0x0E, 0x14, 0x70, 0x66}});
  expect_command(drive, {full_scale(kDm4310, 10.0), {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF}});
  expect_command(drive, {{}, {0x7F, 0xFF, 0x7F, 0xF0, 0x00, 0x00, 0x07, 0xFF}});
}

TEST(Damiao, RepliesAreReadAsAForeignHostReadsThemWithTheirStateAndTheHotterTemperature) {
  const DamiaoDrive drive(kDm4310);
  expect_read(drive, {{0x14, 0x85, 0x1E, 0x70, 0x89, 0xC3, 0x2A, 0x38},
                      4,
                      {.q_rad = 0.4999237048905165,
                       .dq_rad_s = -3.6263736263736277,
                       .torque_Nm = 2.2051282051282044,
                       .temperature_degC = 56.0,
                       .follows = Follows::kYes}});
  expect_read(drive, {{0xD3, 0x12, 0x34, 0xFE, 0xD7, 0xBA, 0x40, 0x3B},
                      3,
                      {.q_rad = -10.722323949034866,
                       .dq_rad_s = 29.736263736263737,
                       .torque_Nm = -0.33943833943834,
                       .temperature_degC = 64.0,
                       .fault = DriveFault::kCommunication,
                       .follows = Follows::kNo}});
  expect_read(drive, {{0x03, 0x80, 0x00, 0x80, 0x08, 0x00, 0x1E, 0x1D},
                      3,
                      {.q_rad = 0.0001907377737087046,
                       .dq_rad_s = 0.0073260073260073,
                       .torque_Nm = 0.0024420024420024333,
                       .temperature_degC = 30.0,
                       .follows = Follows::kNo}});
  for (const auto& [state, fault] : {std::pair{0x8, DriveFault::kOverVoltage},
                                     {0x9, DriveFault::kUnderVoltage},
                                     {0xA, DriveFault::kOverCurrent},
                                     {0xB, DriveFault::kBridgeTemperature},
                                     {0xC, DriveFault::kOverTemperature},
                                     {0xD, DriveFault::kCommunication},
                                     {0xE, DriveFault::kOverload},
                                     {0x5, DriveFault::kOther},
                                     {0xF, DriveFault::kOther}}) {
    const MitFrame bytes = {static_cast<std::uint8_t>(state << 4 | 15), 0, 0, 0, 0, 0, 0, 0};
    EXPECT_EQ(drive.read(bytes)->reading.fault, fault) << state;
    EXPECT_EQ(drive.read(bytes)->node, 15);
  }
}

TEST(Damiao, NoCommandClearsItsFaultsOrSwitchesIt) {
  const DamiaoDrive drive(kDm4310);
  for (int code = 0xF00; code <= 0xFFF; ++code) {
    const double torque_Nm = drive.codec().torque().value(static_cast<std::uint32_t>(code));
    const MitFrame frame = drive.codec().command(full_scale(kDm4310, torque_Nm), whole(kDm4310));
    EXPECT_TRUE(ones(frame) < 7 || frame[7] < 0xFB || frame[7] == 0xFF) << code;
    EXPECT_TRUE(drive.codec().command(frame)) << code;
  }
  EXPECT_FALSE(drive.codec().command(kDamiaoClear));
  const MitProtocol plain(kDm4310);
  EXPECT_EQ(plain.command(full_scale(kDm4310, 10.0), whole(kDm4310)), kDamiaoClear)
      << "what a drive that robot.yaml calls `mit` gets at full scale";
}

/// The messages that the protocol sends when the drive shows this state each time.
std::vector<MitFrame> sent(Protocol& protocol, const MitDrive& drive, const MotorReading& shown, bool off, int cycles) {
  std::vector<MitFrame> frames;
  for (int k = 0; k < cycles; ++k) {
    protocol.hear(drive.reply({.node = 4, .reading = shown}));
    Outbox out;
    if (off) {
      protocol.off(out);
    } else {
      protocol.order({.enabling = true}, out);
    }
    for (const Message& message : out.messages()) {
      MitFrame bytes{};
      std::copy_n(message.data.begin(), 8, bytes.begin());
      frames.push_back(bytes);
    }
  }
  return frames;
}

TEST(Damiao, AFaultIsClearedBeforeTheDriveIsEnabledAndAgainAfterHalfASecond) {
  const DamiaoDrive drive(kDm4310);
  const auto protocol = drive.protocol(4, whole(kDm4310), false);
  const auto frames = sent(*protocol, drive, {.fault = DriveFault::kOverCurrent}, false, 252);
  ASSERT_EQ(frames.size(), 252u) << "each cycle asks";
  for (std::size_t k = 0; k < frames.size(); ++k)
    EXPECT_EQ(frames[k], k == 0 || k == 250 ? kDamiaoClear : kMitEnable) << k;
}

TEST(Damiao, WhileItIsOffOnlyTheSilenceOfAComputerIsCleared) {
  const DamiaoDrive drive(kDm4310);
  const auto silent = drive.protocol(4, whole(kDm4310), false), hot = drive.protocol(4, whole(kDm4310), false);
  EXPECT_EQ(sent(*silent, drive, {.fault = DriveFault::kCommunication}, true, 2),
            (std::vector<MitFrame>{kDamiaoClear, kMitDisable}));
  EXPECT_EQ(sent(*hot, drive, {.fault = DriveFault::kOverTemperature}, true, 2),
            (std::vector<MitFrame>{kMitDisable, kMitDisable}));
}

// bgkatz/motorcontrol, pack_reply(): six bytes. Values as in TMotorCANControl 1.2.6 (PyPI), which reads such replies.
TEST(MiniCheetah, ShortRepliesAreReadAsAForeignHostReadsThem) {
  const MiniCheetahDrive drive(kAk80At50);
  const ForeignReading expected = {
      {0x03, 0x12, 0x34, 0xFE, 0xD7, 0xBA},
      3,
      {.q_rad = -10.722323949034866, .dq_rad_s = 49.56043956043956, .torque_Nm = -0.6109890109890124}};
  expect_read(drive, expected, 6);
  expect_read(drive, expected, 7);
  EXPECT_FALSE(drive.read(std::span(expected.bytes).first(5)));
  EXPECT_FALSE(drive.read(expected.bytes)) << "eight bytes are another dialect's";
  EXPECT_FALSE(drive.tells_temperature());
}

// TMotorCANControl 1.2.6, motor AK80-9: MIT_controller() and parse_MIT_message(). It shows the temperature's byte as it
// is; by CubeMars' manual that is 40 degC more.
TEST(CubeMars, CommandsAndRepliesAreThoseOfAForeignHost) {
  const MitDrive drive(kAk80At50);
  expect_command(drive, {{0.5, -3.0, 120.0, 2.5, 4.0}, {0x85, 0x1E, 0x78, 0x53, 0xD7, 0x80, 0x09, 0xC7}});
  expect_command(drive, {{-7.25, 20.0, 33.0, 0.4, -9.5}, {0x35, 0xC2, 0xB3, 0x31, 0x0E, 0x14, 0x73, 0xC7}});
  expect_command(drive, {full_scale(kAk80At50, 18.0), {0xFF, 0xFE, 0xFF, 0xEF, 0xFE, 0xFF, 0xEF, 0xFE}});
  expect_read(drive, {{0x05, 0x85, 0x1E, 0x70, 0x89, 0xC3, 0x41, 0x04},
                      5,
                      {.q_rad = 0.4999237048905165,
                       .dq_rad_s = -6.043956043956044,
                       .torque_Nm = 3.9692307692307693,
                       .temperature_degC = 25.0,
                       .fault = DriveFault::kUnderVoltage}});
}

// By hand from the layout in RS00's manual.
TEST(Robstride, RepliesHaveATemperatureOfSixteenBits) {
  const RobstrideDrive drive(kRs00);
  expect_read(drive, {{0x01, 0x85, 0x1E, 0x70, 0x89, 0xC3, 0x01, 0x5E},
                      1,
                      {.q_rad = 34078 * 25.14 / 65535 - 12.57,
                       .dq_rad_s = 1800 * 66.0 / 4095 - 33.0,
                       .torque_Nm = 2499 * 28.0 / 4095 - 14.0,
                       .temperature_degC = 35.0}});
}

// The maker's sample program without its microcontroller (Doraemonjayo/RobStride-SampleProgram at 6ceb402,
// main/RobStride/RobStride.c, compiled for a PC): what RobStride_Motor_MIT_Control() and its like hand to their
// transmit function, and what RobStride_Motor_Analysis() makes of these bytes in single precision.
TEST(Robstride, CommandsThatAForeignHostPackedAreReadAsItMeantThem) {
  const RobstrideDrive drive(kRsSample);
  expect_command(drive, {{0.5, -3.0, 120.0, 2.5, 4.0}, {0x85, 0x1E, 0x74, 0x53, 0xD6, 0x7F, 0xF9, 0xE1}});
  expect_command(drive, {{-7.25, 20.0, 33.0, 0.4, -9.5}, {0x35, 0xC2, 0xCD, 0x81, 0x0E, 0x14, 0x73, 0x87}});
  expect_command(drive, {{}, {0x7F, 0xFF, 0x7F, 0xF0, 0x00, 0x00, 0x07, 0xFF}});
  expect_command(drive, {{-12.5, -33.0, 0.0, 0.0, -17.0}, {}});
  EXPECT_EQ(kMitEnable, (MitFrame{0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFC}));
  EXPECT_EQ(kMitDisable, (MitFrame{0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFD}));
  EXPECT_EQ(kMitZero, (MitFrame{0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFE}));
  for (const MitFrame& other : {MitFrame{0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFB},   // clears faults
                                MitFrame{0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x00, 0xFB},   // asks for them
                                MitFrame{0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x01, 0xFC},   // sets the mode
                                MitFrame{0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x07, 0x01}})  // sets the node
    EXPECT_FALSE(drive.codec().command(other)) << "no command";
}

TEST(Robstride, RepliesAreReadAsAForeignHostReadsThemAndAFaultMessageIsNoReading) {
  const RobstrideDrive drive(kRsSample);
  struct Read {
    MitFrame bytes;
    MotorReading reading;
  };
  const std::vector<Read> replies = {
      {{4, 0x85, 0x1E, 0x70, 0x89, 0xC3, 0x01, 0x56},
       {.q_rad = 0.4999237, .dq_rad_s = -3.989012, .torque_Nm = 3.748718, .temperature_degC = 34.2}},
      {{4, 0x12, 0x34, 0xFE, 0xD7, 0xBA, 0x02, 0x8A},
       {.q_rad = -10.72232, .dq_rad_s = 32.70989, .torque_Nm = -0.5770454, .temperature_degC = 65.0}},
      {{4, 0x80, 0x00, 0x80, 0x08, 0x00, 0x01, 0x2C},
       {.q_rad = 0.0001907349, .dq_rad_s = 0.008060455, .torque_Nm = 0.004152298, .temperature_degC = 30.0}},
      {{4, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x03, 0xFF},
       {.q_rad = 12.5, .dq_rad_s = 33.0, .torque_Nm = 17.0, .temperature_degC = 102.3}},
      {{4, 0x80, 0x00, 0x00, 0x00, 0x00, 0x00, 0x01},
       {.q_rad = 0.0001907349, .dq_rad_s = -33.0, .torque_Nm = -17.0, .temperature_degC = 0.1}}};
  constexpr double kSingle = 1e-5;  // single precision of 102.3, with the maker's factor of a tenth in double
  for (const Read& read : replies) {
    const auto reply = drive.read(read.bytes);
    ASSERT_TRUE(reply);
    EXPECT_EQ(reply->node, 4);
    EXPECT_NEAR(reply->reading.q_rad, read.reading.q_rad, kSingle);
    EXPECT_NEAR(reply->reading.dq_rad_s, read.reading.dq_rad_s, kSingle);
    EXPECT_NEAR(reply->reading.torque_Nm, read.reading.torque_Nm, kSingle);
    EXPECT_NEAR(reply->reading.temperature_degC, read.reading.temperature_degC, kSingle);
    EXPECT_EQ(drive.reply(*reply).data[1], read.bytes[1]);
    EXPECT_TRUE(std::ranges::equal(drive.reply(*reply).bytes(), read.bytes)) << "what the emulated drive says";
  }
  // That host takes these for over-temperature, under-voltage and overload, and for no fault.
  EXPECT_FALSE(drive.read(MitFrame{4, 0x05, 0x40, 0, 0, 0, 0, 0}));
  EXPECT_FALSE(drive.read(MitFrame{4, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_FALSE(drive.sender(Message::of(RobstrideDrive::kReplyId, MitFrame{4, 0x05, 0x40, 0, 0, 0, 0, 0})));
}

TEST(Robstride, NoCommandBeginsWithSixBytesOfOnes) {
  const RobstrideDrive drive(kRs00);
  for (int kd = 0xF00; kd <= 0xFFF; ++kd) {
    for (const double torque_Nm : {-14.0, -13.0, 0.0, 13.9, 14.0}) {
      MotorCommand command = full_scale(kRs00, torque_Nm);
      command.kd_Nm_s_per_rad = 5.0 * kd / 4095.0;
      const MitFrame frame = drive.codec().command(command, whole(kRs00));
      ASSERT_LT(ones(frame), 6) << kd;
      ASSERT_NEAR(drive.codec().command(frame)->kd_Nm_s_per_rad, command.kd_Nm_s_per_rad, 5.0 * 17 / 4095.0);
    }
  }
  EXPECT_FALSE(drive.codec().command(MitFrame{0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x05, 0x01})) << "a new identifier";
}

TEST(Dialects, EachReadsItsOwnRepliesAndNoBytesBeyondTheRanges) {
  const MitDrive cubemars(kAk80At50);
  const DamiaoDrive damiao(kAk80At50);
  const MiniCheetahDrive mini_cheetah(kAk80At50);
  const RobstrideDrive robstride(kAk80At50);
  std::mt19937_64 random(11);
  for (const MitDrive* drive : std::initializer_list<const MitDrive*>{&cubemars, &damiao, &mini_cheetah, &robstride}) {
    for (int k = 0; k < 1000; ++k) {
      const MotorReading shown = {.q_rad = test::uniform(random, -12.0, 12.0),
                                  .dq_rad_s = test::uniform(random, -49.0, 49.0),
                                  .torque_Nm = test::uniform(random, -17.0, 17.0),
                                  .temperature_degC = std::floor(test::uniform(random, 0.0, 120.0)),
                                  .fault = DriveFault::kNone,
                                  .follows = k % 2 == 0 ? Follows::kYes : Follows::kNo};
      const Message message = drive->reply({.node = 7, .reading = shown});
      const auto read = drive->read(message.bytes());
      ASSERT_TRUE(read) << drive->protocol_name();
      ASSERT_EQ(read->node, 7);
      ASSERT_NEAR(read->reading.q_rad, shown.q_rad, 0.5 * drive->codec().position().step() + 1e-9);
      ASSERT_NEAR(read->reading.torque_Nm, shown.torque_Nm, 0.5 * drive->codec().torque().step() + 1e-9);
      ASSERT_EQ(read->reading.temperature_degC, drive->tells_temperature() ? shown.temperature_degC : 0.0);
      ASSERT_EQ(read->reading.follows, drive->says_enabled() ? shown.follows : Follows::kUnknown);
      MitFrame bytes{};
      for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
      const auto any = drive->read(std::span(bytes).first(random() % 9));
      if (!any) continue;
      ASSERT_LE(std::abs(any->reading.q_rad), 12.5 + 1e-9);
      ASSERT_LE(std::abs(any->reading.dq_rad_s), 50.0 + 1e-9);
      ASSERT_LE(std::abs(any->reading.torque_Nm), 18.0 + 1e-9);
    }
  }
}

}  // namespace
}  // namespace pmg::drives
