#include "drive_protocols/cia402.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <limits>
#include <map>
#include <random>
#include <stdexcept>

#include "drive_protocols/cia402_objects.hpp"

namespace pmg::drives {
namespace {

constexpr MotorLimits kCiaLimits = {.q_lower_rad = -1.0, .q_upper_rad = 2.0, .dq_rad_s = 10.0, .torque_Nm = 50.0};
constexpr std::uint16_t kDisabled = 0x250, kReady = 0x231, kSwitchedOn = 0x233, kOn = 0x237, kFault = 0x218;

Cia402Settings settings(Cia402Mode mode) {
  return {.mode = mode,
          .counts_per_turn = 10'000.0,
          .velocity_unit_rad_s = 0.01,
          .rated_torque_Nm = 20.0,
          .largest_torque_Nm = 60.0,
          .kp_Nm_per_rad = 100.0,
          .kd_Nm_s_per_rad = 2.0};
}

TEST(Cia402, EveryStatusWordOfTheProfileIsItsStateWhateverItsOtherBitsAre) {
  const std::map<std::uint16_t, Cia402State> words = {{0x00, Cia402State::kNotReady},
                                                      {0x40, Cia402State::kSwitchOnDisabled},
                                                      {0x21, Cia402State::kReadyToSwitchOn},
                                                      {0x23, Cia402State::kSwitchedOn},
                                                      {0x27, Cia402State::kOperationEnabled},
                                                      {0x07, Cia402State::kQuickStopActive},
                                                      {0x0F, Cia402State::kFaultReactionActive},
                                                      {0x08, Cia402State::kFault}};
  for (const auto& [word, state] : words) {
    for (unsigned other = 0; other < 0x200; ++other) {  // bits 4 and 7 to 15
      const auto bits = static_cast<std::uint16_t>((other & 1U) << 4U | (other >> 1U) << 7U);
      EXPECT_EQ(cia402_state(static_cast<std::uint16_t>(word | bits)), state) << std::hex << word << ' ' << bits;
    }
  }
  for (const std::uint16_t word : std::initializer_list<std::uint16_t>{0x40, 0x08, 0x0F, 0x00})
    EXPECT_EQ(cia402_state(static_cast<std::uint16_t>(word | 0x20)), cia402_state(word))
        << "quick stop has no meaning there";
}

TEST(Cia402, ErrorCodesAreTheirFaults) {
  EXPECT_EQ(cia402_fault(0x0000), DriveFault::kNone);
  EXPECT_EQ(cia402_fault(0x2310), DriveFault::kOverCurrent);
  EXPECT_EQ(cia402_fault(0x2220), DriveFault::kOverCurrent);
  EXPECT_EQ(cia402_fault(0x3110), DriveFault::kOverVoltage);
  EXPECT_EQ(cia402_fault(0x3210), DriveFault::kOverVoltage);
  EXPECT_EQ(cia402_fault(0x3120), DriveFault::kUnderVoltage);
  EXPECT_EQ(cia402_fault(0x3221), DriveFault::kUnderVoltage);
  EXPECT_EQ(cia402_fault(0x3130), DriveFault::kOther) << "a missing phase";
  EXPECT_EQ(cia402_fault(0x4210), DriveFault::kBridgeTemperature);
  EXPECT_EQ(cia402_fault(0x4310), DriveFault::kOverTemperature);
  EXPECT_EQ(cia402_fault(0x4320), DriveFault::kOther) << "too cold";
  EXPECT_EQ(cia402_fault(0x7121), DriveFault::kStall);
  EXPECT_EQ(cia402_fault(0x7305), DriveFault::kEncoder);
  EXPECT_EQ(cia402_fault(0x8130), DriveFault::kCommunication);
  EXPECT_EQ(cia402_fault(0x8611), DriveFault::kFollowing);
  EXPECT_EQ(cia402_fault(0xFF01), DriveFault::kOther);
}

TEST(Cia402, AReadingHasTheUnitsOfRobotYaml) {
  Cia402Settings own = settings(Cia402Mode::kTorque);
  own.temperature_unit_degC = 0.1;
  Cia402Axis axis(own, kCiaLimits);
  const MotorReading reading =
      axis.hear({.status_word = kOn, .position = -2500, .velocity = 150, .torque = -500, .temperature = 412});
  EXPECT_NEAR(reading.q_rad, -std::acos(0.0), 1e-12) << "a quarter of a turn";
  EXPECT_DOUBLE_EQ(reading.dq_rad_s, 1.5);
  EXPECT_DOUBLE_EQ(reading.torque_Nm, -10.0);
  EXPECT_NEAR(reading.temperature_degC, 41.2, 1e-9);
  EXPECT_EQ(reading.fault, DriveFault::kNone);
}

/// A drive that obeys each control word at once.
std::uint16_t next_state(std::uint16_t state, std::uint16_t word) {
  if ((word & 0x2U) == 0 || (word & 0x4U) == 0) return kDisabled;
  if (word == 0x6) return kReady;
  if (word == 0x7) return kSwitchedOn;
  return word == 0xF && (state == kSwitchedOn || state == kOn) ? kOn : state;
}

TEST(Cia402, ItIsSwitchedOnInFourCyclesWithoutStiffnessAndNeverUnderIt) {
  for (const Cia402Mode mode : {Cia402Mode::kTorque, Cia402Mode::kPosition}) {
    Cia402Axis axis(settings(mode), kCiaLimits);
    const MotorCommand hold{.q_rad = 0.1, .kp_Nm_per_rad = 100.0, .kd_Nm_s_per_rad = 2.0};
    std::uint16_t state = kDisabled;
    const auto cycle = [&](const MotorCommand& command, bool stiff) {
      const MotorReading reading = axis.hear({.status_word = state});
      state = next_state(state, axis.command(command, stiff, reading, Freshness::kFresh).control_word);
      return reading.follows == Follows::kYes;
    };
    for (int k = 0; k < 20; ++k) EXPECT_FALSE(cycle(hold, true));
    EXPECT_NE(state, kOn);
    for (int k = 0; k < 4; ++k) cycle({}, false);
    EXPECT_TRUE(cycle({}, false));
    EXPECT_EQ(state, mode == Cia402Mode::kTorque ? kOn : kSwitchedOn) << "position mode stays limp";
    EXPECT_TRUE(cycle(hold, true));
    EXPECT_EQ(state, kOn);
  }
}

TEST(Cia402, APositionDriveThatIsntOnAfterATenthOfASecondDoesntFollow) {
  Cia402Axis axis(settings(Cia402Mode::kPosition), kCiaLimits);
  const MotorCommand hold{.kp_Nm_per_rad = 100.0, .kd_Nm_s_per_rad = 2.0};
  axis.command({}, false, axis.hear({.status_word = kSwitchedOn}), Freshness::kFresh);
  int cycles = 0;
  while (axis.hear({.status_word = kSwitchedOn}).follows == Follows::kYes && cycles < 1000) {
    axis.command(hold, true, {}, Freshness::kFresh);
    ++cycles;
  }
  EXPECT_EQ(cycles, Cia402Axis::kSwitchOnCycles + 1);
}

TEST(Cia402, APositionDriveFarOutsideItsRangeIsNotSwitchedOn) {
  for (const double beyond_rad : {0.1, 0.3}) {
    Cia402Axis axis(settings(Cia402Mode::kPosition), kCiaLimits);
    axis.hear({.status_word = kSwitchedOn});
    axis.command({}, false, {.q_rad = 2.0 + beyond_rad}, Freshness::kFresh);
    EXPECT_EQ(axis.hear({.status_word = kSwitchedOn}).follows == Follows::kYes, beyond_rad < 0.2);
  }
}

TEST(Cia402, OfACommandThatIsNoNumberNothingIsDone) {
  Cia402Axis axis(settings(Cia402Mode::kTorque), kCiaLimits);
  const MotorReading moving = {.dq_rad_s = 1.0};
  for (int k = 0; k < 4; ++k) {
    axis.hear({.status_word = kOn});
    axis.command({}, false, moving, Freshness::kFresh);
  }
  MotorCommand command = {.q_rad = 0.0, .kp_Nm_per_rad = 10.0, .kd_Nm_s_per_rad = 2.0};
  EXPECT_NE(axis.command(command, true, moving, Freshness::kFresh).torque, 0);
  command.q_rad = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(axis.command(command, true, moving, Freshness::kFresh).torque, 0);
}

TEST(Cia402, TargetsStayWithinLimitsWhateverIsAskedAndRead) {
  std::mt19937_64 random(7);
  const auto any = [&random]() -> double {
    switch (random() % 6) {
      case 0:
        return std::numeric_limits<double>::quiet_NaN();
      case 1:
        return std::numeric_limits<double>::infinity();
      case 2:
        return 1e300;
      case 3:
        return -1e9;
      default:
        return std::uniform_real_distribution<double>(-5.0, 5.0)(random);
    }
  };
  for (const Cia402Mode mode : {Cia402Mode::kTorque, Cia402Mode::kPosition}) {
    Cia402Axis axis(settings(mode), kCiaLimits);
    for (int k = 0; k < 100'000; ++k) {
      axis.hear({.status_word = random() % 2 == 0 ? kOn : static_cast<std::uint16_t>(random()),
                 .position = static_cast<std::int32_t>(random()),
                 .velocity = static_cast<std::int32_t>(random()),
                 .error_code = static_cast<std::uint16_t>(random())});
      MotorCommand command{any(), any(), any(), any(), any()};
      if (random() % 2 == 0) command = {.q_rad = any(), .kp_Nm_per_rad = 100.0, .kd_Nm_s_per_rad = 2.0};
      const Cia402Targets targets = axis.command(command, random() % 2 == 0, {.q_rad = any(), .dq_rad_s = any()},
                                                 Freshness{static_cast<std::uint8_t>(random() % 3)});
      ASSERT_LE(std::abs(targets.torque * 0.02), kCiaLimits.torque_Nm + 1e-9);
      ASSERT_GE(targets.position * 2.0 * std::numbers::pi / 1e4, kCiaLimits.q_lower_rad - 1e-9);
      ASSERT_LE(targets.position * 2.0 * std::numbers::pi / 1e4, kCiaLimits.q_upper_rad + 1e-9);
    }
  }
}

/// Objects in memory.
class Objects final : public ObjectDictionary {
 public:
  std::optional<std::uint32_t> read(const ObjectId& id) override {
    const auto found = values.find(id.index * 256 + id.subindex);
    return found == values.end() ? std::nullopt : std::optional(found->second);
  }
  bool write(const ObjectId& id, std::uint32_t value) override {
    const auto found = values.find(id.index * 256 + id.subindex);
    if (found == values.end()) return false;
    if (id.index != stubborn) found->second = value;
    return true;
  }
  std::map<int, std::uint32_t> values;
  int stubborn = 0;
};

TEST(Cia402, ADriveThatKeepsAnotherValueThanWrittenIsRefused) {
  Objects objects;
  for (const ObjectId& id : {object::kControlWord, object::kMode, object::kMostTorque, object::kAbortOption})
    objects.values[id.index * 256 + id.subindex] = 0;
  set_up_drive(objects, settings(Cia402Mode::kTorque), kCiaLimits);
  EXPECT_EQ(objects.values[0x607200], 2500u) << "50 Nm of 20";
  objects.stubborn = 0x6072;
  objects.values[0x607200] = 1000;
  try {
    set_up_drive(objects, settings(Cia402Mode::kTorque), kCiaLimits);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(),
                 "object 0x6072 (largest torque) stays at 1000 after 2500 was written; expected a drive "
                 "that takes it");
  }
}

}  // namespace
}  // namespace pmg::drives
