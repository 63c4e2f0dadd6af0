// The whole controller walks with MuJoCo behind emulated drives, all of the MIT protocol.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numbers>

#include "can/fault_rows.hpp"
#include "can/linked_drives.hpp"
#include "can/robot_stage.hpp"
#include "can/tour_check.hpp"

namespace pmg::sil {
namespace {

using drives::DriveFault;

/// Walks and counts every frame of every bus.
void walk_and_count(Stage& stage, double walk_s) {
  const Scenario scenario = walking(2.0, walk_s);
  const RunOutcome outcome = stage.run(scenario);
  EXPECT_FALSE(outcome.fell);
  EXPECT_TRUE(outcome.faults.empty());
  EXPECT_LT(outcome.tracking.lin_vel_mae_m_s, 0.3);
  std::uint64_t sent = 0, received = 0;
  can::CanHal& hal = stage.robot->hal();
  model::RobotState last;
  hal.receive(last);  // answers that were under way
  for (std::size_t b = 0; b < stage.setup.buses.size(); ++b) {
    sent += hal.link(b).counts().sent;
    received += hal.link(b).counts().received;
    EXPECT_EQ(hal.link(b).counts().not_sent, 0u);
    for (std::size_t m = 0; m < stage.setup.buses[b].motors.size(); ++m)
      EXPECT_EQ(hal.motor(b, m).lost() + hal.motor(b, m).uncalled(), 0u);
  }
  const auto cycles = static_cast<std::uint64_t>(stage.robot->cycles);
  EXPECT_EQ(sent, 31 * cycles);
  EXPECT_EQ(received, (31 + 3) * cycles) << "31 replies and the IMU's three frames";
}

TEST(CanRobot, ItWalksBehindEmulatedDrivesAndEveryFrameIsAnswered) {
  Stage stage(1, true);
  walk_and_count(stage, 4.0);
}

/// Both ankles have two motors each in the shank, which turn pitch and roll together.
struct LinkedStage : StageOf<test::EmulatedRobot> {
  explicit LinkedStage(std::uint64_t seed) : StageOf(seed, can::limits()) {
    setup = can::load_drives(loaded.robot);
    test::link_pair(setup, loaded.robot, "left_ankle_pitch", "left_ankle_roll", -0.25);
    test::link_pair(setup, loaded.robot, "right_ankle_pitch", "right_ankle_roll", -0.25);
    auto [host, far] = test::link_pairs<test::MemoryLink>(setup.buses.size());
    robot.emplace(setup, loaded.robot, *world, std::move(host), std::move(far));
  }
};

TEST(LinkedRobot, ItWalksOnAnklesOfTwoMotorsEach) {
  LinkedStage stage(1);
  const RunOutcome outcome = stage.run(walking(2.0, 4.0));
  EXPECT_FALSE(outcome.fell);
  EXPECT_TRUE(outcome.faults.empty());
  fmt::print("{}\n", line("linked", outcome.tracking));
  EXPECT_LT(outcome.tracking.lin_vel_mae_m_s, 0.3);
}

// Campaign: 31 motors at 500 Hz for a minute, and what the bus thread's part of it costs.
TEST(CanRobot, DISABLED_AMinuteLosesNoFrame) {
  Stage stage(1, true);
  std::vector<std::int64_t>& costs_ns = stage.robot->costs_ns;
  costs_ns.reserve(40'000);
  walk_and_count(stage, 58.0);
  std::ranges::sort(costs_ns);
  const auto quantile_us = [&](double share) {
    return 1e-3 *
           static_cast<double>(costs_ns[static_cast<std::size_t>(share * static_cast<double>(costs_ns.size() - 1))]);
  };
  fmt::print("{} cycles; sending and receiving: p50 {:.1f} us, p99 {:.1f} us\n", costs_ns.size(), quantile_us(0.5),
             quantile_us(0.99));
}

// Campaigns of docs/reference/safety.md: minutes. --gtest_also_run_disabled_tests
TEST(CanRobot, DISABLED_TheTourIsTrackedAsInProcess) { expect_the_tour_tracked_as_in_process<Stage>(); }
TEST(CanRobot, DISABLED_TheTourWithDrivesOfBothProtocolsIsTrackedAsInProcess) {
  expect_the_tour_tracked_as_in_process<Stage>(true);
}

test::DriveEmulator& knee(Stage& stage) { return stage.robot->drives().drive(0, 3); }
test::DriveEmulator& right_hip(Stage& stage) { return stage.robot->drives().drive(1, 0); }

constexpr std::array kMitRows = {
    FaultRow{.name = "silent motor",
             .inject = [](Stage& s) { knee(s).silent = true; },
             .least = 6,
             .most = 10,
             .deaf = [](std::size_t bus, std::size_t motor) { return bus == 0 && motor == 3; }},
    FaultRow{.name = "wrong id", .inject = [](Stage& s) { knee(s).node = 99; }, .least = 6, .most = 10},
    FaultRow{.name = "two motors of one id", .inject = [](Stage& s) { knee(s).twice = true; }, .least = 3, .most = 7},
    FaultRow{.name = "lost turn", .inject = [](Stage& s) { knee(s).turn_rad = 0.7; }, .least = 3, .most = 7},
    FaultRow{.name = "over-temperature in the drive",
             .inject = [](Stage& s) { knee(s).fault = DriveFault::kOverTemperature; },
             .least = 1,
             .most = 5},
    FaultRow{.name = "under-voltage",
             .inject = [](Stage& s) { right_hip(s).fault = DriveFault::kUnderVoltage; },
             .least = 1,
             .most = 5},
    FaultRow{.name = "over-voltage",
             .inject = [](Stage& s) { right_hip(s).fault = DriveFault::kOverVoltage; },
             .least = 1,
             .most = 5},
    FaultRow{.name = "hot motor",
             .inject = [](Stage& s) { knee(s).temperature_degC = 95.0; },
             .least = 1,
             .most = 5,
             .code = faults::FaultCode::kTemperature,
             .sits_down = true},
    FaultRow{
        .name = "silent IMU", .inject = [](Stage& s) { s.robot->drives().imu_silent = true; }, .least = 11, .most = 15},
};

bool on_the_first_bus(std::size_t bus, std::size_t) { return bus == 0; }

/// The other rows for MIT drives, at one moment each.
constexpr std::array kMoreMitRows = {
    FaultRow{.name = "frozen encoder",
             .inject =
                 [](Stage& s) {
                   model::RobotState now;
                   s.world->read(now);
                   const drives::MotorSetup& motor = knee(s).setup();
                   knee(s).stuck_q =
                       motor.transmission.to_motor(drives::MotorReading{.q_rad = now.q[motor.index]}).q_rad;
                 },
             .least = 1,
             .most = 5,
             .from_loss = true},
    FaultRow{.name = "wrapped turn",
             .inject = [](Stage& s) { knee(s).turn_rad = -2.0 * std::numbers::pi; },
             .least = 3,
             .most = 7},
    FaultRow{.name = "encoder fault",
             .inject = [](Stage& s) { knee(s).fault = DriveFault::kEncoder; },
             .least = 1,
             .most = 5},
    FaultRow{.name = "a fault that the protocol doesn't name",
             .inject = [](Stage& s) { right_hip(s).fault = DriveFault::kOther; },
             .least = 1,
             .most = 5},
    FaultRow{
        .name = "old states", .inject = [](Stage& s) { s.robot->drives().late_cycles = 2; }, .least = 10, .most = 14},
};
/// Those that an end of a bus in memory brings about.
constexpr std::array kWireRows = {
    FaultRow{.name = "cable out",
             .inject = [](Stage& s) { s.wires[0]->cut = true; },
             .least = 6,
             .most = 10,
             .deaf = on_the_first_bus},
    FaultRow{.name = "bus-off",
             .inject =
                 [](Stage& s) {
                   s.wires[0]->state = can::BusHealth::kOff;
                   s.wires[0]->cut = true;
                 },
             .least = 1,
             .most = 5,
             .deaf = on_the_first_bus},
};

void lean(Stage& stage, double angle_rad, const Eigen::Vector3d& axis) {
  stage.robot->drives().imu_lean = Eigen::AngleAxisd(angle_rad, axis);
}
const drives::MotorLimits& knee_limits(Stage& stage) { return knee(stage).setup().limits; }

/// Rows of the general fault table whose cause a drive, the IMU, the policy or the control thread brings. The others
/// are decided before a bus is used (test/control/fault_injection_test.cpp), and no bus can say that a number is none.
constexpr std::array kTableRows = {
    FaultRow{.name = "control thread frozen",
             .inject = [](Stage& s) { s.control_frozen = true; },
             .least = 5,  // the last command is up to four cycles old
             .most = 9,
             .code = faults::FaultCode::kNone},
    FaultRow{.name = "stale policy",
             .inject = [](Stage& s) { s.policy->how = BreakingPolicy::Break::kLate; },
             .least = 11,
             .most = 15,
             .code = faults::FaultCode::kStalePolicy,
             .sits_down = true},
    FaultRow{.name = "joint beyond its range",
             .inject = [](Stage& s) { s.robot->drives().drive(0, 5).drift_rad = 0.05; },
             .least = 11,
             .most = 15 + 12,  // the ankle's roll has up to 0.6 rad to go until it is 0.1 rad beyond
             .code = faults::FaultCode::kJointLimit},
    FaultRow{.name = "joint too fast",
             .inject = [](Stage& s) { knee(s).speed_rad_s = 1.7 * knee_limits(s).dq_rad_s; },
             .least = 11,
             .most = 15,
             .code = faults::FaultCode::kJointVelocity},
    FaultRow{.name = "torque too large",
             .inject = [](Stage& s) { right_hip(s).torque_Nm = 1.3 * right_hip(s).setup().limits.torque_Nm; },
             .least = 11,
             .most = 15,
             .code = faults::FaultCode::kJointTorque,
             .sits_down = true},
    FaultRow{.name = "tilt",
             .inject = [](Stage& s) { lean(s, 1.2, Eigen::Vector3d::UnitX()); },
             .least = 11,
             .most = 15,
             .code = faults::FaultCode::kTilt},
    FaultRow{.name = "torso attitude",
             .inject = [](Stage& s) { lean(s, 0.8, Eigen::Vector3d::UnitY()); },
             .least = 11,
             .most = 15,
             .code = faults::FaultCode::kTorsoAttitude},
    FaultRow{.name = "policy is not finite",
             .inject = [](Stage& s) { s.policy->how = BreakingPolicy::Break::kNotANumber; },
             .least = 1,
             .most = 5,
             .code = faults::FaultCode::kPolicyNotFinite,
             .sits_down = true},
    FaultRow{.name = "action out of range",
             .inject = [](Stage& s) { s.policy->how = BreakingPolicy::Break::kFar; },
             .least = 96,
             .most = 100,
             .code = faults::FaultCode::kActionOutOfRange},
};

TEST(CanRobot, EachFaultOfTheGeneralTableActsBehindCanWithinItsCycles) {
  expect_reactions(std::span<const FaultRow>(kTableRows), 1, true);
}

TEST(CanRobot, EachFaultDampsEveryDriveOrBeginsTheSitDownWithinItsCycles) {
  expect_reactions(std::span<const FaultRow>(kMitRows), over_sockets() ? 1 : 5, true);
  expect_reactions(std::span<const FaultRow>(kMoreMitRows), 1, true);
  if (!over_sockets()) expect_reactions(std::span<const FaultRow>(kWireRows), 1, true);
}

TEST(CanRobot, AKilledHostIsHeldByTheDrivesOwnWatchdogs) {
  constexpr std::array kRows = {FaultRow{.name = "killed host",
                                         .inject = [](Stage& s) { s.robot->frozen = true; },
                                         .code = faults::FaultCode::kStaleState,
                                         .deaf = [](std::size_t, std::size_t) { return true; }}};
  expect_reactions(std::span<const FaultRow>(kRows), 1, true);
}

}  // namespace
}  // namespace pmg::sil
