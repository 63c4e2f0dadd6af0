// A protocol that nobody thought of: it is added to the catalogue, and bus cycle, roll call, first light and
// robot.yaml take it as they are.
#include "can/twin_protocol.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "../sim/robots.hpp"
#include "can/bus_ids.hpp"
#include "can/bus_load.hpp"
#include "can/can_hal.hpp"
#include "can/few_motors.hpp"
#include "can/memory_link.hpp"
#include "can/roll_call.hpp"
#include "files/config_error.hpp"
#include "model/temporary_copy.hpp"

namespace pmg::can {
namespace {

using hal::BusStatus;

drives::DriveCatalogue with_twins() {
  drives::DriveCatalogue catalogue = drives::standard_drives();
  catalogue.add("twin", [](files::ConfigReader& reader) -> drives::DriveKind {
    return std::make_shared<test::TwinDrives>(reader.required<double>("most_torque_Nm", files::positive()));
  });
  return catalogue;
}

/// Z1 whose left knee has such a drive.
DriveSetup z1_with_a_twin(double most_torque_Nm = 150.0) {
  const model::TemporaryCopy copy(test::kZ1Folder);
  copy.replace("robot.yaml", "  arm: {",
               "  knee: {protocol: twin, most_torque_Nm: " + std::to_string(most_torque_Nm) + "}\n  arm: {");
  copy.replace("robot.yaml", "node: 4, drive: leg", "node: 4, drive: knee");
  return load_drives(model::load_robot(copy.directory()), with_twins());
}

class TwinProtocol : public testing::Test {
 protected:
  TwinProtocol() {
    setup_.buses.resize(1);
    auto& motors = setup_.buses[0].motors;
    motors.assign(motors.begin() + 3, motors.begin() + 4);
    auto [here, there] = test::MemoryLink::pair();
    host_ = here.get();
    there_ = std::move(there);
    links_.push_back(std::move(here));
    drive_.emplace(*there_, 4);
    drive_->motor.q_rad = 0.3;
    limp_.kp.setZero();
    limp_.kd.setZero();
  }
  void start() { hal_.emplace(setup_, z1(), clock_, std::move(links_)); }
  BusStatus cycle(const model::JointCommand& command) {
    hal_->send(command);
    drive_->answer();
    return hal_->receive(state_);
  }
  std::string trouble() const { return describe(hal_->trouble(), setup_); }
  std::vector<std::string> scan() {
    return problems(setup_.buses[0], ask_bus(setup_.buses[0], *host_, [this] { drive_->answer(); }, {}));
  }

