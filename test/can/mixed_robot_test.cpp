// The whole controller walks with MuJoCo behind emulated drives of both protocols and modes: legs and waist partly in
// torque mode, arms partly in position mode, one bus with both protocols. Over memory: its buses have no interfaces.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>

#include "can/fault_rows.hpp"
#include "can/robot_stage.hpp"

namespace pmg::sil {
namespace {

using drives::DriveFault;
using faults::FaultCode;

// Buses and motors of test::mixed_drives.
constexpr std::size_t kLeg = 0, kRightLeg = 2, kArm = 6;
constexpr std::size_t kTorque = 0, kMit = 3;  // motors of kLeg; those of kRightLeg and kArm are of torque and position

test::DriveEmulator& torque(Stage& stage) { return stage.robot->drives().drive(kLeg, kTorque); }
test::DriveEmulator& mit(Stage& stage) { return stage.robot->drives().drive(kLeg, kMit); }
test::DriveEmulator& position(Stage& stage) { return stage.robot->drives().drive(kArm, 0); }
bool in_leg(std::size_t bus, std::size_t) { return bus == kLeg; }
bool in_arm(std::size_t bus, std::size_t) { return bus == kArm; }

constexpr std::array kMixedRows = {
    FaultRow{.name = "silent torque drive",
             .inject = [](Stage& s) { torque(s).silent = true; },
             .least = 6,
             .most = 10,
             .deaf = [](std::size_t bus, std::size_t motor) { return bus == kLeg && motor == kTorque; }},
    FaultRow{.name = "silent position drive",
             .inject = [](Stage& s) { position(s).silent = true; },
             .least = 6,
             .most = 10,
             .deaf = [](std::size_t bus, std::size_t motor) { return bus == kArm && motor == 0; }},
    FaultRow{.name = "silent MIT drive between CANopen ones",
             .inject = [](Stage& s) { mit(s).silent = true; },
             .least = 6,
             .most = 10,
             .deaf = [](std::size_t bus, std::size_t motor) { return bus == kLeg && motor == kMit; }},
    FaultRow{
        .name = "wrong id of a torque drive", .inject = [](Stage& s) { torque(s).node = 99; }, .least = 6, .most = 10},
    FaultRow{.name = "wrong id of a position drive",
             .inject = [](Stage& s) { position(s).node = 99; },
             .least = 6,
             .most = 10},
    FaultRow{.name = "two torque drives of one id",
             .inject = [](Stage& s) { torque(s).twice = true; },
             .least = 3,
             .most = 7},
    FaultRow{.name = "two position drives of one id",
             .inject = [](Stage& s) { position(s).twice = true; },
             .least = 3,
             .most = 7},
    FaultRow{.name = "lost turn of a torque drive",
             .inject = [](Stage& s) { torque(s).turn_rad = 0.7; },
             .least = 3,
             .most = 7},
    FaultRow{.name = "lost turn of a position drive",
             .inject = [](Stage& s) { position(s).turn_rad = 0.7; },
             .least = 3,
             .most = 7},
    FaultRow{.name = "over-temperature in a torque drive",
             .inject = [](Stage& s) { torque(s).fault = DriveFault::kOverTemperature; },
             .least = 1,
             .most = 5},
    FaultRow{.name = "over-temperature in a position drive",
             .inject = [](Stage& s) { position(s).fault = DriveFault::kOverTemperature; },
             .least = 1,
             .most = 5},
    FaultRow{.name = "over-voltage in a torque drive",
             .inject = [](Stage& s) { torque(s).fault = DriveFault::kOverVoltage; },
             .least = 1,
             .most = 5},
    FaultRow{.name = "under-voltage in a position drive",
             .inject = [](Stage& s) { position(s).fault = DriveFault::kUnderVoltage; },
             .least = 1,
             .most = 5},
    FaultRow{.name = "under-voltage in an MIT drive between CANopen ones",
             .inject = [](Stage& s) { mit(s).fault = DriveFault::kUnderVoltage; },
             .least = 1,
             .most = 5},
    FaultRow{.name = "torque drive powered anew",
             .inject = [](Stage& s) { s.robot->drives().cia402(kLeg, kTorque).power_up(); },
             .least = 1,
             .most = 5},
    FaultRow{.name = "position drive powered anew",
             .inject = [](Stage& s) { s.robot->drives().cia402(kArm, 0).power_up(); },
             .least = 1,
             .most = 5},
    FaultRow{.name = "position drive is told other gains",
             .inject =
                 [](Stage& s) {
                   s.robot->meddle = [joint = position(s).setup().index](model::JointCommand& command) {
                     if (joint < command.kp.size()) command.kp[joint] *= 1.01;
                   };
                 },
             .least = 1,
             .most = 5},
    FaultRow{
        .name = "frozen encoder of a torque drive",
        .inject =
            [](Stage& s) {
              model::RobotState now;
              s.world->read(now);
              test::DriveEmulator& drive = torque(s);
              drive.stuck_q =
                  drive.setup().transmission.to_motor(drives::MotorReading{.q_rad = now.q[drive.setup().index]}).q_rad;
            },
        .least = 1,
        .most = 5,
        .from_loss = true},
    FaultRow{.name = "bus-off with both protocols",
             .inject =
                 [](Stage& s) {
                   s.wires[kLeg]->state = can::BusHealth::kOff;
                   s.wires[kLeg]->cut = true;
                 },
             .least = 1,
             .most = 5,
             .deaf = in_leg},
    FaultRow{.name = "cable of a bus with both protocols pulled",
             .inject = [](Stage& s) { s.wires[kLeg]->cut = true; },
             .least = 6,
             .most = 10,
             .deaf = in_leg},
    FaultRow{.name = "cable of an arm's position drives pulled",
             .inject = [](Stage& s) { s.wires[kArm]->cut = true; },
             .least = 6,
             .most = 10,
             .deaf = in_arm},
    FaultRow{.name = "hot motor of a torque drive",
             .inject = [](Stage& s) { s.robot->drives().drive(kRightLeg, 1).temperature_degC = 95.0; },
             .least = 1,
             .most = 5,
             .code = FaultCode::kTemperature,
             .sits_down = true},
    FaultRow{.name = "hot motor of a position drive",
             .inject = [](Stage& s) { position(s).temperature_degC = 95.0; },
             .least = 1,
             .most = 5,
             .code = FaultCode::kTemperature,
             .sits_down = true},
    FaultRow{
        .name = "silent IMU", .inject = [](Stage& s) { s.robot->drives().imu_silent = true; }, .least = 11, .most = 15},
    // The last command is up to four cycles old when the thread freezes.
    FaultRow{.name = "control thread frozen",
             .inject = [](Stage& s) { s.control_frozen = true; },
             .least = 5,
             .most = 9,
             .code = FaultCode::kNone},
    FaultRow{.name = "killed host",
             .inject = [](Stage& s) { s.robot->frozen = true; },
             .code = FaultCode::kStaleState,
             .deaf = [](std::size_t, std::size_t) { return true; }},
};

TEST(MixedRobot, EachFaultDampsEveryDriveOrBeginsTheSitDownWithinItsCycles) {
  if (over_sockets()) GTEST_SKIP() << "its buses have no interfaces";
  expect_reactions(std::span<const FaultRow>(kMixedRows), 1, true, true);
}

// Campaign: each fault at every moment between two ticks. --gtest_also_run_disabled_tests
TEST(MixedRobot, DISABLED_EachFaultIsReactedToAtEveryMoment) {
  expect_reactions(std::span<const FaultRow>(kMixedRows), 5, true, true);
}

TEST(MixedRobot, ItWalksWithDrivesOfBothProtocolsAndModes) {
  if (over_sockets()) GTEST_SKIP() << "its buses have no interfaces";
  Stage stage(1, true, true);
  const RunOutcome outcome = stage.run(walking(2.0, 4.0));
  EXPECT_FALSE(outcome.fell);
  EXPECT_TRUE(outcome.faults.empty());
  EXPECT_LT(outcome.tracking.lin_vel_mae_m_s, 0.3);
  std::uint64_t lost = 0;
  for (std::size_t b = 0; b < stage.setup.buses.size(); ++b) {
    for (std::size_t m = 0; m < stage.setup.buses[b].motors.size(); ++m)
      lost += stage.robot->hal().motor(b, m).lost() + stage.robot->hal().motor(b, m).uncalled();
  }
  EXPECT_EQ(lost, 0u);
  fmt::print("{}\n", line("mixed drives", outcome.tracking));
}

/// One torque drive, one position drive and one MIT drive, given what a test says.
class WhatCountsAsDamping : public testing::Test {
 protected:
  WhatCountsAsDamping() {
    given_.q = given_.dq = given_.kp = given_.kd = given_.tau_ff = JointVector::Zero(test::z1().joint_index.size());
    felt_.q = felt_.dq = given_.q;
    felt_.dq[hip_] = -0.5;
  }
  bool damps(int joint) const { return check_.damps(joint, given_, felt_); }
  can::DriveSetup setup_ = test::mixed_drives(test::z1());
  test::DampingCheck check_{setup_, test::z1()};
  int hip_ = setup_.buses[kLeg].motors[kTorque].index, knee_ = setup_.buses[kLeg].motors[kMit].index;
  double kd_ = test::z1().joints[static_cast<std::size_t>(hip_)].kd_Nm_s_per_rad;
  model::JointCommand given_;
  model::RobotState felt_;
};

TEST_F(WhatCountsAsDamping, ATorqueAgainstTheSpeedWithinKdTimesItOrNone) {
  EXPECT_TRUE(damps(hip_)) << "off";
  given_.tau_ff[hip_] = 0.5 * kd_;
  EXPECT_TRUE(damps(hip_));
  given_.tau_ff[hip_] = 0.5 * kd_ + 0.1;
  EXPECT_FALSE(damps(hip_)) << "more than kd |dq|";
  given_.tau_ff[hip_] = -0.1;
  EXPECT_FALSE(damps(hip_)) << "it drives the motor on";
  felt_.dq[hip_] = 0.0;
  EXPECT_FALSE(damps(hip_)) << "a motor at rest gets no torque";
}

TEST_F(WhatCountsAsDamping, AnMitDriveThatHoldsNoPosition) {
  felt_.dq[knee_] = 2.0;
  given_.kd[knee_] = 16.0;
  given_.tau_ff[knee_] = 0.039;
  EXPECT_TRUE(damps(knee_)) << "zero lies between two codes of the field";
  given_.tau_ff[knee_] = 40.0;
  EXPECT_FALSE(damps(knee_));
  given_.tau_ff[knee_] = 0.0;
  given_.dq[knee_] = 1.0;
  EXPECT_TRUE(damps(knee_));
  given_.dq[knee_] = 3.0;
  EXPECT_FALSE(damps(knee_)) << "it speeds the motor up";
  given_.dq[knee_] = 0.0;
  given_.kp[knee_] = 1.0;
  EXPECT_FALSE(damps(knee_));
}

}  // namespace
}  // namespace pmg::sil
