// The IMU's serial line over a pseudo terminal, with an emulated device at its other end.
#include "imu/serial_imu.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <numbers>

#include "can/xsens_imu.hpp"
#include "faults/fault_detector.hpp"
#include "files/config_error.hpp"
#include "generator_core/allocation_count.hpp"
#include "imu/imu_backend.hpp"
#include "model/robots.hpp"
#include "mti_emulator.hpp"
#include "refusal.hpp"

namespace pmg::imu {
namespace {

using test::MtiEmulator;
using testing::HasSubstr;

model::SerialImuModel on(const MtiEmulator& device) {
  return {.device = device.device, .baud = 921600, .rate_Hz = 400};
}

/// What the constructor says; "taken" when it says nothing.
std::string refusal(MtiEmulator& device) {
  return test::refusal_by<std::exception>([&] { const SerialImu imu(on(device), [&] { device.step(); }); });
}

TEST(SerialImuStart, IsSetUpTestedAndHeard) {
  MtiEmulator device;
  SerialImu imu(on(device), [&] { device.step(); });
  EXPECT_EQ(imu.age_cycles(), 0);
  EXPECT_GE(imu.counts().samples, 1u);
  EXPECT_EQ(device.configured, 1);
  EXPECT_THAT(device.outputs, testing::ElementsAre(0x10, 0x20, 0xFF, 0xFF, 0x20, 0x10, 1, 0x90, 0x40, 0x20, 1, 0x90,
                                                   0x80, 0x20, 1, 0x90, 0xE0, 0x20, 0xFF, 0xFF));
}

TEST(SerialImuStart, ADeviceThatSendsTheseAlreadyIsNotWrittenAgain) {
  MtiEmulator device;
  EXPECT_EQ(refusal(device), "taken");
  EXPECT_EQ(refusal(device), "taken");
  EXPECT_EQ(device.configured, 1) << "its memory wears";
}

TEST(SerialImuStart, ARequestThatIsOverheardIsRepeated) {
  MtiEmulator device;
  device.deaf_requests = 2;
  EXPECT_EQ(refusal(device), "taken");
}

TEST(SerialImuStart, WhatIsWrongIsOneLine) {
  MtiEmulator device;
  device.mute = true;
  EXPECT_EQ(refusal(device), "IMU on " + device.device + ": does not answer; expected an Xsens MTi at 921600 baud");
  device.mute = false;
  device.refuses = true;
  EXPECT_THAT(refusal(device), HasSubstr(": refuses message 0xC0 with error 4"));
  device.refuses = false;
  device.passed = 0x1FF & ~0x10;
  EXPECT_THAT(refusal(device), HasSubstr("its self-test failed: gyroscope y; expected every sensor to pass"));
  device.passed = 0x3F;
  EXPECT_EQ(refusal(device), "taken") << "nothing uses the magnetometers";
  device.dumb = true;
  EXPECT_THAT(refusal(device), HasSubstr("sends no sample; expected 400 a second"));
  device.dumb = false;
  device.sample.acceleration_m_s2 = {0.0, 0.0, 7.5};
  EXPECT_THAT(refusal(device), HasSubstr("measures 7.5 m/s^2; expected 9.8 within 2"));
  device.sample.acceleration_m_s2 = {0.0, 0.0, -9.81};  // a world frame whose z points down
  EXPECT_THAT(refusal(device), HasSubstr("its orientation is 180 degrees off gravity"));
}

TEST(SerialImuStart, ALineThatCantBeOpenedIsOneLine) {
  const auto open = [](const std::string& device, int baud) {
    try {
      const SerialPort port(device, baud);
      return std::string("opened");
    } catch (const std::exception& error) {
      return std::string(error.what());
    }
  };
  EXPECT_EQ(open("/dev/none", 115200),
            "IMU on /dev/none: No such file or directory; expected the IMU's serial line (ls /dev/serial/by-id)");
  EXPECT_THAT(open("/dev/null", 115200),
              HasSubstr("IMU on /dev/null: Inappropriate ioctl for device; expected a serial line"));
  const MtiEmulator device;
  EXPECT_THAT(open(device.device, 12345), HasSubstr("12345 baud isn't a rate of serial lines"));
  EXPECT_EQ(open(device.device, 115200), "opened");
}

/// Drives that always answer; counts the commands that reach them.
class Drives final : public hal::Hal {
 public:
  hal::BusStatus exchange(const model::JointCommand& /*command*/, model::RobotState& state) noexcept override {
    ++commands;
    state.bus_sample = static_cast<std::uint64_t>(commands);
    return status;
  }
  int commands = 0;
  hal::BusStatus status = hal::BusStatus::kOk;
};

class SerialImuInTheBus : public testing::Test {
 protected:
  hal::BusStatus cycle(bool speaks = true) {
    if (speaks) device_.send_sample();
    return hal_.exchange({}, state_);
  }
  MtiEmulator device_;
  SerialImu imu_{on(device_), [this] { device_.step(); }};
  Drives drives_;
  HalWithImu hal_{drives_, imu_};
  model::RobotState state_;
};

TEST_F(SerialImuInTheBus, GivesTheNewestSampleInEveryCycle) {
  device_.sample.gyro_rad_s = {0.25, 0.0, -1.5};
  device_.send_sample();
  device_.sample.gyro_rad_s = {0.5, 0.0, -1.5};
  EXPECT_EQ(cycle(), hal::BusStatus::kOk);
  EXPECT_EQ(state_.gyro_rad_s, Eigen::Vector3d(0.5, 0.0, -1.5));
  EXPECT_EQ(state_.acceleration_m_s2.z(), static_cast<double>(9.81F));
  EXPECT_EQ(state_.bus_sample, 1u);
}

// Late, then lost, after as many cycles as an IMU on CAN: the reaction to it is in one table.
TEST_F(SerialImuInTheBus, IsLateAndLostAsAnImuOnCanIs) {
  static_assert(SerialImu::kLateCycles == can::XsensImu::kLateCycles &&
                SerialImu::kSilentCycles == can::XsensImu::kSilentCycles);
  ASSERT_EQ(cycle(), hal::BusStatus::kOk);
  const std::uint64_t whole = state_.bus_sample;
  for (int silent = 1; silent <= 12; ++silent) {
    const hal::BusStatus expected = silent > 10  ? hal::BusStatus::kLost
                                    : silent > 5 ? hal::BusStatus::kStale
                                                 : hal::BusStatus::kOk;
    EXPECT_EQ(cycle(false), expected) << silent;
    EXPECT_EQ(state_.bus_sample, whole + static_cast<std::uint64_t>(std::min(silent, 5)))
        << "the state stays as it was";
    EXPECT_EQ(hal_.imu_silent(), silent > 10);
  }
  EXPECT_EQ(drives_.commands, 13) << "the drives get their commands all the while";
  EXPECT_EQ(cycle(), hal::BusStatus::kOk) << "and it is back with its first sample";
  EXPECT_FALSE(hal_.imu_silent());
}

TEST_F(SerialImuInTheBus, TheWorseOfDrivesAndImuCounts) {
  drives_.status = hal::BusStatus::kStale;
  EXPECT_EQ(cycle(), hal::BusStatus::kStale);
  drives_.status = hal::BusStatus::kLost;
  EXPECT_EQ(cycle(), hal::BusStatus::kLost);
  EXPECT_EQ(state_.bus_sample, 0u);
}

TEST_F(SerialImuInTheBus, CountsWhatIsDamagedLostAndNotBelieved) {
  const ImuCounts before = imu_.counts();
  ASSERT_EQ(cycle(), hal::BusStatus::kOk);
  std::vector<std::uint8_t> damaged = mti_message(MtiId::kData, encode_mti_sample(device_.sample));
  damaged[20] ^= 1U;
  device_.send(damaged);
  device_.sample.counter = static_cast<std::uint16_t>(device_.sample.counter + 3);
  ASSERT_EQ(cycle(), hal::BusStatus::kOk) << "it finds the next one";
  MtiSample wrong = device_.sample;
  wrong.acceleration_m_s2.x() = std::numeric_limits<double>::quiet_NaN();
  device_.send(mti_message(MtiId::kData, encode_mti_sample(wrong)));
  ASSERT_EQ(cycle(false), hal::BusStatus::kOk);
  EXPECT_EQ(imu_.age_cycles(), 1) << "what isn't believed is no news";
  device_.sample.certain = false;
  cycle();
  const ImuCounts after = imu_.counts();
  EXPECT_EQ(after.checksum_errors - before.checksum_errors, 1u);
  EXPECT_EQ(after.lost - before.lost, 3u);
  EXPECT_EQ(after.not_believed - before.not_believed, 1u);
  EXPECT_EQ(after.uncertain - before.uncertain, 1u);
  EXPECT_EQ(hal_.damaged(), after.checksum_errors);
}

TEST_F(SerialImuInTheBus, OnlyDataIsASample) {
  ASSERT_EQ(cycle(), hal::BusStatus::kOk);
  const ImuCounts before = imu_.counts();
  device_.send(mti_message(MtiId::kWakeUp));
  device_.send(mti_message(MtiId::kError, encode_mti_sample(device_.sample)));
  cycle(false);
  EXPECT_EQ(imu_.age_cycles(), 1);
  EXPECT_EQ(imu_.counts().samples, before.samples);
  EXPECT_EQ(imu_.counts().not_believed, before.not_believed);
}

TEST_F(SerialImuInTheBus, AStallOfTheHostLeavesTheNewestSample) {
  for (int k = 0; k < 40; ++k) device_.send_sample();  // 0.1 s: the line's buffer holds 62 of them
  device_.sample.gyro_rad_s = {1.0, 0.0, 0.0};
  EXPECT_EQ(cycle(), hal::BusStatus::kOk);
  EXPECT_EQ(state_.gyro_rad_s.x(), 1.0);
}

TEST_F(SerialImuInTheBus, AllocatesNothing) {
  const long before = test::allocation_count();
  if (before < 0) GTEST_SKIP() << "a sanitizer counts for itself";
  for (int k = 0; k < 50; ++k) hal_.exchange({}, state_);
  EXPECT_EQ(test::allocation_count(), before);
}

// The IMU hangs upside down and turned: robot.yaml's mounting makes an upright robot of it.
TEST(SerialImuMounting, IsRobotYamls) {
  MtiEmulator device;
  const Eigen::AngleAxisd mounted(std::numbers::pi, Eigen::Vector3d::UnitX());
  device.sample.orientation_WI = Eigen::Quaterniond(mounted);
  device.sample.acceleration_m_s2 = {0.0, 0.0, -9.81};
  SerialImu imu(on(device), [&] { device.step(); });
  Drives drives;
  HalWithImu hal(drives, imu);
  device.send_sample();
  model::RobotState state;
  ASSERT_EQ(hal.exchange({}, state), hal::BusStatus::kOk);
  model::RobotModel robot = test::z1();
  state.q = state.dq = state.tau = JointVector::Zero(robot.joint_index.size());
  state.q = robot.q_stand();
  state.temperature_degC = JointVector::Constant(robot.joint_index.size(), 30.0);
  const auto fault = [&] {
    faults::FaultDetector detector(robot, {});
    std::optional<faults::Fault> found;
    for (int tick = 1; tick < 6; ++tick) {
      ++state.bus_sample;
      state.stamp_ns = tick * 10'000'000;
      found = detector.detect({.state = state, .now_ns = state.stamp_ns}, faults::FaultDetector::Scope::kMotion);
    }
    return found;
  };
  ASSERT_TRUE(fault()) << "robot.yaml's mounting without a turn says that the robot is upside down";
  robot.imu.T_LI.linear() = mounted.toRotationMatrix();
  EXPECT_FALSE(fault());
}

class SerialImuFile : public testing::Test {
 protected:
  /// The line about a robot.yaml whose `imu` has this `serial`; the read one otherwise.
  std::string read(const std::string& serial) {
    std::filesystem::create_directories(folder_);
    std::filesystem::copy(std::filesystem::path(test::kZ1Folder) / "z1.urdf", folder_ / "z1.urdf",
                          std::filesystem::copy_options::overwrite_existing);
    std::ifstream file(std::filesystem::path(test::kZ1Folder) / "robot.yaml");
    std::string text(std::istreambuf_iterator<char>(file), {});
    const std::string before = "  rpy_rad: [0.0, 0.0, 0.0]\n";
    text.replace(text.find(before), before.size(), before + "  serial: {" + serial + "}\n");
    std::ofstream(folder_ / "robot.yaml") << text;
    try {
      const auto imu = model::load_robot(folder_).imu.serial.value();
      return imu.device + " " + std::to_string(imu.baud) + " " + std::to_string(imu.rate_Hz);
    } catch (const files::ConfigError& error) {
      return error.what();
    }
  }
  ~SerialImuFile() override { std::filesystem::remove_all(folder_); }
  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("pmg_serial_imu_" + std::to_string(getpid()));
};

TEST_F(SerialImuFile, IsReadStrictly) {
  EXPECT_EQ(read("protocol: xsens_mti, device: /dev/ttyUSB0, baud: 921600, rate_Hz: 400"), "/dev/ttyUSB0 921600 400");
  EXPECT_THAT(read("protocol: nmea, device: /dev/ttyUSB0, baud: 921600, rate_Hz: 400"),
              HasSubstr("imu.serial.protocol"));
  EXPECT_THAT(read("protocol: xsens_mti, device: ttyUSB0, baud: 921600, rate_Hz: 400"),
              HasSubstr("imu.serial.device: is 'ttyUSB0'; expected a file below /dev"));
  EXPECT_THAT(read("protocol: xsens_mti, device: /dev/ttyUSB0, baud: 921600, rate_Hz: 100"),
              HasSubstr("imu.serial.rate_Hz: is '100'; expected a number from 200"));
  EXPECT_THAT(read("protocol: xsens_mti, device: /dev/ttyUSB0, baud: 115200, rate_Hz: 400"),
              HasSubstr("imu.serial.baud: carries no 400 samples a second; expected at least 264000"));
}

}  // namespace
}  // namespace pmg::imu