  DriveSetup setup_ = z1_with_a_twin();
  io::SimulationClock clock_;
  test::MemoryLink* host_ = nullptr;
  std::unique_ptr<test::MemoryLink> there_;
  std::vector<std::unique_ptr<Link>> links_;
  std::optional<test::TwinEmulator> drive_;
  std::optional<CanHal> hal_;
  model::JointCommand standing_ = standing_command(z1()), limp_ = standing_;
  model::RobotState state_;
};

TEST_F(TwinProtocol, RobotYamlNamesItAndItsKeysAndIdentifiersAreChecked) {
  EXPECT_THROW(load_drives(z1(), drives::DriveCatalogue{}), files::ConfigError) << "no protocol at all is known";
  EXPECT_THROW(z1_with_a_twin(119.0), files::ConfigError) << "the knee's effort is 120 Nm";
  EXPECT_EQ(planned_load(setup_.buses[0]).frames, 4);
  EXPECT_THAT(awaited_ids(setup_.buses[0]), testing::ElementsAre(0x304, 0x404));
  EXPECT_NO_THROW(check_ids(setup_));
  setup_.buses[0].motors.push_back(setup_.buses[0].motors[0]);
  EXPECT_THROW(check_ids(setup_), std::invalid_argument) << "two of one node";
}

TEST_F(TwinProtocol, ItIsSwitchedOnOverThreeCyclesNeverUnderStiffnessAndThenFollows) {
  start();
  EXPECT_EQ(cycle(standing_), BusStatus::kLost);
  EXPECT_EQ(trouble(), "left_knee (can0, node 4) is not enabled");
  EXPECT_EQ(drive_->keys, 0) << "the robot is stiff";
  for (int k = 1; k <= test::Twin::kKeys; ++k) {
    EXPECT_EQ(cycle(limp_), BusStatus::kOk) << trouble();
    EXPECT_EQ(drive_->stage, k);
    EXPECT_EQ(hal_->motor(0, 0).enabled(), k == test::Twin::kKeys);
  }
  const int joint = setup_.buses[0].motors[0].index;
  for (int k = 0; k < 5; ++k) ASSERT_EQ(cycle(standing_), BusStatus::kOk) << trouble();
  EXPECT_NEAR(state_.q[joint], 0.3, 1e-6);
  EXPECT_EQ(state_.temperature_degC[joint], 40.0);
  EXPECT_NEAR(drive_->command.q_rad, standing_.q[joint], 1e-6);
  EXPECT_NEAR(drive_->command.kp_Nm_per_rad, standing_.kp[joint], 0.1);
  EXPECT_EQ(drive_->keys, test::Twin::kKeys) << "no key more once it is on";
}

TEST_F(TwinProtocol, WhatIsWrongWithItHasTheSameWords) {
  start();
  for (int k = 0; k < 3; ++k) cycle(limp_);
  drive_->faulty = true;
  EXPECT_EQ(cycle(standing_), BusStatus::kLost);
  EXPECT_EQ(trouble(), "left_knee (can0, node 4) reports over-current");
  drive_->faulty = false;
  for (int k = 0; k < 3; ++k) cycle(limp_);
  ASSERT_EQ(cycle(standing_), BusStatus::kOk) << trouble();
  drive_->lost_halves = 2;
  EXPECT_EQ(cycle(standing_), BusStatus::kOk) << "the answer before still counts";
  EXPECT_EQ(cycle(standing_), BusStatus::kStale);
  EXPECT_EQ(trouble(), "left_knee (can0, node 4) answers late");
  for (int k = 0; k < 10; ++k) cycle(standing_);
  EXPECT_EQ(cycle(standing_), BusStatus::kOk) << trouble();
  drive_->silent = true;
  for (int k = 0; k < 7; ++k) cycle(standing_);
  EXPECT_EQ(trouble(), "left_knee (can0, node 4) does not answer");
  drive_->silent = false;
  drive_->other_node = 5;
  cycle(limp_);
  EXPECT_EQ(hal_->strangers(), 1u);
}

TEST_F(TwinProtocol, HalfARequestIsNone) {
  start();
  for (int k = 0; k < 3; ++k) cycle(limp_);
  ASSERT_EQ(cycle(standing_), BusStatus::kOk);
  host_->cut = true;
  for (int k = 0; k < 3; ++k) cycle(standing_);
  EXPECT_TRUE(hal_->motor(0, 0).settled()) << "nothing that never left is owed";
  EXPECT_EQ(hal_->motor(0, 0).lost(), 0u);
}

TEST_F(TwinProtocol, RollCallCountsItOnceAndFindsASecondOneAStrangerAndAFault) {
  EXPECT_THAT(scan(), testing::IsEmpty());
  drive_->twice = true;
  EXPECT_THAT(scan(), testing::ElementsAre("left_knee (can0, node 4) answers 2 times; expected one drive of each node "
                                           "number"));
  drive_->twice = false;
  drive_->faulty = true;
  EXPECT_THAT(scan(), testing::ElementsAre("left_knee (can0, node 4) reports over-current; expected no fault"));
  drive_->faulty = false;
  drive_->other_node = 9;
  EXPECT_THAT(scan(), testing::ElementsAre("left_knee (can0, node 4) does not answer; expected a powered drive with "
                                           "this node number",
                                           "can0: somebody answers as node 9; expected only the nodes of robot.yaml"));
}

// Nobody knows what its message would do to a drive that robot.yaml doesn't have.
TEST_F(TwinProtocol, NodesThatNobodyDescribedGetNoMessageThatMayDisturbThem) {
  const Strangers strangers = ask_strangers(setup_.buses[0], *host_, [] {}, {});
  EXPECT_EQ(strangers.why_not, "left_knee's protocol has no message that is known to be harmless to any drive");
  EXPECT_EQ(host_->counts().sent, 0u);
}

TEST_F(TwinProtocol, OneMotorAloneIsSwitchedOnMovedAndSwitchedOff) {
  const std::function<void()> tick = [this] { drive_->answer(); };
  {
    FewMotors one(setup_.buses[0], setup_.buses[0].motors[0], *host_, tick);
    EXPECT_NEAR(one.reading().q_rad, 0.3, 1e-6);
    EXPECT_TRUE(one.switch_on());
    EXPECT_EQ(drive_->keys, test::Twin::kKeys);
    one.exchange({.q_rad = 0.4, .kp_Nm_per_rad = 100.0, .kd_Nm_s_per_rad = 5.0});
    EXPECT_NEAR(drive_->command.q_rad, 0.4, 1e-6);
    EXPECT_FALSE(one.set_zero()) << "its protocol has no message for that";
  }
  drive_->answer();
  EXPECT_EQ(drive_->stage, 0) << "switched off afterwards";
}

}  // namespace
}  // namespace pmg::can
