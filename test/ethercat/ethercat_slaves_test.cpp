// Slaves beside bridges: Z1's leg drives as CiA 402 slaves, an IMU in process data, distributed clocks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drive_protocols/canopen_drive.hpp"
#include "ethercat/lockstep_cable.hpp"
#include "generator_core/allocation_count.hpp"

namespace pmg::ethercat {
namespace {

using hal::BusStatus;
using testing::AllOf;
using testing::HasSubstr;

class DriveSlaves : public testing::Test, protected test::LockstepCable {
 protected:
  DriveSlaves() : LockstepCable({.leg_drives = true, .imu = true}) {}
  test::Cia402Emulator& knee() { return cabled.drives->cia402(0, 3); }
  test::EmulatedSlave& slave_of_knee() { return *cabled.wire.slaves[3]; }
};

TEST_F(DriveSlaves, AnswerInTheSameCycleAndGetTheTorqueOfTheLoop) {
  stand();
  truth.q[knee().setup().index] += 0.01;
  truth.dq[knee().setup().index] = 0.1;
  ASSERT_EQ(cycle(standing), BusStatus::kOk) << hal->take_news();
  for (int j = 0; j < truth.q.size(); ++j) {
    const bool late =
        j != knee().setup().index &&
        cabled.setup.buses[0].motors.size() + cabled.setup.buses[1].motors.size() <= static_cast<std::size_t>(j);
    if (!late) {
      EXPECT_NEAR(state.q[j], truth.q[j], 1e-4) << "a count of 65536 a turn; of this cycle " << j;
    }
  }
  const model::Joint& joint = z1().joints[static_cast<std::size_t>(knee().setup().index)];
  const auto& settings = *drives::as_cia402(knee().setup().drive);
  EXPECT_NEAR(acting.tau_ff[knee().setup().index], -0.01 * joint.kp_Nm_per_rad - 0.1 * joint.kd_Nm_s_per_rad,
              1e-3 * settings.rated_torque_Nm + joint.kp_Nm_per_rad * 1e-4 + joint.kd_Nm_s_per_rad * 1e-3)
      << "steps of torque, position and speed";
  EXPECT_EQ(hal->misses(), 0u);
}

TEST_F(DriveSlaves, ACycleDoesNotAllocate) {
  stand();
  cabled.feel(truth);
  const auto before = test::allocation_count();
  hal->exchange(standing, state);
  EXPECT_EQ(test::allocation_count(), before);
}

TEST_F(DriveSlaves, TheirWatchdogIsThatOfTenCyclesAndStopsTheMotor) {
  slave_of_knee().divide_watchdog(9998);
  stand();
  for (const auto& slave : cabled.wire.slaves) {
    if (slave.get() != cabled.imu) {
      EXPECT_EQ(slave->watchdog_us(), 20'000);
    }
  }
  ASSERT_TRUE(knee().enabled());
  for (int k = 0; k < 10; ++k) {  // the last cycle's own 2 ms have passed
    EXPECT_TRUE(knee().enabled()) << k;
    cabled.tick_slaves();
  }
  EXPECT_FALSE(knee().enabled());
  EXPECT_EQ(slave_of_knee().al_status(), 0x14) << "safe-operational with error";
}

TEST_F(DriveSlaves, InputsOfACycleInWhichASlaveGaveNoneAreThatOfNoDrive) {
  stand();
  slave_of_knee().gives_nothing = true;
  EXPECT_EQ(cycle(standing), BusStatus::kStale);
  for (std::size_t m = 0; m < cabled.setup.buses[0].motors.size(); ++m)
    EXPECT_EQ(hal->can().motor(0, m).age_cycles(), 1) << "what the frame brought is the last cycle's";
  slave_of_knee().gives_nothing = false;
  EXPECT_EQ(cycle(standing), BusStatus::kOk) << hal->take_news();
}

TEST_F(DriveSlaves, ADriveThatIsAnotherThanRobotYamlSaysIsRefusedWithObjectAndBothValues) {
  knee().objects.value(0x6076) = 1234;
  EXPECT_THAT(refusal(),
              AllOf(HasSubstr("eth9: slave 4, left_knee (can0, node 4) object 0x6076 (rated torque) is 1.234 Nm"),
                    HasSubstr("expected rated_torque_Nm")));
}

TEST_F(DriveSlaves, ADriveThatSaysNothingOrRefusesIsNamed) {
  knee().silent = true;
  EXPECT_THAT(refusal(), HasSubstr("slave 4, left_knee (can0, node 4) does not answer about object 0x1000"));
  knee().silent = false;
  knee().objects.remove(0x1A00, 3);
  EXPECT_THAT(refusal(), HasSubstr("slave 4, left_knee (can0, node 4) has no object 0x1A00:3"));
}

TEST_F(DriveSlaves, OneWhoseWatchdogCannotBeSetIsRefused) {
  slave_of_knee().keeps_watchdog = true;
  EXPECT_EQ(refusal(), "eth9: slave 4 (Drive) keeps a watchdog of 1000 counts; expected one that can be set to 20 ms");
}

TEST_F(DriveSlaves, AnObjectThatMayNotBeWrittenIsNotTakenForOneThatIsNotThere) {
  knee().objects.add(0x6007, 0, 0, 2, false);
  EXPECT_THAT(refusal(), HasSubstr("left_knee (can0, node 4) refuses object 0x6007 with SDO abort 0x06010002"));
}

/// An emergency, late answers about another object and another subindex, and mail of another protocol that looks like
/// an answer: none is the one that was asked for.
TEST_F(DriveSlaves, OtherMailBeforeAnAnswerIsNotTakenForIt) {
  constexpr std::uint8_t kCoe = 3, kFoe = 4;
  const auto answer = [](std::uint8_t service, std::uint8_t index, std::uint8_t subindex) {
    return std::vector<std::uint8_t>{0, service, 0x43, index, 0x60, subindex, 0x11, 0x22, 0x33, 0x44};
  };
  slave_of_knee().other_mail = {{kCoe, answer(0x10, 0x76, 0)},
                                {kCoe, answer(0x30, 0x75, 0)},
                                {kCoe, answer(0x30, 0x76, 9)},
                                {kFoe, answer(0x30, 0x76, 0)}};
  EXPECT_EQ(refusal(), "connected");
}

TEST_F(DriveSlaves, AFaultOrAPlaceBeyondTheRangeKeepsTheProgramFromStarting) {
  knee().fault = drives::DriveFault::kOverTemperature;
  EXPECT_THAT(refusal(), HasSubstr("left_knee (can0, node 4) reports"));
  knee().fault = drives::DriveFault::kNone;
  slave_of_knee().power_up();
  knee().turn_rad = 4.0;
  EXPECT_THAT(refusal(), HasSubstr("left_knee (can0, node 4) is at"));
}

TEST_F(DriveSlaves, TwoOfThemInAnotherOrderAreRefused) {
  std::swap(cabled.wire.slaves[2], cabled.wire.slaves[3]);
  EXPECT_EQ(refusal(), "eth9: slave 3 (Drive) has alias 0x68; expected 0x67 as in robot.yaml");
}

TEST_F(DriveSlaves, OneThatWasPoweredAnewIsLostUntilTheProgramStartsAgain) {
  stand();
  slave_of_knee().power_up();
  EXPECT_EQ(cycles_until(BusStatus::kLost, standing), 2);
  for (int k = 0; k < 200; ++k) EXPECT_NE(cycle(limp), BusStatus::kOk);
  EXPECT_EQ(slave_of_knee().state(), test::EmulatedSlave::kInit);
  hal.reset();
  stand();
}

TEST_F(DriveSlaves, AFaultOfOneIsLostAtOnce) {
  stand();
  knee().fault = drives::DriveFault::kUnderVoltage;
  EXPECT_EQ(cycles_until(BusStatus::kLost, standing), 1);
  EXPECT_THAT(hal->take_news(), HasSubstr("left_knee (can0, node 4) reports"));
}

TEST_F(DriveSlaves, TheImuInProcessDataIsThatOfThisCycle) {
  stand();
  truth.gyro_rad_s = Eigen::Vector3d(0.1, -0.2, 0.3);
  truth.orientation_WI = Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()));
  ASSERT_EQ(cycle(standing), BusStatus::kOk);
  EXPECT_LT((state.gyro_rad_s - truth.gyro_rad_s).norm(), 1e-6) << "32-bit floats";
  EXPECT_LT(state.orientation_WI.angularDistance(truth.orientation_WI), 1e-6);
  EXPECT_LT((state.acceleration_m_s2 - truth.acceleration_m_s2).norm(), 1e-5);
}

TEST_F(DriveSlaves, ASilentImuIsLateInTheSixthCycleAndLostInTheEleventh) {
  stand();
  cabled.imu->silent = true;
  EXPECT_EQ(cycles_until(BusStatus::kStale, standing), ProcessDataImu::kLateCycles + 1);
  EXPECT_EQ(cycles_until(BusStatus::kLost, standing), ProcessDataImu::kSilentCycles - ProcessDataImu::kLateCycles);
  EXPECT_EQ(hal->take_news(), "eth9: the IMU does not speak");
  cabled.imu->silent = false;
  EXPECT_EQ(cycle(standing), BusStatus::kOk);
  EXPECT_EQ(hal->take_news(), "eth9: every slave exchanges process data");
}

TEST_F(DriveSlaves, AnImuThatIsNotSureOfItselfIsRefusedAndThenNotBelieved) {
  cabled.imu->status = 0x0004;
  EXPECT_EQ(refusal(), "eth9: the IMU has status 0x0004; expected 0: self-test passed");
  cabled.imu->status = 0;
  truth.acceleration_m_s2.z() = -9.81;
  EXPECT_THAT(refusal(), HasSubstr("eth9: the IMU: its orientation is 180 degrees off gravity"));
  truth.acceleration_m_s2.z() = 9.81;
  stand();
  cabled.imu->status = 0x0004;
  EXPECT_EQ(cycles_until(BusStatus::kLost, standing), ProcessDataImu::kSilentCycles + 1);
}

TEST_F(DriveSlaves, AnotherSlaveInTheImusPlaceIsRefused) {
  cabled.cable.imu->product_code = 0x9999;
  EXPECT_THAT(refusal(), HasSubstr("slave 16 (IMU) has product code 0x8765; expected 0x9999"));
}

/// Bridges whose clocks run by themselves, each at its own rate, beside the host's simulated clock.
class Clocks : public testing::Test, protected test::LockstepCable {
 protected:
  Clocks() : LockstepCable({.clocks = true}) {
    for (std::size_t i = 0; i < cabled.wire.slaves.size(); ++i) {
      cabled.wire.slaves[i]->own_clock = [this, i] {
        return static_cast<std::int64_t>(static_cast<double>(host_ns_) * (1.0 + 1e-6 * ppm_[i])) +
               static_cast<std::int64_t>(i) * 123'456'789;
      };
    }
  }
  /// As the bus thread does it.
  BusStatus cycle() {
    host_ns_ += Master::kPeriod_ns + hal->phase_shift_ns();
    clock.advance_to(host_ns_);
    return LockstepCable::cycle(standing);
  }
  void begin() {
    connect();
    for (int k = 0; k < 20; ++k) {
      host_ns_ += Master::kPeriod_ns;
      clock.advance_to(host_ns_);
      LockstepCable::cycle(limp);
    }
  }
  std::int64_t host_ns_ = 1'000'000;
  std::array<double, 5> ppm_ = {40.0, -30.0, 0.0, 20.0, -50.0};
};

TEST_F(Clocks, AreSetToOneTimeAndMakeTheirInterrupts) {
  connect();
  for (const auto& slave : cabled.wire.slaves) {
    EXPECT_TRUE(slave->has_sync());
    EXPECT_NEAR(static_cast<double>(slave->system_time_ns()),
                static_cast<double>(cabled.wire.slaves[0]->system_time_ns()), 1e3);
  }
}

TEST_F(Clocks, TheBusThreadIsDrawnToTheirPhase) {
  begin();
  for (int k = 0; k < 2000; ++k) ASSERT_EQ(cycle(), BusStatus::kOk) << k << " " << hal->take_news();
  EXPECT_LT(std::abs(hal->clock_lock().error_ns()), 1'000);
  EXPECT_NEAR(hal->clock_lock().drift_ns(), -2.0 * ppm_[0], 5.0) << "the first is the reference";
  EXPECT_LT(hal->cable().apart_ns, 1'000);
  EXPECT_EQ(hal->misses(), 0u);
}

TEST_F(Clocks, ACycleWithoutAnAnswerMovesNothing) {
  begin();
  for (int k = 0; k < 1000; ++k) ASSERT_EQ(cycle(), BusStatus::kOk) << k;
  const double drift_ns = hal->clock_lock().drift_ns();
  cabled.wire.cut = true;
  EXPECT_EQ(cycle(), BusStatus::kStale);
  EXPECT_EQ(hal->phase_shift_ns(), 0);
  EXPECT_EQ(hal->clock_lock().drift_ns(), drift_ns);
  cabled.wire.cut = false;
  EXPECT_EQ(cycle(), BusStatus::kOk) << hal->take_news();
}

TEST_F(Clocks, OneThatDriftsFromTheOthersIsLostInTheSecondCycleBeyondTheBound) {
  begin();
  for (int k = 0; k < 100; ++k) ASSERT_EQ(cycle(), BusStatus::kOk);
  cabled.wire.slaves[3]->clock_runs_free = true;
  ppm_[3] += 1000.0;  // 2 us a cycle, and 0.3 ms at once: the host's time so far times this
  int lost = -1;
  for (int k = 1; k < 50 && lost < 0; ++k) {
    if (cycle() == BusStatus::kLost) lost = k;
  }
  EXPECT_EQ(lost, 2);
  EXPECT_THAT(hal->take_news(), HasSubstr("us apart"));
}

TEST_F(Clocks, AReferenceThatRunsAwayIsLostWithinThreeSeconds) {
  begin();
  for (int k = 0; k < 600; ++k) ASSERT_EQ(cycle(), BusStatus::kOk);
  for (double& ppm : ppm_) ppm += 1000.0;
  int lost = -1;
  for (int k = 1; k < 1600 && lost < 0; ++k) {
    if (cycle() == BusStatus::kLost) lost = k;
  }
  EXPECT_GT(lost, ClockLock::kSpanCycles);
  EXPECT_LE(lost, 3 * ClockLock::kSpanCycles);
  EXPECT_THAT(hal->take_news(), HasSubstr("runs away"));
}

TEST_F(Clocks, ThatCannotBeBroughtTogetherAreRefused) {
  cabled.wire.slaves[3]->clock_runs_free = true;
  cabled.wire.slaves[3]->own_clock = [now_ns = std::int64_t{0}]() mutable { return now_ns += 100'000; };
  EXPECT_THAT(refusal(), HasSubstr("the slaves' clocks stay"));
}

}  // namespace
}  // namespace pmg::ethercat
