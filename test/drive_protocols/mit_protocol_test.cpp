#include "drive_protocols/mit_protocol.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "drives/uniform.hpp"

namespace pmg::drives {
namespace {

using test::uniform;

constexpr MitRanges kRanges = {
    .position_rad = 12.5, .velocity_rad_s = 45.0, .torque_Nm = 160.0, .kp_Nm_per_rad = 1000.0, .kd_Nm_s_per_rad = 50.0};
constexpr MotorLimits kLimits = {.q_lower_rad = -2.2, .q_upper_rad = 0.9, .dq_rad_s = 16.0, .torque_Nm = 120.0};
constexpr MotorLimits kWhole = {.q_lower_rad = -12.5, .q_upper_rad = 12.5, .dq_rad_s = 45.0, .torque_Nm = 160.0};

TEST(MitProtocol, FramesAreThoseOfThePublishedFirmware) {
  // By hand from the firmware's packing: p 16 bits, v 12, kp 12, kd 12, t 12, high bits first.
  const MitProtocol protocol(kRanges);
  EXPECT_EQ(protocol.command({.q_rad = -12.5, .dq_rad_s = -45.0, .torque_Nm = -160.0}, kWhole), (MitFrame{}));
  // Half of a symmetric range is between two codes; halves go up: 0x8000, 0x800. 500 of 1000 is 2047.5: 0x800.
  EXPECT_EQ(protocol.command({.kp_Nm_per_rad = 500.0, .kd_Nm_s_per_rad = 25.0}, kWhole),
            (MitFrame{0x80, 0x00, 0x80, 0x08, 0x00, 0x80, 0x08, 0x00}));
  const auto reply = protocol.reply(MitFrame{0x05, 0xFF, 0xFF, 0x00, 0x0F, 0xFF, 0x41, 0x04});
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->node, 5);
  EXPECT_DOUBLE_EQ(reply->reading.q_rad, 12.5);
  EXPECT_DOUBLE_EQ(reply->reading.dq_rad_s, -45.0);
  EXPECT_DOUBLE_EQ(reply->reading.torque_Nm, 160.0);
  EXPECT_DOUBLE_EQ(reply->reading.temperature_degC, 25.0);
  EXPECT_EQ(reply->reading.fault, DriveFault::kUnderVoltage);
}

// Bytes by an implementation that this project did not write: mini-cheetah-motor-driver-socketcan 0.4.3 (DFKI, on
// PyPI), motor type AK80_9_V2. It cuts a value to the code below, where this project takes the nearest.
constexpr MitRanges kAk80 = {
    .position_rad = 12.5, .velocity_rad_s = 25.64, .torque_Nm = 18.0, .kp_Nm_per_rad = 500.0, .kd_Nm_s_per_rad = 5.0};

TEST(MitProtocol, CommandsThatAForeignHostPackedAreReadAsItMeantThem) {
  struct Packed {
    MotorCommand asked{};
    MitFrame frame{};
  };
  const MitProtocol protocol(kAk80);
  for (const Packed& packed :
       {Packed{{0.5, -3.0, 120.0, 2.5, 4.0}, {0x85, 0x1E, 0x70, 0xF3, 0xD6, 0x7F, 0xF9, 0xC6}},
        Packed{{-7.25, 20.0, 33.0, 0.4, -11.5}, {0x35, 0xC2, 0xE3, 0xC1, 0x0E, 0x14, 0x72, 0xE3}},
        Packed{{12.5, 25.64, 500.0, 5.0, 18.0}, {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF}},
        Packed{{-12.5, -25.64, 0.0, 0.0, -18.0}, {}}}) {
    const auto read = protocol.command(packed.frame);
    ASSERT_TRUE(read);
    EXPECT_NEAR(read->q_rad, packed.asked.q_rad, protocol.position().step());
    EXPECT_NEAR(read->dq_rad_s, packed.asked.dq_rad_s, protocol.velocity().step());
    EXPECT_NEAR(read->kp_Nm_per_rad, packed.asked.kp_Nm_per_rad, 500.0 / 4095.0);
    EXPECT_NEAR(read->kd_Nm_s_per_rad, packed.asked.kd_Nm_s_per_rad, 5.0 / 4095.0);
    EXPECT_NEAR(read->torque_Nm, packed.asked.torque_Nm, protocol.torque().step());
  }
}

TEST(MitProtocol, RepliesAreReadAsAForeignHostReadsThem) {
  const MitProtocol protocol(kAk80);
  const auto read = [&](const MitFrame& frame) { return protocol.reply(frame)->reading; };
  const MotorReading some = read({0x05, 0x85, 0x1E, 0x70, 0x89, 0xC3}),
                     other = read({0x01, 0x12, 0x34, 0xFE, 0xD7, 0xBA});
  EXPECT_NEAR(some.q_rad, 0.499923705, 1e-9);
  EXPECT_NEAR(some.dq_rad_s, -3.099340659, 1e-9);
  EXPECT_NEAR(some.torque_Nm, 3.969230769, 1e-9);
  EXPECT_NEAR(other.q_rad, -10.722323949, 1e-9);
  EXPECT_NEAR(other.dq_rad_s, 25.414593407, 1e-9);
  EXPECT_NEAR(other.torque_Nm, -0.610989011, 1e-9);
}

// A joint at rest would else get half a step of torque and of kd times half a step of speed for ever: 15 mNm at a wrist
// with a field of 40 Nm, whose hand weighs as much when it is turned by 0.1 rad.
TEST(MitProtocol, OfACommandThatIsRepeatedTheMeanTorqueIsTheAskedOne) {
  const MitProtocol protocol(kRanges);
  std::mt19937_64 random(3);
  constexpr int kFrames = 400;
  for (int k = 0; k < 200; ++k) {
    const MotorCommand asked = {
        .q_rad = uniform(random, -2.0, 0.8),
        .dq_rad_s = k % 2 == 0 ? 0.0 : uniform(random, -10.0, 10.0),
        .kp_Nm_per_rad = protocol.command(MitFrame{0, 0, 0, static_cast<std::uint8_t>(k % 8), 7})->kp_Nm_per_rad,
        .kd_Nm_s_per_rad = 50.0 * (k % 5) / 4095.0,
        .torque_Nm = k % 3 == 0 ? 0.0 : uniform(random, -80.0, 80.0)};
    double left_Nm = 0.0, sum_Nm = 0.0;
    for (int n = 0; n < kFrames; ++n) {
      const MotorCommand given = *protocol.command(protocol.command(asked, kLimits, left_Nm));
      const double more_Nm = given.kp_Nm_per_rad * (given.q_rad - asked.q_rad) +
                             given.kd_Nm_s_per_rad * (given.dq_rad_s - asked.dq_rad_s) + given.torque_Nm -
                             asked.torque_Nm;
      ASSERT_LE(std::abs(more_Nm), 1.001 * protocol.torque().step()) << n;
      sum_Nm += more_Nm;
    }
    EXPECT_LE(std::abs(sum_Nm), 0.501 * protocol.torque().step()) << "what the last frame left";
  }
}

TEST(MitProtocol, WhatALimitCutsIsNotMadeUpFor) {
  const MitProtocol protocol(kRanges);
  double left_Nm = 0.0;
  for (int n = 0; n < 100; ++n) {
    const MotorCommand given = *protocol.command(
        protocol.command({.q_rad = 5.0, .kp_Nm_per_rad = 500.0, .torque_Nm = 200.0}, kLimits, left_Nm));
    ASSERT_LE(given.q_rad, kLimits.q_upper_rad);
    ASSERT_LE(given.torque_Nm, kLimits.torque_Nm);
  }
  const MotorCommand after = *protocol.command(protocol.command({}, kLimits, left_Nm));
  EXPECT_LE(std::abs(after.torque_Nm), protocol.torque().step());
}

TEST(MitProtocol, EveryCodeOfEveryFieldComesBackAsItself) {
  for (const auto& [field, bits] : {std::pair{FixedPoint(-12.5, 12.5, 16), 16},
                                    {FixedPoint(-45.0, 45.0, 12), 12},
                                    {FixedPoint(0.0, 1000.0, 12), 12}}) {
    EXPECT_EQ(field.most_code(), (1U << bits) - 1U);
    for (std::uint32_t code = 0; code <= field.most_code(); ++code) {
      ASSERT_EQ(field.code(field.value(code), field.value(0), field.value(field.most_code())), code);
      ASSERT_EQ(field.code(field.value(code), field.value(code), field.value(code)), code)
          << "a bound is within itself";
    }
  }
}

TEST(MitProtocol, ACommandArrivesWithinHalfAStepAndNeverBeyondTheLimits) {
  const MitProtocol protocol(kRanges);
  std::mt19937_64 random(1);
  for (int i = 0; i < 100'000; ++i) {
    const MotorCommand asked = {.q_rad = uniform(random, -4.0, 4.0),
                                .dq_rad_s = uniform(random, -60.0, 60.0),
                                .kp_Nm_per_rad = uniform(random, -100.0, 1200.0),
                                .kd_Nm_s_per_rad = uniform(random, -5.0, 60.0),
                                .torque_Nm = uniform(random, -200.0, 200.0)};
    const std::optional<MotorCommand> read = protocol.command(protocol.command(asked, kLimits));
    ASSERT_TRUE(read);
    const MotorCommand& got = *read;
    constexpr double kRounding = 1e-9;
    ASSERT_GE(got.q_rad, kLimits.q_lower_rad - kRounding);
    ASSERT_LE(got.q_rad, kLimits.q_upper_rad + kRounding);
    ASSERT_LE(std::abs(got.dq_rad_s), kLimits.dq_rad_s + kRounding);
    ASSERT_LE(std::abs(got.torque_Nm), kLimits.torque_Nm + kRounding);
    ASSERT_GE(got.kp_Nm_per_rad, 0.0);
    ASSERT_GE(got.kd_Nm_s_per_rad, 0.0);
    // Within the limits the error is half a step; at a limit the last code inside is up to one step away.
    const auto near = [](double value, double wanted, double lower, double upper, double step) {
      const double within = std::clamp(wanted, lower, upper);
      const double error = std::abs(value - within);
      return error <= (within > lower + step && within < upper - step ? 0.5 : 1.0) * step * (1.0 + 1e-9);
    };
    ASSERT_TRUE(near(got.q_rad, asked.q_rad, kLimits.q_lower_rad, kLimits.q_upper_rad, protocol.position().step()));
    ASSERT_TRUE(near(got.dq_rad_s, asked.dq_rad_s, -kLimits.dq_rad_s, kLimits.dq_rad_s, protocol.velocity().step()));
    ASSERT_TRUE(near(got.torque_Nm, asked.torque_Nm, -kLimits.torque_Nm, kLimits.torque_Nm, protocol.torque().step()));
    ASSERT_TRUE(near(got.kp_Nm_per_rad, asked.kp_Nm_per_rad, 0.0, 1000.0, 1000.0 / 4095.0));
    ASSERT_TRUE(near(got.kd_Nm_s_per_rad, asked.kd_Nm_s_per_rad, 0.0, 50.0, 50.0 / 4095.0));
  }
}

TEST(MitProtocol, ValuesThatAreNotFiniteGiveNoTorque) {
  const MitProtocol protocol(kRanges);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    for (double MotorCommand::*value : {&MotorCommand::q_rad, &MotorCommand::dq_rad_s, &MotorCommand::kp_Nm_per_rad,
                                        &MotorCommand::kd_Nm_s_per_rad, &MotorCommand::torque_Nm}) {
      MotorCommand asked = {
          .q_rad = 0.1, .dq_rad_s = 0.1, .kp_Nm_per_rad = 100.0, .kd_Nm_s_per_rad = 1.0, .torque_Nm = 9.0};
      asked.*value = bad;
      const auto got = protocol.command(protocol.command(asked, kLimits));
      ASSERT_TRUE(got);
      EXPECT_EQ(got->kp_Nm_per_rad, 0.0);
      EXPECT_EQ(got->kd_Nm_s_per_rad, 0.0);
      EXPECT_LE(std::abs(got->torque_Nm), 0.5 * protocol.torque().step() + 1e-9);
    }
  }
}

