// pmg_bus wiggle on a simulated robot that hangs in its gantry.
#include "can/first_light.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <stdexcept>

#include "can/emulated_robot.hpp"
#include "can/memory_link.hpp"
#include "can/mixed_drives.hpp"
#include "model/hanging_load.hpp"
#include "model/robots.hpp"
#include "sil/simulated_robot.hpp"

namespace pmg::can {
namespace {

/// Z1 on the gantry behind emulated drives. direction: as robot.yaml has it of the left knee, against a robot whose
/// motor turns the other way round.
class FirstLight : public testing::Test {
 protected:
  explicit FirstLight(std::optional<drives::Cia402Mode> mode = {})
      : setup_(drives::load_drives(test::z1())), world_(test::z1(), sil::world_with_noise(1, true)) {
    drives::MotorSetup& motor = setup_.buses[0].motors[3];
    if (mode) motor.drive = test::cia402_for(motor, test::z1(), *mode);
    auto [host, far] = test::link_pairs<test::MemoryLink>(setup_.buses.size());
    host_ = std::move(host);
    drives_.emplace(setup_, std::move(far));
    acting_.q = acting_.dq = acting_.kp = acting_.kd = acting_.tau_ff =
        JointVector::Zero(test::z1().joint_index.size());
    for (int k = 0; k < 500; ++k) tick();  // limp, it comes to rest
  }
  void tick() {
    world_.read(sensed_);
    drives_->feel(sensed_);
    drives_->serve();
    drives_->tick(acting_);
    world_.step(acting_);
  }
  Wiggle wiggle(const drives::MotorSetup& motor, const WiggleOptions& options = {}) {
    return can::wiggle(test::z1(), sensed_.q, setup_.buses[0], motor, *host_[0], options, [this] { tick(); }, {});
  }
  const drives::MotorSetup& knee() const { return setup_.buses[0].motors[3]; }

