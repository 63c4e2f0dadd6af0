// A robot whose drives speak each dialect: roll call, bus cycle and faults are the same.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "can/bus_ids.hpp"
#include "can/roll_call.hpp"
#include "can/still_robot.hpp"
#include "drive_protocols/mit_drive.hpp"
#include "files/config_error.hpp"
#include "model/temporary_copy.hpp"

namespace pmg::can {
namespace {

using hal::BusStatus;

/// Z1 whose legs' and arms' drives speak this, as robot.yaml has it.
DriveSetup z1_speaking(const std::string& leg, const std::string& arm) {
  const model::TemporaryCopy copy(test::kZ1Folder);
  copy.replace("robot.yaml", "leg: {protocol: mit,", "leg: {protocol: " + leg + ",");
  copy.replace("robot.yaml", "arm: {protocol: mit,", "arm: {protocol: " + arm + ",");
  return load_drives(model::load_robot(copy.directory()));
}

class Dialect : public testing::TestWithParam<const char*>, protected test::StillRobot {
 protected:
  Dialect() : StillRobot(z1_speaking(GetParam(), GetParam())) {
    clock_.advance_to(1'000'000);  // a first cycle at zero begins no pause
  }
  std::vector<std::string> scan(OtherFrames* others = nullptr) {
    return problems(setup_.buses[0], ask_bus(setup_.buses[0], *host_[0], wait_, {}, others));
  }
  test::DriveEmulator& knee() { return drives_->drive(0, 3); }
  bool is(const char* name) const { return std::string(GetParam()) == name; }
};

TEST_P(Dialect, ItsDrivesAreCalledSwitchedOnReadAndDriven) {
  EXPECT_NO_THROW(check_ids(setup_));
  OtherFrames others;
  EXPECT_THAT(scan(&others), testing::IsEmpty());
  EXPECT_THAT(others.lines(setup_.buses[0]), testing::IsEmpty());
  connect();
  EXPECT_EQ(cycle(standing_), BusStatus::kLost);
  EXPECT_EQ(trouble(), "left_hip_pitch (can0, node 1) is not enabled") << "never under stiffness";
  cycle(limp());
  for (int k = 0; k < 5; ++k) ASSERT_EQ(cycle(standing_), BusStatus::kOk) << trouble();
  for (int j = 0; j < truth_.q.size(); ++j) {
    EXPECT_NEAR(state_.q[j], truth_.q[j], 12.6 / 65535 / 2 + 1e-12);
    EXPECT_NEAR(state_.temperature_degC[j], is("mini_cheetah") ? 0.0 : 35.0, 1e-9);
    EXPECT_NEAR(acting_.q[j], standing_.q[j], 12.6 / 65535);
    EXPECT_NEAR(acting_.kp[j], standing_.kp[j], 1000.0 / 4095);
  }
  EXPECT_EQ(hal_->strangers() + hal_->unreadable(), 0u);
}

TEST_P(Dialect, AFaultIsNamedWhereItsRepliesTellOne) {
  connect();
  cycle(limp());
  ASSERT_EQ(cycle(standing_), BusStatus::kOk) << trouble();
  knee().fault = drives::DriveFault::kOverCurrent;
  const bool tells = is("mit") || is("damiao");
  EXPECT_EQ(cycle(standing_), tells ? BusStatus::kLost : BusStatus::kOk);
  if (!tells) return;
  EXPECT_EQ(trouble(), "left_knee (can0, node 4) reports over-current");
  for (int k = 0; k < 300; ++k) cycle(standing_);
  EXPECT_EQ(knee().fault, drives::DriveFault::kOverCurrent) << "nothing is cleared while the robot is stiff";
  knee().fault_passed = is("damiao");
  if (is("mit")) knee().fault = drives::DriveFault::kNone;
  for (int k = 0; k < 4; ++k) cycle(limp());
  EXPECT_EQ(cycle(standing_), BusStatus::kOk) << trouble();
}

// A computer that fell silent leaves such drives in a fault: the next start must not need their power switch.
TEST_P(Dialect, AfterASilenceOfThisComputerTheDrivesAreHadAgain) {
  connect();
  cycle(limp());
  ASSERT_EQ(cycle(standing_), BusStatus::kOk) << trouble();
  for (int k = 0; k < 30; ++k) drives_->tick(acting_);
  EXPECT_TRUE(knee().tripped());
  clock_.advance_to(clock_.now_ns() + drives::RobotDrives::kPause_ns + 1);
  EXPECT_EQ(cycle(standing_), BusStatus::kLost) << "they let go, and the robot is told to be stiff";
  for (int k = 0; k < 4; ++k) cycle(limp());
  EXPECT_EQ(cycle(standing_), BusStatus::kOk) << trouble();
}

TEST_P(Dialect, ARollCallAfterASilenceFindsNoFault) {
  drives_->drive(0, 3).fault = is("damiao") ? drives::DriveFault::kCommunication : drives::DriveFault::kNone;
  drives_->drive(0, 3).fault_passed = true;
  EXPECT_THAT(scan(), testing::IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Each, Dialect, testing::Values("mit", "damiao", "mini_cheetah", "robstride"),
                         [](const auto& which) { return std::string(which.param); });

TEST(Dialects, TwoOnOneReplyIdentifierAreRefusedAndNodesThatADaMiaoCantName) {
  const model::TemporaryCopy copy(test::kZ1Folder);
  copy.replace("robot.yaml", "  arm: {",
               "  knee: {protocol: damiao, position_rad: 6.3, velocity_rad_s: 30, torque_Nm: 160, kp_Nm_per_rad: 1000, "
               "kd_Nm_s_per_rad: 50}\n  arm: {");
  copy.replace("robot.yaml", "node: 4, drive: leg", "node: 4, drive: knee");
  try {
    check_ids(load_drives(model::load_robot(copy.directory())));
    ADD_FAILURE() << "a CubeMars of node 20 and an enabled DaMiao of node 4 would say the same";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("replies have the identifier 0x0; expected one sender"));
  }
  copy.replace("robot.yaml", "node: 4, drive: knee", "node: 4, reply_id: 0x70, drive: knee");
  EXPECT_NO_THROW(check_ids(load_drives(model::load_robot(copy.directory()))));
  copy.replace("robot.yaml", "node: 4, reply_id: 0x70", "node: 16, reply_id: 0x70");
  try {
    load_drives(model::load_robot(copy.directory()));
    ADD_FAILURE() << "node 16";
  } catch (const files::ConfigError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("joints.left_knee.bus: node is 16; expected 1 to 15"));
  }
}

}  // namespace
}  // namespace pmg::can
