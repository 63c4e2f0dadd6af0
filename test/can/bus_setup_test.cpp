#include "can/bus_setup.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "../model/robots.hpp"
#include "drive_protocols/canopen_drive.hpp"
#include "drive_protocols/mit_drive.hpp"
#include "drives/motor_monitor.hpp"
#include "files/config_error.hpp"

namespace pmg::can {
namespace {

/// A copy of Z1 whose robot.yaml can be changed.
class DriveSetupFile : public testing::Test {
 protected:
  DriveSetupFile() {
    std::filesystem::create_directories(folder_);
    std::filesystem::copy(std::filesystem::path(test::kZ1Folder) / "z1.urdf", folder_ / "z1.urdf");
    std::ifstream file(std::filesystem::path(test::kZ1Folder) / "robot.yaml");
    text_ = std::string(std::istreambuf_iterator<char>(file), {});
  }
  ~DriveSetupFile() override { std::filesystem::remove_all(folder_); }

  void replace(const std::string& what, const std::string& by) {
    const std::size_t at = text_.find(what);
    ASSERT_NE(at, std::string::npos) << what;
    text_.replace(at, what.size(), by);
  }
  std::string refusal() {
    std::ofstream(folder_ / "robot.yaml") << text_;
    try {
      load_drives(model::load_robot(folder_));
    } catch (const files::ConfigError& error) {
      return error.what();
    }
    return "taken";
  }

  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("pmg_drive_setup_test_" + std::to_string(getpid()));
  std::string text_;
};

TEST(DriveSetup, Z1HasThirtyOneMotorsOnFiveBuses) {
  const DriveSetup setup = load_drives(test::z1());
  ASSERT_EQ(setup.buses.size(), 5u);
  EXPECT_EQ(setup.buses[0].name, "can0");
  EXPECT_EQ(setup.buses[0].motors[3].joint, "left_knee");
  EXPECT_EQ(setup.buses[0].motors[3].node, 4);
  EXPECT_EQ(setup.buses[0].motors[3].limits.torque_Nm, 120.0);
}

TEST_F(DriveSetupFile, WhatADriveCantDoIsRefusedWithItsPlace) {
  EXPECT_EQ(refusal(), "taken");
  replace("node: 4, drive: leg", "node: 4, drive: arm");
  EXPECT_THAT(
      refusal(),
      testing::HasSubstr(
          "joints.left_knee.bus: the drive 'arm' covers a torque_Nm of 40 and left_knee's effort needs 120 at the "
          "motor; expected a drive whose torque_Nm is 120 or more"));
  replace("node: 4, drive: arm", "node: 4, drive: arm, gear: 3");
  EXPECT_THAT(refusal(), testing::HasSubstr("covers a position_rad of 6.3 and left_knee's range needs 7.2"));
  replace("node: 4, drive: arm, gear: 3", "node: 4, drive: legs");
  EXPECT_THAT(refusal(), testing::HasSubstr("'legs' isn't a drive; expected the name of an entry of `drives`"));
  replace("node: 4, drive: legs", "node: 4");
  EXPECT_THAT(refusal(), testing::HasSubstr("joints.left_knee.bus: has no `drive`"));
  replace("node: 4}", "node: 200, drive: leg}");
  EXPECT_THAT(refusal(), testing::HasSubstr("node is 200; expected 1 to 127"));
  replace("node: 200, drive: leg", "node: 4, drive: leg, direction: 2");
  EXPECT_THAT(refusal(), testing::HasSubstr("joints.left_knee.bus.direction: is 2; expected 1 or -1"));
}

TEST_F(DriveSetupFile, AnImuOfItsOwnLineIsOnNoBus) {
  replace("  rpy_rad: [0.0, 0.0, 0.0]\n",
          "  rpy_rad: [0.0, 0.0, 0.0]\n  serial: {protocol: xsens_mti, device: /dev/ttyUSB0, baud: 921600, rate_Hz: "
          "400}\n");
  EXPECT_THAT(refusal(),
              testing::HasSubstr("1 buses with drives have the IMU; expected none: robot.yaml has `imu.serial`"));
  replace(", imu: xsens_can", "");
  EXPECT_EQ(refusal(), "taken");
}

TEST_F(DriveSetupFile, SamplePointsAreReadAndBounded) {
  replace("can0: {bitrate: 1000000", "can0: {bitrate: 1000000, sample_point: 0.8, data_sample_point: 0.7");
  EXPECT_EQ(refusal(), "taken");
  const BusSetup bus = load_drives(model::load_robot(folder_)).buses.front();
  EXPECT_EQ(bus.sample_point, 0.8);
  EXPECT_EQ(bus.data_sample_point, 0.7);
  EXPECT_EQ(load_drives(test::z1()).buses.front().sample_point, 0.0);
  replace("sample_point: 0.8", "sample_point: 80");
  EXPECT_THAT(refusal(), testing::HasSubstr("buses.can0.sample_point: is '80'; expected a number from 0.5 to 0.95"));
}

TEST_F(DriveSetupFile, AnotherNetworkMayCarryABusOrHaveItsDrives) {
  replace("can0: {bitrate: 1000000}", "can0: {bitrate: 1000000, bridge: {slave: 1}}");
  EXPECT_EQ(refusal(), "taken");
  const DriveSetup bridged = load_drives(model::load_robot(folder_));
  EXPECT_TRUE(bridged.buses[0].on_can);
  EXPECT_EQ(bridged.buses[0].fresh_cycles(), drives::MotorMonitor::kFreshOverBridge) << "its answers are a cycle older";
  EXPECT_EQ(bridged.buses[1].fresh_cycles(), drives::MotorMonitor::kFreshCycles);
  replace("can0: {bitrate: 1000000, bridge: {slave: 1}}", "can0: {first_slave: 1}");
  EXPECT_THAT(refusal(), testing::HasSubstr("buses.can0: has drives of the MIT protocol as EtherCAT slaves"));
}

TEST_F(DriveSetupFile, AnImuOfAnotherNetworkIsOnNoBus) {
  replace("  rpy_rad: [0.0, 0.0, 0.0]\n", "  rpy_rad: [0.0, 0.0, 0.0]\n  process_data: {slave: 9}\n");
  EXPECT_THAT(refusal(), testing::HasSubstr("expected none: robot.yaml has `imu.process_data`"));
  replace(", imu: xsens_can", "");
  EXPECT_EQ(refusal(), "taken");
  EXPECT_FALSE(load_drives(model::load_robot(folder_)).imu_on_can_or_line);
  EXPECT_TRUE(load_drives(test::z1()).imu_on_can_or_line);
}

TEST_F(DriveSetupFile, AJointsDriveMayReplyWithAnIdentifierOfItsOwn) {
  replace("node: 4, drive: leg", "node: 4, reply_id: 0x104, drive: leg");
  EXPECT_EQ(refusal(), "taken");
  const DriveSetup setup = load_drives(model::load_robot(folder_));
  EXPECT_EQ(drives::as_mit(setup.buses[0].motors[3].drive)->ranges().reply_id, 0x104u);
  EXPECT_EQ(drives::as_mit(setup.buses[0].motors[2].drive)->ranges().reply_id, 0u) << "as its entry in `drives` has it";
  replace("reply_id: 0x104", "reply_id: 0x800");
  EXPECT_THAT(refusal(), testing::HasSubstr("expected"));
}

TEST_F(DriveSetupFile, ACia402DriveIsReadAndRefusedWhereItDoesNotFit) {
  replace("  arm: {",
          "  knee: {protocol: cia402, mode: torque, counts_per_turn: 65536, velocity_unit_rad_s: 0.001, "
          "rated_torque_Nm: 40, torque_Nm: 120, temperature_index: 8240}\n  arm: {");
  replace("node: 4, drive: leg", "node: 4, drive: knee");
  EXPECT_THAT(refusal(), testing::HasSubstr("buses.can0: has CANopen drives, and left_hip_pitch's replies have the "
                                            "identifier 0, which switches CANopen nodes; expected a `reply_id`"));
  replace("leg: {protocol: mit,", "leg: {protocol: mit, reply_id: 5,");
  EXPECT_THAT(refusal(), testing::HasSubstr("have the identifier 5, which commands a drive"));
  replace("reply_id: 5", "reply_id: 126");
  EXPECT_EQ(refusal(), "taken");
  const DriveSetup setup = load_drives(model::load_robot(folder_));
  const auto& settings = *drives::as_cia402(setup.buses[0].motors[3].drive);
  EXPECT_EQ(settings.mode, drives::Cia402Mode::kTorque);
  EXPECT_EQ(settings.temperature_index, 0x2030);
  EXPECT_TRUE(setup.buses[0].has_canopen());
  EXPECT_FALSE(setup.buses[1].has_canopen());
  replace("torque_Nm: 120", "torque_Nm: 119");
  EXPECT_THAT(refusal(), testing::HasSubstr("covers a torque_Nm of 119 and left_knee's effort needs 120"));
  replace("torque_Nm: 119", "torque_Nm: 120");
  replace("rated_torque_Nm: 40", "rated_torque_Nm: 3");
  EXPECT_THAT(refusal(), testing::HasSubstr("32.767 times rated_torque_Nm"));
  replace("rated_torque_Nm: 3", "rated_torque_Nm: 40");
  replace("mode: torque", "kp_Nm_per_rad: 700, kd_Nm_s_per_rad: 15, mode: position");
  EXPECT_THAT(refusal(), testing::HasSubstr("closes its position loop with kp 700 and kd 15; left_knee's gains are 700 "
                                            "and 16 at the motor; expected the drive's own gains, or `mode: torque`"));
  replace("kd_Nm_s_per_rad: 15", "kd_Nm_s_per_rad: 16");
  EXPECT_EQ(refusal(), "taken");
  replace("node: 4, drive: knee", "node: 127, drive: knee");
  EXPECT_THAT(refusal(), testing::HasSubstr("left_knee's node is 127; expected nodes up to 126"));
  replace("node: 127, drive: knee", "node: 4, drive: knee");
  replace("can0: {bitrate: 1000000}", "can0: {bitrate: 1000000, data_bitrate: 5000000}");
  EXPECT_THAT(refusal(), testing::HasSubstr("CAN FD frames, which their controllers take for errors"));
}

TEST_F(DriveSetupFile, EveryBusIsDescribedAndOneHasTheImu) {
  replace(", imu: xsens_can", "");
  EXPECT_THAT(refusal(),
              testing::HasSubstr("buses: 0 buses with drives have the IMU; expected one bus with `imu: xsens_can`"));
  replace("  can4: {bitrate: 1000000}\n", "");
  EXPECT_THAT(refusal(), testing::HasSubstr("'can4' isn't described; expected a bus of `buses`"));
}

TEST_F(DriveSetupFile, AnAnkleOfTwoMotorsHasItsLinkageAndItsMotorsNeeds) {
  const std::string ankle =
      "linkages:\n"
      "  - joints: [left_ankle_pitch, left_ankle_roll]\n"
      "    motors:\n"
      "      - {crank_centre_m: [0, 0.035, 0.20], axis: [0, 1, 0], crank_end_m: [-0.05, 0.035, 0.20], rod_end_m: "
      "[-0.05, 0.035, -0.01]}\n"
      "      - {crank_centre_m: [0, -0.035, 0.28], axis: [0, 1, 0], crank_end_m: [-0.05, -0.035, 0.28], rod_end_m: "
      "[-0.05, -0.035, -0.01]}\n";
  text_ += ankle;
  EXPECT_THAT(refusal(),
              testing::HasSubstr(
                  "the drive 'leg' covers a velocity_rad_s of 30 and left_ankle_pitch's speed limit needs 48.5"));
  replace("position_rad: 6.3, velocity_rad_s: 30, torque_Nm: 160",
          "position_rad: 6.3, velocity_rad_s: 60, torque_Nm: 300");
  EXPECT_EQ(refusal(), "taken");
  const DriveSetup setup = load_drives(model::load_robot(folder_));
  ASSERT_EQ(setup.buses[0].parallel.size(), 1u);
  EXPECT_EQ(setup.buses[0].parallel[0].motors, (std::array<std::size_t, 2>{4, 5}));
  EXPECT_NE(setup.buses[0].motors[4].limits.torque_Nm, test::z1().joints[4].effort_limit_Nm)
      << "its crank's, not the joint's";
  replace("crank_end_m: [-0.05, 0.035, 0.20]", "crank_end_m: [0, 0.035, 0.15]");
  EXPECT_THAT(refusal(), testing::ContainsRegex("linkages.*motors: at joint angles .* expected"));
  replace("joints: [left_ankle_pitch, left_ankle_roll]", "joints: [left_ankle_pitch, right_ankle_roll]");
  EXPECT_THAT(refusal(), testing::HasSubstr("their drives are on two buses; expected one bus"));
}

}  // namespace
}  // namespace pmg::can
