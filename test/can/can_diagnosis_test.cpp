// The controller's tick plays its excitations on a robot behind emulated drives. The diagnosis names what is hidden in
// the robot, and takes nothing of drives and bus for the robot's own.
#include <gtest/gtest.h>

#include "can/can_backend.hpp"
#include "can/command_delay.hpp"
#include "can/emulated_robot.hpp"
#include "can/memory_link.hpp"
#include "can/mixed_drives.hpp"
#include "model/constants.hpp"
#include "robot_diagnosis/played_excitation.hpp"
#include "robot_diagnosis/robot_diagnosis.hpp"
#include "robot_diagnosis/robot_report.hpp"
#include "robot_diagnosis/rubbing_joint.hpp"
#include "temporary_folder.hpp"

namespace pmg::robot_diagnosis {
namespace {

/// A world, and the drives and buses before it.
struct RobotOnBuses {
  RobotOnBuses(const can::DriveSetup& setup, const sim::WorldOptions& options)
      : world(z1(), options), links(test::link_pairs<test::MemoryLink>(setup.buses.size())) {
    robot.emplace(setup, z1(), world, std::move(links.first), std::move(links.second));
  }
  sim::World world;
  std::pair<test::Links, test::Links> links;
  std::optional<test::EmulatedRobot> robot;
};

RobotDiagnosis diagnosed(const can::DriveSetup& setup, const sim::ActuatorsByJoint& motors,
                         const std::vector<std::string>& excitations) {
  const test::TemporaryFolder folder;
  std::vector<std::filesystem::path> logs;
  for (const std::string& name : excitations) {
    RobotOnBuses on(setup, world_to_excite(name, motors));
    const PlayedExcitation played = play_excitation(name,
                                                    {.bus = *on.robot,
                                                     .world = on.world,
                                                     .backend = "can",
                                                     .limits = can::limits(),
                                                     .description = can::description(setup)},
                                                    folder.path());
    EXPECT_TRUE(played.whole) << played.told;
    logs.push_back(played.log);
  }
  return diagnose_robot(z1(), read_robot_logs(logs, z1()));
}

TEST(DiagnosisOverCan, ACommandActsSoLongAfterItsStateAsTheBackendSays) {
  for (const bool mixed : {false, true}) {
    const can::DriveSetup setup = mixed ? test::mixed_drives(z1()) : can::load_drives(z1());
    RobotOnBuses on(setup, world_to_excite("hanging", {}));
    const int cycles = test::command_delay_cycles(*on.robot, on.world, test::joints_of(setup.buses[0]));
    EXPECT_EQ(cycles * model::kBusPeriod_s, can::description(setup).command_delay_s) << mixed;
  }
}

// Were the frames' fields rounded alike each time, a wrist at rest would get a torque for ever, as from a wrong zero.
TEST(DiagnosisOverCan, NothingIsNamedBehindMitDrivesOfAHealthyRobot) {
  const RobotDiagnosis found = diagnosed(can::load_drives(z1()), {}, {"hanging", "standing"});
  EXPECT_EQ(found.verdict, evidence::Verdict::kNone) << robot_diagnosis_text(found);
  EXPECT_GT(found.coverage.hanging_s, 35.0);
  EXPECT_GT(found.coverage.standing_s, 40.0);
  EXPECT_NE(found.drive_sampling.find("commands act 2 ms after the states"), std::string::npos) << found.drive_sampling;
}

TEST(DiagnosisOverCan, OnlyTheJointThatRubsIsNamedBehindMitDrives) {
  // As in process.
  expect_only_friction(diagnosed(can::load_drives(z1()), rubbing_elbow(), {"hanging"}), "left_elbow", 0.4, 0.1);
}

// The bus thread closes the loop of this hip roll; the shoulders' drives move with their own gains alone.
TEST(DiagnosisOverCan, OnlyTheJointThatRubsIsNamedBehindDrivesOfBothProtocols) {
  const sim::ActuatorsByJoint motors = rubbing("left_hip_roll", 3.0, 0.3);  // five times its own
  expect_only_friction(diagnosed(test::mixed_drives(z1()), motors, {"hanging"}), "left_hip_roll", 2.4, 0.5);
}

}  // namespace
}  // namespace pmg::robot_diagnosis
