// All motors of a robot without a bus and without a protocol: readings come from the test.
#include "drives/robot_drives.hpp"

#include <gtest/gtest.h>

#include "model/constants.hpp"

namespace pmg::drives {
namespace {

MotorSetup motor(const char* joint, int index, double direction) {
  model::BusAddress address;
  address.bus = "b";
  address.direction = direction < 0.0 ? -1 : 1;
  return {.joint = joint,
          .index = index,
          .node = index + 1,
          .drive = nullptr,
          .transmission = Transmission(address),
          .limits = {.q_lower_rad = -1.0, .q_upper_rad = 1.0, .dq_rad_s = 10.0, .torque_Nm = 50.0}};
}

class TwoMotors : public testing::Test {
 protected:
  TwoMotors() { command_.q = command_.dq = command_.kp = command_.kd = command_.tau_ff = JointVector::Zero(2); }
  /// One cycle, in which these motors answer.
  void cycle(bool first, bool second) {
    drives_.begin(command_, now_ns_ += 2'000'000);
    const bool answers[] = {first, second};
    for (std::size_t m = 0; m < 2; ++m) {
      MotorMonitor& monitor = drives_.monitor(0, m);
      if (monitor.pauses()) continue;
      monitor.ask(!monitor.enabled() && !drives_.stiff());
      if (answers[m]) monitor.hear({.q_rad = 0.2, .dq_rad_s = 0.1, .torque_Nm = 3.0, .temperature_degC = 30.0});
    }
    drives_.read();
  }

  MotorGroup group_{.name = "b", .motors = {motor("left", 0, 1.0), motor("right", 1, -1.0)}};
  RobotDrives drives_{{{.group = &group_}}, 2};
  model::JointCommand command_;
  model::RobotState state_;
  std::int64_t now_ns_ = 1;
};

TEST_F(TwoMotors, WhatTheyAreToldAndSayGoesThroughTheirTransmissions) {
  command_.q << 0.3, 0.4;
  command_.kp << 100.0, 200.0;
  cycle(true, true);
  EXPECT_EQ(drives_.wanted(0, 1).q_rad, 0.4) << "at the joint";
  EXPECT_EQ(drives_.wanted(0, 1).kp_Nm_per_rad, 200.0);
  drives_.fill(state_);
  EXPECT_EQ(state_.q[0], 0.2);
  EXPECT_EQ(state_.q[1], -0.2);
  EXPECT_EQ(state_.tau[1], -3.0);
  EXPECT_EQ(state_.temperature_degC[1], 30.0);
}

TEST_F(TwoMotors, StiffnessUrgencyAndPausesAreSeen) {
  cycle(true, true);
  EXPECT_TRUE(drives_.urgent()) << "the first command";
  cycle(true, true);
  EXPECT_FALSE(drives_.stiff() || drives_.urgent() || drives_.paused());
  command_.tau_ff[1] = 1.0;
  cycle(true, true);
  EXPECT_TRUE(drives_.stiff());
  EXPECT_FALSE(drives_.urgent());
  command_.kd[0] = 1.0;
  cycle(true, true);
  EXPECT_TRUE(drives_.urgent());
  now_ns_ += RobotDrives::kPause_ns;
  cycle(true, true);
  EXPECT_TRUE(drives_.paused());
}

TEST_F(TwoMotors, ALostMotorIsNamedBeforeALateOneAndTheOldestReadingIsTheStatesAge) {
  cycle(true, true);
  EXPECT_EQ(drives_.judge(0), MotorTrouble{});
  cycle(false, true);
  drives_.fill(state_);
  EXPECT_EQ(state_.age_ns, 2'000'000) << "the left one's";
  for (int k = 0; k < 2; ++k) cycle(false, true);
  EXPECT_EQ(drives_.judge(0), (MotorTrouble{.condition = Condition::kLate, .motor = 0}));
  drives_.monitor(0, 1).restarted();
  EXPECT_EQ(drives_.judge(0),
            (MotorTrouble{.condition = Condition::kLost, .motor = 1, .trouble = Trouble::kRestarted}));
}

TEST_F(TwoMotors, TheWordsAreThoseOfTheFault) {
  EXPECT_EQ(name_of(group_, group_.motors[1]), "right (b, node 2)");
  EXPECT_EQ(words_of(Trouble::kSilent, DriveFault::kNone), "does not answer");
  EXPECT_EQ(words_of(Trouble::kFault, DriveFault::kOverload), "reports an overload");
  EXPECT_EQ(words_of(Trouble::kNone, DriveFault::kNone), "answers late");
}

}  // namespace
}  // namespace pmg::drives