  drives::DriveSetup setup_;
  sim::World world_;
  test::Links host_;
  std::optional<test::EmulatedDrives> drives_;
  model::JointCommand acting_;
  model::RobotState sensed_;
};

TEST_F(FirstLight, AKneeMovesAndItsLoadTellsTheDirection) {
  const Wiggle result = wiggle(knee(), {.by_rad = 0.1, .gain_share = 0.5});
  EXPECT_GT(result.moved_rad, 0.5 * result.asked_rad);
  EXPECT_LT(result.moved_rad, 1.5 * result.asked_rad);
  tick();  // the last frame arrives
  EXPECT_FALSE(drives_->drive(0, 3).enabled()) << "switched off afterwards";
  for (std::size_t m = 0; m < 6; ++m) EXPECT_EQ(drives_->drive(0, m).enabled(), false) << "no other drive was ever on";
  EXPECT_FALSE(verdict(result).empty());
  EXPECT_GT(std::abs(result.model_Nm), 0.1) << "the shank does not hang straight down";
  EXPECT_NEAR(result.held_Nm, result.model_Nm, result.friction_Nm);
}

TEST_F(FirstLight, ASilentFaultyOrMisplacedMotorIsSwitchedOffWithALine) {
  const auto refusal = [this]() -> std::string {
    try {
      wiggle(knee());
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "moved";
  };
  drives_->drive(0, 3).fault = drives::DriveFault::kOverVoltage;
  EXPECT_EQ(refusal(), "left_knee (can0, node 4) reports over-voltage; it is switched off");
  drives_->drive(0, 3).fault = drives::DriveFault::kNone;
  drives_->drive(0, 3).turn_rad = -1.0;
  EXPECT_THAT(refusal(), testing::HasSubstr("expected a start within -0.050 to 2.400 rad: set its zero first"));
  drives_->drive(0, 3).silent = true;
  EXPECT_THAT(refusal(), testing::HasSubstr("left_knee (can0, node 4) does not answer"));
  EXPECT_FALSE(drives_->drive(0, 3).enabled());
}

// At a hip the whole leg hangs, the knee straighter than it stands: the model's torque is that of the leg as it hangs.
TEST_F(FirstLight, ALimbIsComparedAsItHangs) {
  const drives::MotorSetup& hip = setup_.buses[0].motors[0];
  ASSERT_EQ(hip.joint, "left_hip_pitch");
  const Wiggle result = wiggle(hip, {.by_rad = 0.05, .gain_share = 0.5});
  EXPECT_NEAR(result.held_Nm, result.model_Nm, result.friction_Nm);
  JointVector other = sensed_.q;
  other[test::z1().joint_index.at("left_knee")] = 2.0;  // it doesn't hang like that
  const Wiggle bent =
      can::wiggle(test::z1(), other, setup_.buses[0], hip, *host_[0], {.by_rad = 0.05}, [this] { tick(); }, {});
  EXPECT_GT(std::abs(bent.held_Nm - bent.model_Nm), bent.friction_Nm);
}

class FirstLightTorque : public FirstLight {
 protected:
  FirstLightTorque() : FirstLight(drives::Cia402Mode::kTorque) {}
};
class FirstLightPosition : public FirstLight {
 protected:
  FirstLightPosition() : FirstLight(drives::Cia402Mode::kPosition) {}
};

TEST_F(FirstLightTorque, AKneeMovesAndItsLoadTellsTheDirection) {
  const Wiggle result = wiggle(knee(), {.by_rad = 0.1, .gain_share = 0.5});
  EXPECT_GT(result.moved_rad, 0.5 * result.asked_rad);
  EXPECT_LT(result.moved_rad, 1.5 * result.asked_rad);
  tick();
  EXPECT_FALSE(drives_->drive(0, 3).enabled());
  EXPECT_NEAR(result.held_Nm, result.model_Nm, result.friction_Nm);
}

TEST_F(FirstLightPosition, AKneeMovesWithTheDrivesOwnGains) {
  const Wiggle result = wiggle(knee(), {.by_rad = 0.1, .gain_share = 0.3});
  EXPECT_NEAR(result.moved_rad, result.asked_rad, 0.1 * result.asked_rad);
  tick();
  EXPECT_FALSE(drives_->drive(0, 3).enabled());
}

TEST_F(FirstLightTorque, ADriveThatIsAnotherThanRobotYamlSaysDoesNotMove) {
  drives_->cia402(0, 3).objects.value(0x6076) = 1000;
  EXPECT_THROW(wiggle(knee()), std::runtime_error);
  EXPECT_FALSE(drives_->drive(0, 3).enabled());
}

TEST(FirstLightText, TheWayOfAKneeIsBackwardAndUp) {
  // Z1's knee bends the shank backward for a positive angle; standing, it is bent by 0.3 rad already.
  EXPECT_THAT(way_of(test::z1(), test::z1().q_stand(), "left_knee", 0.05), testing::HasSubstr("backward"));
  EXPECT_THAT(way_of(test::z1(), test::z1().q_stand(), "left_hip_pitch", -0.05), testing::HasSubstr("forward"));
  EXPECT_THAT(way_of(test::z1(), test::z1().q_stand(), "left_hip_roll", 0.05), testing::HasSubstr("to the left"));
}

TEST(FirstLightText, TheVerdictFollowsFromTheFigures) {
  const Wiggle good = {.asked_rad = 0.05, .moved_rad = 0.045, .held_Nm = 4.1, .model_Nm = 4.5, .friction_Nm = 0.6};
  EXPECT_EQ(verdict(good), "direction and gear agree with the model");
  Wiggle wiggle = good;
  wiggle.held_Nm = -4.1;
  EXPECT_THAT(verdict(wiggle), testing::HasSubstr("`direction` in robot.yaml is wrong"));
  wiggle.held_Nm = 12.0;
  EXPECT_THAT(verdict(wiggle), testing::HasSubstr("2.7 times the model's load: look at `gear`"));
  wiggle = good;
  wiggle.model_Nm = 1.0;
  EXPECT_THAT(verdict(wiggle), testing::HasSubstr("too small to tell the direction"));
  wiggle = good;
  wiggle.moved_rad = 0.01;
  EXPECT_THAT(verdict(wiggle), testing::HasSubstr("less than half the way"));
}

}  // namespace
}  // namespace pmg::can
