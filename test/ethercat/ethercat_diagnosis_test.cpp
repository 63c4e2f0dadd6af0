// The controller's tick plays its excitation on a robot behind emulated EtherCAT slaves. The diagnosis names what is
// hidden in the robot, and takes nothing of slaves and cable for the robot's own.
#include <gtest/gtest.h>

#include "can/can_backend.hpp"
#include "can/command_delay.hpp"
#include "ethercat/emulated_robot.hpp"
#include "ethercat/ethercat_backend.hpp"
#include "model/constants.hpp"
#include "robot_diagnosis/played_excitation.hpp"
#include "robot_diagnosis/robot_diagnosis.hpp"
#include "robot_diagnosis/robot_report.hpp"
#include "robot_diagnosis/rubbing_joint.hpp"
#include "temporary_folder.hpp"

namespace pmg::robot_diagnosis {
namespace {

/// The legs' drives are slaves themselves, in torque mode, and so is the IMU.
constexpr test::CableForm kBridges{}, kSlaves = {.leg_drives = true, .imu = true, .clocks = false};
constexpr std::size_t kArm = 2;  // a bus of bridged drives in both

RobotDiagnosis diagnosed(const test::CableForm& form, const sim::ActuatorsByJoint& motors) {
  const test::TemporaryFolder folder;
  sim::World world(z1(), world_to_excite("hanging", motors));
  test::EthercatRobot robot(z1(), world, form);
  const PlayedExcitation played = play_excitation("hanging",
                                                  {.bus = robot,
                                                   .world = world,
                                                   .backend = "ethercat",
                                                   .limits = can::limits(),
                                                   .description = ethercat::description(robot.cabled().setup)},
                                                  folder.path());
  EXPECT_TRUE(played.whole) << played.told;
  return diagnose_robot(z1(), read_robot_logs({played.log}, z1()));
}

TEST(DiagnosisOverEthercat, ACommandActsSoLongAfterItsStateAsTheBackendSays) {
  for (const test::CableForm& form : {kBridges, kSlaves}) {
    sim::World world(z1(), world_to_excite("hanging", {}));
    test::EthercatRobot robot(z1(), world, form);
    const can::DriveSetup& setup = robot.cabled().setup;
    const int cycles = test::command_delay_cycles(robot, world, test::joints_of(setup.buses[kArm]));
    const hal::BackendDescription said = ethercat::description(setup);
    EXPECT_EQ(cycles * model::kBusPeriod_s, *said.command_delay_s + said.older_by_s) << form.leg_drives;
    EXPECT_EQ(said.older_by_s > 0.0, form.leg_drives) << "of arms beside legs";
    EXPECT_EQ(said.closed_by_bus.size(), form.leg_drives ? 12U : 0U);
    EXPECT_EQ(said.older_joints.size(), form.leg_drives ? 19U : 0U);
    EXPECT_FALSE(said.older_imu);
  }
}

TEST(DiagnosisOverEthercat, OnlyTheJointThatRubsIsNamedBehindBridges) {
  expect_only_friction(diagnosed(kBridges, rubbing_elbow()), "left_elbow");
}

TEST(DiagnosisOverEthercat, NothingIsNamedOfAHealthyRobotWhoseLegDrivesAndImuAreSlaves) {
  const RobotDiagnosis found = diagnosed(kSlaves, {});
  EXPECT_EQ(found.verdict, evidence::Verdict::kNone) << robot_diagnosis_text(found);
}

}  // namespace
}  // namespace pmg::robot_diagnosis
