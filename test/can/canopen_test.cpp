// CiA 402 drives behind CANopen: their set-up, their cycle, and after how many bus cycles a fault is told.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <stdexcept>

#include "can/first_light.hpp"
#include "can/flood.hpp"
#include "can/mixed_drives.hpp"
#include "can/roll_call.hpp"
#include "can/still_robot.hpp"
#include "drive_protocols/canopen_drive.hpp"
#include "generator_core/allocation_count.hpp"

namespace pmg::can {
namespace {

using drives::Cia402Mode;
using drives::DriveFault;
using hal::BusStatus;
using test::MemoryLink;

const can::DriveSetup& mixed() {
  static const can::DriveSetup setup = test::mixed_drives(z1());
  return setup;
}
constexpr std::size_t kLeg = 0, kArm = 6;  // buses: CANopen in torque mode with one MIT drive, CANopen in position mode

class CanopenDrives : public testing::Test, protected test::StillRobot {
 protected:
  CanopenDrives() : StillRobot(mixed()) {}
  void stand() {
    if (!hal_) connect();
    for (int k = 0; k < 8; ++k) cycle(limp());
    for (int k = 0; k < 5; ++k) ASSERT_EQ(cycle(standing_), BusStatus::kOk) << trouble();
  }
  test::Cia402Emulator& hip() { return drives_->cia402(kLeg, 0); }
  test::Cia402Emulator& shoulder() { return drives_->cia402(kArm, 0); }
  int hip_index() const { return mixed().buses[kLeg].motors[0].index; }
  int shoulder_index() const { return mixed().buses[kArm].motors[0].index; }
  std::string refusal() {
    try {
      set_up_nodes(mixed(), links_, wait_, {});
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "taken";
  }
};

TEST_F(CanopenDrives, TheSetUpGivesEveryDriveItsModeItsPdosAndItsWatchdog) {
  auto& objects = hip().objects;
  objects.value(0x605A) = 0;
  connect();
  EXPECT_EQ(objects.value(0x6060), 10u);
  EXPECT_EQ(shoulder().objects.value(0x6060), 8u);
  EXPECT_EQ(objects.value(0x1400, 1), 0x201u);
  EXPECT_EQ(objects.value(0x1400, 2), 255u) << "acts when it comes";
  EXPECT_EQ(objects.value(0x1600, 0), 3u);
  EXPECT_EQ(objects.value(0x1600, 1), 0x60400010u);
  EXPECT_EQ(objects.value(0x1600, 2), 0x607A0020u);
  EXPECT_EQ(objects.value(0x1600, 3), 0x60710010u);
  EXPECT_EQ(objects.value(0x1800, 2), 1u) << "with every SYNC";
  EXPECT_EQ(objects.value(0x1A01, 3), 0x20300110u) << "the temperature of robot.yaml";
  EXPECT_NE(objects.value(0x1802, 1) & 0x80000000u, 0u) << "no other PDO";
  EXPECT_EQ(objects.value(0x1016, 1), 0x7F001Eu) << "this computer's heartbeat, 30 ms";
  EXPECT_EQ(objects.value(0x1029, 1), 1u) << "without it the motor stops, not the PDOs";
  EXPECT_EQ(objects.value(0x6007), 3u) << "a quick stop";
  EXPECT_EQ(objects.value(0x605A), 2u) << "along its ramp, then off";
  EXPECT_EQ(objects.value(0x60C2, 1), 2u) << "2 ms";
  EXPECT_EQ(objects.value(0x60C2, 2), 0xFDu);
  EXPECT_EQ(objects.value(0x6072), 3000u) << "the joint's effort: three times the rated torque";
}

TEST_F(CanopenDrives, ADriveThatIsAnotherThanRobotYamlSaysIsRefusedWithObjectAndBothValues) {
  const std::string who = "left_hip_pitch (can0a, node 1): ";
  const auto with = [&](int index, int subindex, std::uint32_t value) {
    std::uint32_t& object = hip().objects.value(index, subindex);
    const std::uint32_t kept = object;
    object = value;
    const std::string text = refusal();
    object = kept;
    return text;
  };
  EXPECT_EQ(with(0x6076, 0, 12'345),
            who + "object 0x6076 (rated torque) is 12.345 Nm; expected rated_torque_Nm 40 as in robot.yaml");
  EXPECT_EQ(with(0x608F, 1, 4096),
            who + "object 0x608F:1 (encoder counts a turn) is 4096; expected counts_per_turn 65536 as in robot.yaml");
  EXPECT_EQ(with(0x6502, 0, 1U << 7U),
            who + "object 0x6502 (supported modes) is 0x80; expected bit 9 for mode 10 as in robot.yaml");
  EXPECT_EQ(with(0x1000, 0, 401),
            who + "object 0x1000 (device type) is profile 401; expected profile 402: `cia402` as in robot.yaml");
  hip().objects.add(0x60A9, 0, 0x00B44700, 4);
  EXPECT_EQ(refusal(), who +
                           "object 0x60A9 (velocity unit) is 0.10472 rad/s; expected velocity_unit_rad_s 0.001 as in "
                           "robot.yaml");
  hip().objects.remove(0x60A9, 0);
  hip().objects.add(0x6091, 1, 100, 4);
  hip().objects.add(0x6091, 2, 1, 4);
  EXPECT_THAT(refusal(), testing::HasSubstr("object 0x6091:1 (gear in the drive's units) is 100:1"));
  hip().objects.remove(0x6091, 1);
  hip().objects.remove(0x6007, 0);
  EXPECT_EQ(refusal(), who + "has no object 0x6007 (reaction to a silent bus); expected a drive that has it");
  hip().objects.add(0x6007, 0, 0, 2, false);
  EXPECT_EQ(refusal(), who + "refuses object 0x6007 with SDO abort 0x06010002");
  hip().silent = true;
  EXPECT_THAT(refusal(), testing::StartsWith(who + "does not answer about object 0x1000"));
}

TEST_F(CanopenDrives, TheIdentityIsCheckedWhereRobotYamlHasIt) {
  can::DriveSetup setup = mixed();
  drives::Cia402Settings settings = *drives::as_cia402(setup.buses[kLeg].motors[0].drive);
  settings.vendor_id = 0x1234;
  settings.product_code = 0x5679;
  setup.buses[kLeg].motors[0].drive = drives::cia402_drive(settings);
  try {
    set_up_node(setup.buses[kLeg], setup.buses[kLeg].motors[0], *host_[kLeg], wait_);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(),
                 "left_hip_pitch (can0a, node 1): object 0x1018:2 (product code) is 0x5678; expected "
                 "0x5679 as in robot.yaml");
  }
}

TEST_F(CanopenDrives, StatesComeBackWithinACountOfTheDrives) {
  stand();
  for (int j = 0; j < truth_.q.size(); ++j) {
    EXPECT_NEAR(state_.q[j], truth_.q[j], 12.6 / 65535 / 2 + 1e-12) << "half a step of 16 bits";
    EXPECT_NEAR(state_.temperature_degC[j], 35.0, 0.05);
  }
}

TEST_F(CanopenDrives, TorqueModeClosesTheLoopWithThisCyclesReading) {
  stand();
  const int j = hip_index();
  truth_.q[j] += 0.01;
  truth_.dq[j] = 0.4;
  cycle(standing_);
  const double expected = standing_.kp[j] * (standing_.q[j] - truth_.q[j]) - standing_.kd[j] * truth_.dq[j];
  EXPECT_NEAR(acting_.tau_ff[j], expected, 0.5 * 0.05 + 700 * 0.5 * 6.28 / 65536) << "half a count of torque, and of q";
  EXPECT_EQ(acting_.kp[j], 0.0);
  model::JointCommand more = standing_;
  more.tau_ff[j] = 1e4;
  cycle(more);
  EXPECT_EQ(acting_.tau_ff[j], 120.0) << "the joint's effort";
}

TEST_F(CanopenDrives, TorqueModeDampsFromTheLastReadingWhenItIsLateAndStopsWithoutOne) {
  stand();
  const int j = hip_index();
  truth_.q[j] += 0.02;
  truth_.dq[j] = 0.5;
  cycle(standing_);
  // Its answers are lost, its commands arrive.
  hip().node = 99;
  std::vector<double> torques;
  for (int k = 0; k < 8; ++k) {
    truth_.dq[j] = 100.0;  // unknown to the host
    cycle(standing_);
    torques.push_back(acting_.tau_ff[j]);
  }
  const double pd = standing_.kp[j] * (standing_.q[j] - truth_.q[j]) - standing_.kd[j] * 0.5;
  EXPECT_NEAR(torques[0], pd, 0.1) << "one cycle old";
  for (const int k : {1, 2, 3, 4}) EXPECT_NEAR(torques[static_cast<std::size_t>(k)], -standing_.kd[j] * 0.5, 0.1) << k;
  EXPECT_EQ(torques[5], 0.0) << "quick stop in the sixth cycle";
  EXPECT_EQ(hip().objects.value(0x6040), 0x02u);
  EXPECT_FALSE(hip().enabled());
}

TEST_F(CanopenDrives, NoTorqueDriveIsSwitchedOnByACommandWithStiffness) {
  connect();
  for (int k = 0; k < 20; ++k) EXPECT_EQ(cycle(standing_), BusStatus::kLost);
  EXPECT_EQ(trouble(), "left_hip_pitch (can0a, node 1) is not enabled");
  EXPECT_FALSE(hip().enabled());
  EXPECT_FALSE(shoulder().enabled()) << "nor one in position mode";
  for (int k = 0; k < 6; ++k) cycle(limp());
  EXPECT_TRUE(hip().enabled());
  EXPECT_EQ(cycle(standing_), BusStatus::kOk) << trouble();
}

TEST_F(CanopenDrives, PositionModeMovesWithTheDrivesOwnGainsAloneAndIsOffOtherwise) {
  stand();
  const int j = shoulder_index();
  EXPECT_TRUE(shoulder().enabled());
  EXPECT_NEAR(acting_.q[j], standing_.q[j], 1e-4);
  EXPECT_EQ(acting_.kp[j], standing_.kp[j]);
  cycle(damping());
  EXPECT_EQ(acting_.kp[j], 0.0);
  EXPECT_GT(acting_.kd[j], 0.0) << "a quick stop";
  for (int k = 0; k < 60; ++k) cycle(damping());
  EXPECT_EQ(acting_.kd[j], 0.0) << "off after it";
  for (int k = 0; k < 4; ++k) EXPECT_EQ(cycle(standing_), BusStatus::kOk) << trouble();
  EXPECT_TRUE(shoulder().enabled()) << "on again";
  cycle(limp());
  EXPECT_FALSE(shoulder().enabled());
  EXPECT_EQ(acting_.kd[j], 0.0);
}

TEST_F(CanopenDrives, OtherGainsAndFeedForwardInPositionModeAreANamedTroubleAndNoMotion) {
  for (const int what : {0, 1, 2}) {
    stand();
    model::JointCommand other = standing_;
    const int j = shoulder_index();
    if (what == 0) other.kp[j] *= 1.01;
    if (what == 1) other.kd[j] *= 1.01;
    if (what == 2) other.tau_ff[j] = 1.0;
    EXPECT_EQ(cycle(other), BusStatus::kLost) << what;
    EXPECT_EQ(trouble(), "left_shoulder_pitch (can2a, node 1) is told other gains than those of its drive's own loop");
    EXPECT_FALSE(shoulder().enabled());
    cycle(standing_);
    EXPECT_EQ(cycle(standing_), BusStatus::kLost) << "not switched on again under stiffness";
    EXPECT_FALSE(shoulder().enabled());
  }
}

TEST_F(CanopenDrives, APositionTargetMovesNoFasterThanItsMotorMay) {
  stand();
  const int j = shoulder_index();
  const model::Joint& joint = z1().joints[static_cast<std::size_t>(j)];
  model::JointCommand far = standing_;
  far.q[j] = joint.upper_rad + 1.0;
  double before = acting_.q[j];
  for (int k = 0; k < 400; ++k) {
    cycle(far);
    ASSERT_LE(acting_.q[j] - before, joint.velocity_limit_rad_s * 0.002 + 1e-3);
    before = acting_.q[j];
  }
  EXPECT_LE(before, joint.upper_rad);
  EXPECT_NEAR(before, joint.upper_rad, 1e-3);
}

TEST_F(CanopenDrives, ADriveThatGoesOffByItselfInMotionIsLostAndStaysOffUnderStiffness) {
  stand();
  shoulder().fault = DriveFault::kOverCurrent;
  cycle(standing_);
  shoulder().fault = DriveFault::kNone;
  for (int k = 0; k < 300; ++k) EXPECT_EQ(cycle(standing_), BusStatus::kLost);
  EXPECT_FALSE(shoulder().enabled());
  for (int k = 0; k < 300; ++k) cycle(damping());
  EXPECT_EQ(cycle(standing_), BusStatus::kOk) << "reset under damping: " << trouble();
}

TEST_F(CanopenDrives, ADriveThatIsSwitchedOffFromOutsideIsLostAtOnceAndStaysOffUnderStiffness) {
  for (test::Cia402Emulator* drive : {&drives_->cia402(kLeg, 0), &drives_->cia402(kArm, 0)}) {
    stand();
    drive->drop();
    EXPECT_EQ(cycles_until(BusStatus::kLost), 0);
    EXPECT_THAT(trouble(), testing::HasSubstr("is not enabled"));
    for (int k = 0; k < 100; ++k) {
      cycle(standing_);
      ASSERT_FALSE(drive->enabled());
    }
  }
}

TEST_F(CanopenDrives, AnswersThatADelayBunchedAreNoSecondDrive) {
  stand();
  // What an adapter held back for four cycles arrives at once.
  std::vector<drives::Message> held;
  for (int k = 0; k < 4; ++k) {
    drives_->feel(truth_);
    hal_->send(standing_);
    drives_->serve();
    std::array<drives::Message, 64> frames;
    const std::size_t count = host_[kLeg]->receive(frames);
    held.insert(held.end(), frames.begin(), frames.begin() + static_cast<std::ptrdiff_t>(count));
    hal_->receive(state_);
    drives_->answer();
  }
  for (const drives::Message& frame : held) host_[kLeg]->push(frame);
  EXPECT_EQ(cycle(standing_), BusStatus::kOk) << trouble();
  EXPECT_EQ(hal_->motor(kLeg, 0).uncalled(), 0u);
  hip().twice = true;
  EXPECT_LE(cycles_until(BusStatus::kLost), 2 + 2) << "two of the four were given up before";
}

TEST_F(CanopenDrives, ASyncThatNeverLeftThisComputerAsksNobody) {
  stand();
  host_[kLeg]->cut = true;
  for (int k = 0; k < 2; ++k) cycle(standing_);
  host_[kLeg]->cut = false;
  cycle(standing_);
  EXPECT_EQ(hal_->motor(kLeg, 0).age_cycles(), 0);
}

TEST_F(CanopenDrives, ASilentMotorIsLateInTheSecondCycleAndLostInTheSixth) {
  stand();
  hip().silent = true;
  EXPECT_EQ(cycle(standing_), BusStatus::kOk);
  for (int k = 2; k <= 5; ++k) EXPECT_EQ(cycle(standing_), BusStatus::kStale) << k;
  EXPECT_EQ(cycle(standing_), BusStatus::kLost);
  EXPECT_EQ(trouble(), "left_hip_pitch (can0a, node 1) does not answer");
}

TEST_F(CanopenDrives, TheSecondHalfOfAnAnswerAloneIsNone) {
  stand();
  hip().silent = true;
  hal_->send(standing_);
  host_[kLeg]->push(drives::Message::of(0x281, std::array<std::uint8_t, 8>{}));
  hal_->receive(state_);
  EXPECT_EQ(hal_->motor(kLeg, 0).age_cycles(), 1) << "without a status word nothing says that the drive follows";
}

TEST_F(CanopenDrives, TwoDrivesOfOneNodeAreLostInTheThirdCycle) {
  stand();
  hip().twice = true;
  EXPECT_EQ(cycles_until(BusStatus::kLost), 2);
  EXPECT_EQ(trouble(), "left_hip_pitch (can0a, node 1) two drives have this node number");
}

TEST_F(CanopenDrives, AWrongIdIsASilentMotorAndAStranger) {
  stand();
  hip().node = 99;
  EXPECT_EQ(cycles_until(BusStatus::kLost), 5);
  EXPECT_EQ(hal_->strangers(), 12u) << "two TPDOs in each of six cycles";
}

TEST_F(CanopenDrives, ALostTurnIsNotBelieved) {
  stand();
  hip().turn_rad = 0.7;
  EXPECT_EQ(cycles_until(BusStatus::kLost), 2);
  EXPECT_EQ(trouble(), "left_hip_pitch (can0a, node 1) its position jumped: a turn was lost");
  cycle(standing_);
  EXPECT_EQ(acting_.tau_ff[hip_index()], 0.0) << "no PD on a position that isn't believed";
}

TEST_F(CanopenDrives, AMotorWhosePositionIsNoLongerBelievedIsDampedAndNotHeld) {
  stand();
  const int j = hip_index();
  hip().turn_rad = 0.7;
  cycles_until(BusStatus::kLost);
  hip().turn_rad = 0.0;  // plausible again: its readings are fresh, and still not to be held by
  truth_.q[j] += 0.02;
  cycle(standing_);
  cycle(standing_);
  ASSERT_EQ(hal_->motor(kLeg, 0).age_cycles(), 0);
  EXPECT_EQ(acting_.tau_ff[j], 0.0) << "at rest there is nothing to damp";
}

TEST_F(CanopenDrives, AFrameOfCanFdIsNoneOfACanopenDrives) {
  stand();
  hip().silent = true;
  hal_->send(standing_);
  host_[kLeg]->push(drives::Message::of(0x181, std::array<std::uint8_t, 8>{0x37, 0x02}, true));
  host_[kLeg]->push(drives::Message::of(0x281, std::array<std::uint8_t, 8>{}, true));
  hal_->receive(state_);
  EXPECT_EQ(hal_->motor(kLeg, 0).age_cycles(), 1);
}

TEST_F(CanopenDrives, ASetUpSurvivesALostAnswer) {
  int asked = 0;
  const Wait loses = [&] {
    drives_->answer();
    std::array<drives::Message, 64> frames;
    if (++asked == 8) host_[kLeg]->receive(frames);  // an answer to an SDO request
  };
  set_up_node(mixed().buses[kLeg], mixed().buses[kLeg].motors[0], *host_[kLeg], loses);
  EXPECT_EQ(hip().objects.value(0x6060), 10u);
}

TEST_F(CanopenDrives, EveryFaultOfADriveIsLostAtOnceAndNamed) {
  for (const DriveFault fault :
       {DriveFault::kOverTemperature, DriveFault::kOverCurrent, DriveFault::kOverVoltage, DriveFault::kUnderVoltage,
        DriveFault::kEncoder, DriveFault::kBridgeTemperature, DriveFault::kStall, DriveFault::kFollowing,
        DriveFault::kCommunication, DriveFault::kOther}) {
    stand();
    hip().fault = fault;
    EXPECT_EQ(cycles_until(BusStatus::kLost), 0);
    EXPECT_EQ(trouble(), std::string("left_hip_pitch (can0a, node 1) reports ") + drives::to_string(fault));
    EXPECT_EQ(acting_.tau_ff[hip_index()], 0.0);
    EXPECT_NE(hal_->motor(kLeg, 0).reading().fault, DriveFault::kNone);
    hip().fault = DriveFault::kNone;
    for (int k = 0; k < 300; ++k) {
      cycle(standing_);
      ASSERT_NE(hip().objects.value(0x6040), 0x80u) << "no reset under stiffness";
    }
    EXPECT_FALSE(hip().enabled());
    for (int k = 0; k < 300; ++k) cycle(damping());
    EXPECT_TRUE(hip().enabled()) << "reset and switched on under damping";
  }
}

TEST_F(CanopenDrives, AFaultThatStaysIsResetTwiceASecond) {
  stand();
  hip().fault = DriveFault::kUnderVoltage;
  int resets = 0;
  for (int k = 0; k < 1000; ++k) {
    cycle(damping());
    resets += hip().objects.value(0x6040) == 0x80 ? 1 : 0;
  }
  EXPECT_EQ(resets, 4);
}

TEST_F(CanopenDrives, AHotMotorIsReadByTheControlThread) {
  stand();
  hip().temperature_degC = 95.0;
  ASSERT_EQ(cycle(standing_), BusStatus::kOk);
  EXPECT_NEAR(state_.temperature_degC[hip_index()], 95.0, 0.05);
}

TEST_F(CanopenDrives, APulledCableStopsTheDrivesByThemselvesAndComesBackUnderDamping) {
  stand();
  host_[kLeg]->cut = true;
  EXPECT_EQ(cycles_until(BusStatus::kLost), 5);
  for (int k = 0; k < 20; ++k) cycle(damping());
  EXPECT_TRUE(hip().tripped());
  host_[kLeg]->cut = false;
  hip().leave_operational();  // as a drive does that has no object 0x1029
  for (int k = 0; k < 100; ++k) cycle(damping());
  EXPECT_TRUE(hip().enabled());
  EXPECT_EQ(cycle(standing_), BusStatus::kOk) << trouble();
}

TEST_F(CanopenDrives, ADriveThatWasPoweredAnewIsNamedAndNeverSwitchedOnWithoutItsSetUp) {
  stand();
  hip().power_up();
  EXPECT_EQ(cycles_until(BusStatus::kLost), 0);
  EXPECT_EQ(trouble(),
            "left_hip_pitch (can0a, node 1) was powered anew and has lost its set-up: start the program anew");
  for (int k = 0; k < 300; ++k) EXPECT_EQ(cycle(damping()), BusStatus::kLost);
  EXPECT_FALSE(hip().enabled());
}

TEST_F(CanopenDrives, AKilledHostLeavesTheDrivesToTheirWatchdogs) {
  stand();
  int cycles = 0;
  while (hip().enabled() && cycles < 100) {
    drives_->tick(acting_);
    ++cycles;
  }
  EXPECT_LE(cycles, 15) << "30 ms after the last heartbeat";
  EXPECT_GE(cycles, 15 - drives::canopen::kHeartbeatCycles);
  EXPECT_FALSE(shoulder().enabled());
  EXPECT_GT(acting_.kd[shoulder_index()], 0.0) << "braked";
  EXPECT_EQ(acting_.tau_ff[hip_index()], 0.0);
}

TEST_F(CanopenDrives, AnEmergencyMessageNamesAFaultWithoutACode) {
  stand();
  const drives::Message emergency = drives::Message::of(0x081, std::array<std::uint8_t, 8>{0x10, 0x43, 1});
  host_[kLeg]->push(emergency);
  EXPECT_EQ(cycle(standing_), BusStatus::kOk) << "the status word tells whether the drive follows";
  const double count_rad = drives::as_cia402(mixed().buses[kLeg].motors[0].drive)->count_rad();
  const auto counts = static_cast<std::uint32_t>(std::lround(hal_->motor(kLeg, 0).reading().q_rad / count_rad));
  drives::Message first = drives::Message::of(0x181, std::array<std::uint8_t, 8>{0x18, 0x02}),
                  second = drives::Message::of(0x281, std::array<std::uint8_t, 8>{});
  for (unsigned i = 0; i < 4; ++i) first.data[2 + i] = static_cast<std::uint8_t>(counts >> 8U * i);
  hip().silent = true;
  hal_->send(standing_);
  host_[kLeg]->push(first);
  host_[kLeg]->push(second);
  hal_->receive(state_);
  EXPECT_EQ(hal_->motor(kLeg, 0).reading().fault, DriveFault::kOverTemperature);
}

TEST_F(CanopenDrives, ACycleAllocatesNothing) {
  stand();
  const long before = test::allocation_count();
  for (int k = 0; k < 100; ++k) cycle(standing_);
  hip().silent = true;
  for (int k = 0; k < 400; ++k) cycle(damping());
  if (before < 0) GTEST_SKIP() << "sanitizers bring their own malloc";
  EXPECT_EQ(test::allocation_count(), before);
}

TEST_F(CanopenDrives, NothingThatABusSaysMovesAMotorBeyondItsLimits) {
  stand();
  std::mt19937_64 random(5);
  constexpr std::array<std::uint32_t, 7> kFunctions = {0x000, 0x080, 0x180, 0x280, 0x580, 0x700, 0x07E};
  for (int k = 0; k < 2000; ++k) {
    for (MemoryLink* link : host_) {
      for (int i = 0; i < 5; ++i) {
        const std::uint32_t id = kFunctions[random() % kFunctions.size()] + static_cast<std::uint32_t>(random() % 8);
        link->push(test::any_frame(random, id, 0x37));
      }
    }
    cycle(k % 50 < 10 ? limp() : standing_);
    ASSERT_NO_FATAL_FAILURE(test::expect_within_limits(acting_, z1()));
  }
}

TEST_F(CanopenDrives, TheRollCallFindsDrivesStrangersAndDifferences) {
  const auto scan = [&] {
    return problems(mixed().buses[kLeg], ask_bus(mixed().buses[kLeg], *host_[kLeg], wait_, {}));
  };
  EXPECT_THAT(scan(), testing::IsEmpty());
  hip().objects.value(0x6076) = 1000;
  drives_->cia402(kLeg, 1).silent = true;
  drives_->cia402(kLeg, 2).twice = true;
  EXPECT_THAT(scan(),
              testing::ElementsAre(
                  testing::HasSubstr("left_hip_pitch (can0a, node 1): object 0x6076 (rated torque) is 1 Nm"),
                  "left_hip_roll (can0a, node 2) does not answer; expected a powered drive with this node number",
                  "left_hip_yaw (can0a, node 3) answers 2 times; expected one drive of each node number"));
  hip().objects.value(0x6076) = 40'000;
  hip().fault = DriveFault::kUnderVoltage;
  drives_->cia402(kLeg, 1).silent = drives_->cia402(kLeg, 2).twice = false;
  can::BusSetup fewer = mixed().buses[kLeg];
  fewer.motors.erase(fewer.motors.begin() + 1);
  EXPECT_THAT(problems(fewer, ask_bus(fewer, *host_[kLeg], wait_, {})),
              testing::ElementsAre("left_hip_pitch (can0a, node 1) reports under-voltage; expected no fault",
                                   "can0a: somebody answers as node 2 (CANopen device type 0x00020192: profile 402); "
                                   "expected only the nodes of robot.yaml"));
}

}  // namespace
}  // namespace pmg::can
