// The whole controller walks with MuJoCo behind emulated EtherCAT slaves.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>

#include "can/fault_rows.hpp"
#include "can/tour_check.hpp"
#include "ethercat/emulated_robot.hpp"

namespace pmg::sil {
namespace {

using drives::DriveFault;

struct EthercatStage : StageOf<test::EthercatRobot> {
  explicit EthercatStage(std::uint64_t seed, bool over_ethercat, const test::CableForm& form = {})
      : StageOf(seed, over_ethercat ? std::optional(can::limits()) : std::nullopt) {
    if (!over_ethercat) return;
    robot.emplace(loaded.robot, *world, form);
    setup = robot->cabled().setup;
  }
};
/// The legs' drives are slaves themselves, in torque mode, and so is the IMU.
constexpr test::CableForm kSlaves = {.leg_drives = true, .imu = true, .clocks = false};

TEST(EthercatRobot, ItWalksBehindEmulatedBridgesAndEveryFrameIsAnswered) {
  EthercatStage stage(1, true);
  const RunOutcome outcome = stage.run(walking(2.0, 4.0));
  EXPECT_FALSE(outcome.fell);
  EXPECT_TRUE(outcome.faults.empty());
  EXPECT_LT(outcome.tracking.lin_vel_mae_m_s, 0.3);
  EXPECT_EQ(stage.robot->hal().misses(), 0u) << stage.robot->hal().take_news();
  const auto cycles = static_cast<std::uint64_t>(stage.robot->cycles);
  std::uint64_t received = 0;
  for (std::size_t b = 0; b < stage.setup.buses.size(); ++b) {
    const can::CanHal& can = stage.robot->hal().can();
    EXPECT_EQ(can.link(b).counts().not_sent, 0u);
    received += can.link(b).counts().received;
    for (std::size_t m = 0; m < stage.setup.buses[b].motors.size(); ++m)
      EXPECT_EQ(can.motor(b, m).lost() + can.motor(b, m).uncalled(), 0u);
  }
  EXPECT_GE(received, (31 + 3) * (cycles - 1)) << "31 answers and the IMU's three frames, the last cycle's under way";
}

TEST(EthercatRobot, ItWalksOnLegDrivesAndAnImuThatAreSlaves) {
  EthercatStage stage(1, true, kSlaves);
  const RunOutcome outcome = stage.run(walking(2.0, 4.0));
  EXPECT_FALSE(outcome.fell);
  EXPECT_TRUE(outcome.faults.empty());
  EXPECT_LT(outcome.tracking.lin_vel_mae_m_s, 0.3);
  EXPECT_EQ(stage.robot->hal().misses(), 0u) << stage.robot->hal().take_news();
}

// Campaigns of docs/reference/safety.md: minutes. --gtest_also_run_disabled_tests
TEST(EthercatRobot, DISABLED_TheTourIsTrackedAsInProcess) { expect_the_tour_tracked_as_in_process<EthercatStage>(); }
TEST(EthercatRobot, DISABLED_TheTourOnSlavesIsTrackedAsInProcess) {
  expect_the_tour_tracked_as_in_process<EthercatStage>(kSlaves);
}

using Row = FaultRowOf<EthercatStage>;
test::DriveEmulator& knee(EthercatStage& stage) { return stage.robot->drives().drive(0, 3); }
test::DriveEmulator& right_hip(EthercatStage& stage) { return stage.robot->drives().drive(1, 0); }
test::EmulatedBridge& third(EthercatStage& stage) { return stage.robot->cabled().bridge(2); }
bool all(std::size_t, std::size_t) { return true; }
bool on_third(std::size_t bus, std::size_t) { return bus == 2; }

// Of the drives, all as over CAN and one cycle later: their answers come a cycle later. Of the cable: lost in the
// second cycle, and the control thread's tick is up to four cycles away. Where commands no longer come, the drives' own
// watchdogs damp them, in the tenth cycle.
constexpr std::array kRows = {
    Row{.name = "silent motor",
        .inject = [](EthercatStage& s) { knee(s).silent = true; },
        .least = 6,
        .most = 11,
        .deaf = [](std::size_t bus, std::size_t motor) { return bus == 0 && motor == 3; }},
    Row{.name = "wrong id", .inject = [](EthercatStage& s) { knee(s).node = 99; }, .least = 6, .most = 11},
    // Answers are a cycle late, so the first one too many passes for the next command's.
    Row{.name = "two motors of one id",
        .inject = [](EthercatStage& s) { knee(s).twice = true; },
        .least = 5,
        .most = 9},
    Row{.name = "lost turn", .inject = [](EthercatStage& s) { knee(s).turn_rad = 0.7; }, .least = 3, .most = 8},
    Row{.name = "frozen encoder",
        .inject =
            [](EthercatStage& s) {
              model::RobotState now;
              s.world->read(now);
              test::DriveEmulator& drive = knee(s);
              drive.stuck_q =
                  drive.setup().transmission.to_motor(drives::MotorReading{.q_rad = now.q[drive.setup().index]}).q_rad;
            },
        .least = 1,
        .most = 5,
        .from_loss = true},
    Row{.name = "over-temperature in the drive",
        .inject = [](EthercatStage& s) { knee(s).fault = DriveFault::kOverTemperature; },
        .least = 1,
        .most = 6},
    Row{.name = "under-voltage",
        .inject = [](EthercatStage& s) { right_hip(s).fault = DriveFault::kUnderVoltage; },
        .least = 1,
        .most = 6},
    Row{.name = "over-voltage",
        .inject = [](EthercatStage& s) { right_hip(s).fault = DriveFault::kOverVoltage; },
        .least = 1,
        .most = 6},
    Row{.name = "hot motor",
        .inject = [](EthercatStage& s) { knee(s).temperature_degC = 95.0; },
        .least = 1,
        .most = 6,
        .code = faults::FaultCode::kTemperature,
        .sits_down = true},
    Row{.name = "silent IMU",
        .inject = [](EthercatStage& s) { s.robot->drives().imu_silent = true; },
        .least = 11,
        .most = 16},
    Row{.name = "control thread frozen",
        .inject = [](EthercatStage& s) { s.control_frozen = true; },
        .least = 6,
        .most = 10,
        .code = faults::FaultCode::kNone},
    Row{.name = "killed host",
        .inject = [](EthercatStage& s) { s.robot->frozen = true; },
        .code = faults::FaultCode::kStaleState,
        .deaf = all},
    Row{.name = "cable cut", .inject = [](EthercatStage& s) { s.robot->cabled().wire.cut = true; }, .deaf = all},
    Row{.name = "bytes spoilt",
        .inject =
            [](EthercatStage& s) {
              s.robot->cabled().wire.spoil = [](std::span<std::uint8_t> frame) { frame[17] ^= 0x80U; };
            },
        .least = 2,
        .most = 6},
    Row{.name = "bridge's CAN is off", .inject = [](EthercatStage& s) { third(s).health = 2; }, .least = 1, .most = 6},
    Row{.name = "slave without power",
        .inject = [](EthercatStage& s) { third(s).dead = true; },
        .least = 2,
        .most = 6,
        .deaf = on_third},
    Row{.name = "slave reset",
        .inject = [](EthercatStage& s) { third(s).power_up(); },
        .least = 2,
        .most = 6,
        .deaf = on_third},
    Row{.name = "slave takes nothing",
        .inject = [](EthercatStage& s) { third(s).takes_nothing = true; },
        .least = 2,
        .most = 6,
        .deaf = on_third},
    Row{.name = "slave gives nothing",
        .inject = [](EthercatStage& s) { third(s).gives_nothing = true; },
        .least = 2,
        .most = 6},
    Row{.name = "a slave too many",
        .inject =
            [](EthercatStage& s) {
              auto& slaves = s.robot->cabled().wire.slaves;
              slaves.push_back(std::make_unique<test::EmulatedBridge>(8, 12, test::MemoryLink::pair().first));
              slaves.back()->join(test::EmulatedSlave::kOperational);
            },
        .least = 2,
        .most = 6},
};

TEST(EthercatRobot, EachFaultDampsEveryDriveOrBeginsTheSitDownWithinItsCycles) {
  expect_reactions(std::span<const Row>(kRows), 1, true);
}

// Campaign: each fault at every moment between two ticks. --gtest_also_run_disabled_tests
TEST(EthercatRobot, DISABLED_EachFaultIsReactedToAtEveryMoment) {
  expect_reactions(std::span<const Row>(kRows), 5, true);
}

constexpr std::array kSlaveRows = {
    Row{.name = "fault of a drive that is a slave",
        .inject = [](EthercatStage& s) { knee(s).fault = DriveFault::kUnderVoltage; },
        .least = 1,
        .most = 5},
    Row{.name = "drive that is a slave reset",
        .inject = [](EthercatStage& s) { s.robot->cabled().wire.slaves[3]->power_up(); },
        .least = 2,
        .most = 6,
        .deaf = [](std::size_t bus, std::size_t motor) { return bus == 0 && motor == 3; }},
    Row{.name = "cable to drives that are slaves cut",
        .inject = [](EthercatStage& s) { s.robot->cabled().wire.cut = true; },
        .deaf = all},
    Row{.name = "IMU that is a slave silent",
        .inject = [](EthercatStage& s) { s.robot->cabled().imu->silent = true; },
        .least = 11,
        .most = 15},
    Row{.name = "IMU that is a slave unsure",
        .inject = [](EthercatStage& s) { s.robot->cabled().imu->status = 4; },
        .least = 11,
        .most = 15},
};

TEST(EthercatRobot, FaultsOfSlavesDampEveryDriveWithinTheirCycles) {
  expect_reactions(std::span<const Row>(kSlaveRows), 1, true, kSlaves);
}

}  // namespace
}  // namespace pmg::sil