TEST(MitProtocol, NoCommandSwitchesTheDrive) {
  const MitProtocol protocol(kRanges);
  for (const double torque_Nm : {160.0, 159.95, 159.9, 159.85, 159.8}) {
    const MitFrame frame = protocol.command(
        {.q_rad = 12.5, .dq_rad_s = 45.0, .kp_Nm_per_rad = 1000.0, .kd_Nm_s_per_rad = 50.0, .torque_Nm = torque_Nm},
        kWhole);
    EXPECT_NE(frame, kMitEnable);
    EXPECT_NE(frame, kMitDisable);
    EXPECT_NE(frame, kMitZero);
    EXPECT_TRUE(protocol.command(frame));
  }
  for (const MitFrame& frame : {kMitEnable, kMitDisable, kMitZero}) EXPECT_FALSE(protocol.command(frame));
}

TEST(MitProtocol, AReplyRoundTripsAndAnUnknownFaultStaysAFault) {
  const MitProtocol protocol(kRanges);
  const MitReply sent = {
      .node = 7,
      .reading = {
          .q_rad = 0.3, .dq_rad_s = -2.1, .torque_Nm = 31.0, .temperature_degC = 61.0, .fault = DriveFault::kEncoder}};
  const auto got = protocol.reply(protocol.reply(sent));
  ASSERT_TRUE(got);
  EXPECT_EQ(got->node, 7);
  EXPECT_NEAR(got->reading.q_rad, 0.3, 0.5 * protocol.position().step());
  EXPECT_NEAR(got->reading.dq_rad_s, -2.1, 0.5 * protocol.velocity().step());
  EXPECT_NEAR(got->reading.torque_Nm, 31.0, 0.5 * protocol.torque().step());
  EXPECT_EQ(got->reading.temperature_degC, 61.0);
  EXPECT_EQ(got->reading.fault, DriveFault::kEncoder);
  MitFrame odd = protocol.reply(sent);
  odd[7] = 0x80;
  EXPECT_EQ(protocol.reply(odd)->reading.fault, DriveFault::kOther);
  EXPECT_FALSE(protocol.reply(std::span(odd).first(7)));
  EXPECT_FALSE(protocol.reply(std::span<const std::uint8_t>{}));
}

TEST(MitProtocol, NoByteSequenceReadsBeyondTheRanges) {
  const MitProtocol protocol(kRanges);
  std::mt19937_64 random(2);
  for (int i = 0; i < 100'000; ++i) {
    std::array<std::uint8_t, 64> bytes{};
    for (std::uint8_t& value : bytes) value = static_cast<std::uint8_t>(random());
    const auto reply = protocol.reply(std::span(bytes).first(random() % 65));
    if (!reply) continue;
    ASSERT_LE(std::abs(reply->reading.q_rad), 12.5 + 1e-9);
    ASSERT_LE(std::abs(reply->reading.dq_rad_s), 45.0 + 1e-9);
    ASSERT_LE(std::abs(reply->reading.torque_Nm), 160.0 + 1e-9);
  }
}

}  // namespace
}  // namespace pmg::drives
