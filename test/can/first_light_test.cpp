// pmg_bus wiggle on a simulated robot that hangs in its gantry.
#include "can/first_light.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <set>
#include <span>
#include <stdexcept>
#include <string>

#include "can/hanging_stage.hpp"
#include "can/mixed_drives.hpp"
#include "drive_protocols/mit_drive.hpp"
#include "model/hanging_load.hpp"
#include "model/robots.hpp"

namespace pmg::can {
namespace {

/// The left knee's drive is a CiA 402 one in this mode, or as robot.yaml has it.
can::DriveSetup with_knee(std::optional<drives::Cia402Mode> mode) {
  can::DriveSetup setup = can::load_drives(test::z1());
  drives::MotorSetup& motor = setup.buses[0].motors[3];
  if (mode) motor.drive = drives::cia402_drive(test::cia402_for(motor, test::z1(), *mode));
  return setup;
}

class FirstLight : public testing::Test, protected test::HangingStage {
 protected:
  explicit FirstLight(std::optional<drives::Cia402Mode> mode = {}) : HangingStage(with_knee(mode)) {}
  Wiggle wiggle(const drives::MotorSetup& motor, const WiggleOptions& options = {}) {
    return can::wiggle(test::z1(), sensed_.q, setup_.buses[0], motor, *host_[0], options, [this] { tick(); }, {});
  }
  /// As pmg_bus does it: with the IMU, the torso in the gantry. inverted: the motor turns the other way round than
  /// robot.yaml says, and its zero is right.
  std::string said(std::size_t b, const drives::MotorSetup& motor, bool inverted, Verdict::Tells& tells) {
    for (int k = 0; k < 300; ++k) tick();  // what moved before comes to rest
    const model::Joint& joint = test::z1().joints[static_cast<std::size_t>(motor.index)];
    drives::MotorSetup described = motor;
    JointVector q = sensed_.q;
    if (inverted) {
      model::BusAddress address = joint.bus;
      address.direction = -address.direction;
      described.transmission = drives::Transmission(address);
      described.limits = described.transmission.to_motor(drives::MotorLimits{.q_lower_rad = joint.lower_rad,
                                                                             .q_upper_rad = joint.upper_rad,
                                                                             .dq_rad_s = joint.velocity_limit_rad_s,
                                                                             .torque_Nm = joint.effort_limit_Nm});
      q[motor.index] = -q[motor.index];
    }
    const can::BusSetup& bus = setup_.buses[b];
    const auto with_imu =
        static_cast<std::size_t>(std::ranges::find(setup_.buses, true, &can::BusSetup::imu) - setup_.buses.begin());
    Plumb plumb(test::z1(), bus.imu ? nullptr : host_[with_imu].get());
    model::Hanging hanging{.held_link = test::z1().torso_link};
    std::array<drives::Message, 64> old;
    while (host_[with_imu]->receive(old) > 0) {
    }
    tick();
    while (const std::size_t count = bus.imu ? host_[b]->receive(old) : 0) {
      for (const drives::Message& message : std::span(old).first(count)) plumb.hear(message);
    }
    if (const auto sample = plumb.sample(q)) hanging.down_B = sample->down_B;
    try {
      const Wiggle result = can::wiggle(
          test::z1(), q, bus, described, *host_[b], {}, [this] { tick(); }, {}, hanging, &plumb);
      tells = verdict(result).tells;
      expect_nothing_false(motor.joint, inverted, result);
      return verdict(result).text +
             fmt::format(" [held {:.2f}, model {:.2f} or {:.2f}, friction {:.2f} Nm, leaned {:.4f} of {:.4f} rad]",
                         result.held_Nm, result.model_Nm, result.model_inverted_Nm, result.friction_Nm,
                         result.leaned_rad.value_or(NAN), result.least_lean_rad);
    } catch (const std::runtime_error& error) {
      tells = Verdict::Tells::kWrong;
      return error.what();
    }
  }
  /// With the IMU and without it.
  static void expect_nothing_false(const std::string& joint, bool inverted, Wiggle result) {
    for (int seen = 0; seen < 2; ++seen) {
      const auto [tells, text, look] = verdict(result);
      if (inverted) {
        EXPECT_NE(tells, Verdict::Tells::kAgrees) << joint << ", inverted: " << text;
        EXPECT_EQ(text.find("direction agrees"), std::string::npos) << joint << ", inverted: " << text;
      } else {
        EXPECT_EQ(text.find("`direction` in"), std::string::npos) << joint << ": " << text;
        EXPECT_EQ(text.find("`gear`"), std::string::npos) << joint << ": " << text;
      }
      result.leaned_rad.reset();
    }
  }
  /// A bent knee hangs the leg's weight behind its hip: the hip comes to rest at an angle.
  void hold_left_knee_bent() {
    const auto left_knee = static_cast<Eigen::Index>(test::z1().joint_index.at("left_knee"));
    hands = [left_knee](model::JointCommand& command) {
      command.q[left_knee] = 0.8;
      command.kp[left_knee] = 200.0;
      command.kd[left_knee] = 5.0;
    };
    for (int k = 0; k < 1500; ++k) tick();
  }
  /// The gantry holds the torso obliquely: gravity is what leans here.
  void hang_obliquely(double angle_rad, const Eigen::Vector3d& axis) {
    const Eigen::Vector3d gravity =
        Eigen::AngleAxisd(angle_rad, axis.normalized()) * Eigen::Vector3d(0.0, 0.0, -kGravity_m_s2);
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast): no world leans, so this test's does
    auto* model = const_cast<mjModel*>(world_.mj_model());
    for (int i = 0; i < 3; ++i) model->opt.gravity[i] = gravity[i];
    for (int k = 0; k < 1500; ++k) tick();
  }
  /// Every joint as it is and inverted: nothing false is said. Returns those whose inverted direction is named.
  std::set<std::string> named_when_inverted() {
    std::set<std::string> named;
    for (std::size_t b = 0; b < setup_.buses.size(); ++b) {
      for (const drives::MotorSetup& motor : setup_.buses[b].motors) {
        Verdict::Tells tells{};
        const std::string right = said(b, motor, false, tells);
        EXPECT_EQ(right.find("`direction` in"), std::string::npos) << motor.joint << ": " << right;
        const bool agrees = right.find("direction and gear agree") != std::string::npos ||
                            right.find("the direction agrees") != std::string::npos;
        const std::string wrong = said(b, motor, true, tells);
        const bool told = tells == Verdict::Tells::kWrong && wrong.find("`direction` in") != std::string::npos;
        if (told) named.insert(motor.joint);
        if (agrees) confirmed_.insert(motor.joint);
        fmt::print("{:22} {} | {}\n{:22} inverted: {}\n", motor.joint, agrees ? "confirmed" : "-", right, "", wrong);
      }
    }
    return named;
  }
  const drives::MotorSetup& knee() const { return setup_.buses[0].motors[3]; }

  std::set<std::string> confirmed_;
};

TEST_F(FirstLight, AKneeMovesAndItsLoadTellsTheDirection) {
  const Wiggle result = wiggle(knee(), {.by_rad = 0.1, .gain_share = 0.5});
  EXPECT_GT(result.moved_rad, 0.5 * result.asked_rad);
  EXPECT_LT(result.moved_rad, 1.5 * result.asked_rad);
  tick();  // the last frame arrives
  EXPECT_FALSE(drives_->drive(0, 3).enabled()) << "switched off afterwards";
  for (std::size_t m = 0; m < 6; ++m) EXPECT_EQ(drives_->drive(0, m).enabled(), false) << "no other drive was ever on";
  EXPECT_FALSE(verdict(result).text.empty());
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
  EXPECT_THAT(refusal(), testing::HasSubstr("expected a start within -0.050 to 2.400 rad: "));
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

// The load of a bent leg tells the direction of its hip; sideways it hangs straight.
TEST_F(FirstLight, TheDirectionIsToldWhereTheLimbHangsObliquelyAndElseLeftToTheEye) {
  hold_left_knee_bent();
  const auto& leg = setup_.buses[0].motors;
  ASSERT_EQ(leg[0].joint, "left_hip_pitch");
  ASSERT_EQ(leg[1].joint, "left_hip_roll");
  ASSERT_EQ(leg[2].joint, "left_hip_yaw");
  const Verdict pitch = verdict(wiggle(leg[0], {.gain_share = 1.0})),
                roll = verdict(wiggle(leg[1], {.gain_share = 1.0})), yaw = verdict(wiggle(leg[2], {.gain_share = 1.0}));
  EXPECT_EQ(pitch.tells, Verdict::Tells::kAgrees) << pitch.text;
  EXPECT_EQ(roll.tells, Verdict::Tells::kNotAll) << roll.text;
  EXPECT_THAT(roll.text, testing::HasSubstr("the same the other way round"));
  EXPECT_EQ(yaw.tells, Verdict::Tells::kNotAll) << yaw.text;
  EXPECT_THAT(yaw.text, testing::HasSubstr("too small to tell direction and gear"));
}

TEST_F(FirstLight, AnInvertedDirectionAndAWrongGearAreNamed) {
  hold_left_knee_bent();
  const model::Joint& joint = test::z1().joints[static_cast<std::size_t>(setup_.buses[0].motors[0].index)];
  const auto described = [&](int direction, double gear) {
    drives::MotorSetup motor = setup_.buses[0].motors[0];
    model::BusAddress address = joint.bus;
    address.direction = direction;
    address.gear = gear;
    motor.transmission = drives::Transmission(address);
    motor.limits = motor.transmission.to_motor(drives::MotorLimits{.q_lower_rad = joint.lower_rad,
                                                                   .q_upper_rad = joint.upper_rad,
                                                                   .dq_rad_s = joint.velocity_limit_rad_s,
                                                                   .torque_Nm = joint.effort_limit_Nm});
    sensed_.q[motor.index] /= direction * gear;
    return verdict(wiggle(motor, {.gain_share = 1.0}));
  };
  const Verdict inverted = described(-1, 1.0);
  EXPECT_EQ(inverted.tells, Verdict::Tells::kWrong);
  EXPECT_THAT(inverted.text, testing::HasSubstr("`direction` in robot.yaml is wrong"));
  const Verdict geared = described(1, 3.0);
  EXPECT_EQ(geared.tells, Verdict::Tells::kWrong) << geared.text;
  EXPECT_THAT(geared.text, testing::HasSubstr("look at `gear`"));
}

TEST_F(FirstLight, TheBaseThatLeansTellsADirectionThatTheLoadCant) {
  for (const char* name : {"left_hip_roll", "waist_roll"}) {
    std::size_t bus = 0, at = 0;
    const auto here = [&] {
      const auto& motors = setup_.buses.at(bus).motors;
      at = static_cast<std::size_t>(std::ranges::find(motors, name, &drives::MotorSetup::joint) - motors.begin());
      return at < motors.size();
    };
    while (!here()) ++bus;
    const drives::MotorSetup& motor = setup_.buses[bus].motors[at];
    Verdict::Tells tells{};
    EXPECT_THAT(said(bus, motor, false, tells), testing::HasSubstr("agree")) << name;
    EXPECT_NE(tells, Verdict::Tells::kWrong);
    EXPECT_THAT(said(bus, motor, true, tells), testing::StartsWith("the base leans the other way than the model's: "
                                                                   "`direction` in robot.yaml is wrong"))
        << name;
    EXPECT_EQ(tells, Verdict::Tells::kWrong);
  }
}

TEST_F(FirstLight, AJointThatMeetsMoreThanItsLoadIsSwitchedOff) {
  for (int k = 0; k < 100; ++k) tick();
  EXPECT_THROW(wiggle(knee(), {.by_rad = 0.3, .gain_share = 1.0, .effort_share = -0.1}), std::runtime_error);
  tick();
  EXPECT_FALSE(drives_->drive(0, 3).enabled());
}

// Z1's knee ends at -0.05 rad: the other way round, that is 0.05.
TEST_F(FirstLight, AStopOfTheOtherWayRoundNamesTheDirectionAndABrakeThereDoesNot) {
  const auto refusal = [this](bool inverted) {
    Verdict::Tells tells{};
    const std::string text = said(0, knee(), inverted, tells);
    EXPECT_EQ(tells, Verdict::Tells::kWrong);
    return text;
  };
  const auto put = [this](double q_rad) {
    const Eigen::Index at = knee().index;
    hands = [=](model::JointCommand& command) {
      command.q[at] = q_rad;
      command.kp[at] = 100.0;
      command.kd[at] = 5.0;
    };
    for (int k = 0; k < 500; ++k) tick();
    hands = {};
  };
  put(0.0);
  EXPECT_THAT(refusal(true), testing::HasSubstr("it stopped where its range ends the other way round: `direction` in "
                                                "robot.yaml is wrong, or the zero, or something blocks it"));
  put(0.045);
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast): no world has a brake, so this test's does
  auto* model = const_cast<mjModel*>(world_.mj_model());
  mjtNum* range = model->jnt_range + 2 * mj_name2id(model, mjOBJ_JOINT, "left_knee");
  range[0] = 0.043;
  range[1] = 0.047;
  EXPECT_THAT(refusal(false), testing::HasSubstr("something blocks it, or gear or zero are wrong"));
}

/// Minutes: every joint of Z1, as it is and inverted.
class HangingRobot : public FirstLight {};

// docs/how-to/hal.md names them.
TEST_F(HangingRobot, EveryInvertedMotorOfAHangingRobotIsNamedOrLeftToTheEyeAndNoneFalsely) {
  EXPECT_THAT(named_when_inverted(), testing::ElementsAre("left_elbow", "left_hip_pitch", "left_hip_roll", "left_knee",
                                                          "right_elbow", "right_hip_pitch", "right_hip_roll",
                                                          "right_knee", "waist_pitch", "waist_roll", "waist_yaw"));
  EXPECT_THAT(confirmed_, testing::ElementsAre("left_elbow", "left_hip_pitch", "left_hip_roll", "left_knee",
                                               "right_elbow", "right_hip_pitch", "right_hip_roll", "right_knee",
                                               "waist_pitch", "waist_roll", "waist_yaw"));
}

TEST_F(HangingRobot, ThatHangsObliquelyHasMoreInvertedMotorsNamedAndNoneFalsely) {
  hang_obliquely(15.0 * kRadPerDegree, {1.0, 1.0, 0.0});
  EXPECT_THAT(named_when_inverted(),
              testing::ElementsAre("head_yaw", "left_elbow", "left_hip_pitch", "left_hip_roll", "left_knee",
                                   "left_shoulder_pitch", "left_shoulder_roll", "right_elbow", "right_hip_pitch",
                                   "right_hip_roll", "right_knee", "right_shoulder_pitch", "waist_pitch", "waist_roll",
                                   "waist_yaw"));
  EXPECT_THAT(confirmed_,
              testing::ElementsAre("head_yaw", "left_elbow", "left_hip_pitch", "left_hip_roll", "left_knee",
                                   "left_shoulder_pitch", "right_elbow", "right_hip_pitch", "right_hip_roll",
                                   "right_knee", "right_shoulder_pitch", "waist_pitch", "waist_roll", "waist_yaw"));
}

/// Hands put the limbs somewhere and let go; then the torso leans. Seeds of postures in which a joint lies on its stop,
/// or the base still moves.
class InWhateverPosture : public HangingRobot, public testing::WithParamInterface<unsigned> {};

TEST_P(InWhateverPosture, KneesAndElbowsAreToldByTheirRangeAndNothingFalseIsSaid) {
  std::mt19937 random(GetParam());
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const double angle_rad = 20.0 * kRadPerDegree * std::abs(uniform(random));
  const double azimuth_rad = std::numbers::pi * uniform(random);
  JointVector q = sensed_.q;
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const model::Joint& joint = test::z1().joints[static_cast<std::size_t>(i)];
    q[i] = std::clamp(q[i] + 0.5 * uniform(random), joint.lower_rad + 0.02, joint.upper_rad - 0.02);
  }
  hands = [&q](model::JointCommand& command) {
    command.q = q;
    command.kp.setConstant(20.0);
    command.kd.setConstant(2.0);
  };
  for (int k = 0; k < 1000; ++k) tick();
  hands = {};
  hang_obliquely(angle_rad, {std::cos(azimuth_rad), std::sin(azimuth_rad), 0.0});
  fmt::print("seed {}: {:.1f} degrees oblique\n", GetParam(), angle_rad / kRadPerDegree);
  const std::set<std::string> named = named_when_inverted();
  for (const char* joint : {"left_knee", "right_knee", "left_elbow", "right_elbow"}) {
    EXPECT_TRUE(named.contains(joint)) << joint;
    EXPECT_TRUE(confirmed_.contains(joint)) << joint;
  }
}

INSTANTIATE_TEST_SUITE_P(Hanging, InWhateverPosture, testing::Values(5U, 8U, 11U));

TEST_F(FirstLight, AJointMovesUntilItsLoadTellsItsGear) {
  JointVector q = sensed_.q;
  q[test::z1().joint_index.at("left_knee")] = 0.3;  // the bent leg's weight is off the hip's vertical
  EXPECT_NEAR(telling_way_rad(test::z1(), q, "waist_pitch"), 10.0 * kRadPerDegree, 1e-9) << "until the base leans";
  EXPECT_NEAR(telling_way_rad(test::z1(), q, "left_hip_yaw"), 20.0 * kRadPerDegree, 1e-9) << "the most";
  const double way_rad = telling_way_rad(test::z1(), q, "left_hip_pitch");
  EXPECT_LT(way_rad, 10.0 * kRadPerDegree);
  const auto load = model::hanging_load(test::z1(), "left_hip_pitch", q);
  EXPECT_NEAR(load.gravity_Nm * std::sin(way_rad), 1.5 * 3.0 * 0.6, 1e-9) << "its friction is 0.6 Nm";
}

TEST(FirstLightText, TheWayOfAKneeIsBackwardAndUp) {
  // Z1's knee bends the shank backward for a positive angle; standing, it is bent by 0.14 rad already.
  EXPECT_THAT(way_of(test::z1(), test::z1().q_stand(), "left_knee", 0.05), testing::HasSubstr("backward"));
  EXPECT_THAT(way_of(test::z1(), test::z1().q_stand(), "left_hip_pitch", -0.05), testing::HasSubstr("forward"));
  EXPECT_THAT(way_of(test::z1(), test::z1().q_stand(), "left_hip_roll", 0.05), testing::HasSubstr("to the left"));
}

TEST(FirstLightText, TheVerdictFollowsFromTheFigures) {
  using Tells = Verdict::Tells;
  const Wiggle good = {.asked_rad = 0.05,
                       .moved_rad = 0.045,
                       .held_Nm = 4.1,
                       .model_Nm = 4.5,
                       .model_inverted_Nm = -3.0,
                       .held_end_Nm = 5.6,
                       .model_end_Nm = 5.2,
                       .friction_Nm = 0.6};
  const auto expect = [](const Wiggle& wiggle, Tells tells, const char* text) {
    EXPECT_EQ(verdict(wiggle).tells, tells) << verdict(wiggle).text;
    EXPECT_THAT(verdict(wiggle).text, testing::HasSubstr(text));
  };
  expect(good, Tells::kAgrees, "direction and gear agree with the model");
  Wiggle wiggle = good;
  wiggle.held_Nm = -3.1;
  expect(wiggle, Tells::kWrong, "`direction` in robot.yaml is wrong");
  wiggle = good;
  wiggle.held_end_Nm = 14.04;
  expect(wiggle, Tells::kWrong, "2.7 times the model's load: look at `gear`");
  wiggle.held_Nm = -3.1;
  wiggle.inverted_end_Nm = -4.0;
  wiggle.held_end_Nm = -4.6;
  expect(wiggle, Tells::kWrong, "the load pulls the other way");
  wiggle = good;
  wiggle.leaned_rad = -0.05;
  wiggle.least_lean_rad = 0.06;
  expect(wiggle, Tells::kAgrees, "direction and gear agree");
  wiggle.least_lean_rad = 0.04;
  expect(wiggle, Tells::kNotAll, "its load says that `direction` is right, the base that leans says the opposite");
  wiggle.model_inverted_Nm = 4.4;
  expect(wiggle, Tells::kWrong, "the base leans the other way");
  wiggle.leaned_rad = 0.05;
  expect(wiggle, Tells::kAgrees, "direction and gear agree");
  wiggle = good;
  wiggle.held_Nm = 0.8;  // further from both than friction explains
  expect(wiggle, Tells::kNotAll, "would be the same the other way round");
  wiggle.inverted_beyond_rad = 0.2;
  expect(wiggle, Tells::kAgrees, "direction and gear agree");
  wiggle.held_Nm = -3.1;
  expect(wiggle, Tells::kNotAll, "its load says that `direction` is wrong, its range says the opposite");
  wiggle.on_stop = true;
  expect(wiggle, Tells::kAgrees, "direction and gear agree");
  wiggle.inverted_beyond_rad = 0.1;
  expect(wiggle, Tells::kNotAll, "would be the same the other way round");
  wiggle = good;
  wiggle.moved_rad = 0.01;
  wiggle.stopped_as_inverted = true;
  expect(wiggle, Tells::kWrong, "stopped where its range ends the other way round: `direction` in robot.yaml is wrong");
  wiggle = good;
  wiggle.asked_rad = -0.001;
  wiggle.moved_rad = -0.0012;
  expect(wiggle, Tells::kAgrees, "direction and gear agree");
  wiggle = good;
  wiggle.asked_down_rad = 0.1;
  wiggle.moved_down_rad = 0.02;
  expect(wiggle, Tells::kWrong, "less than half the way");
  wiggle = good;
  wiggle.model_inverted_Nm = 4.0;
  expect(wiggle, Tells::kNotAll, "would be the same the other way round");
  wiggle = good;
  wiggle.model_end_Nm = 1.0;
  wiggle.held_end_Nm = 1.5;
  expect(wiggle, Tells::kNotAll, "too small to tell the gear");
  wiggle.model_inverted_Nm = 4.0;
  expect(wiggle, Tells::kNotAll, "too small to tell direction and gear");
  wiggle = good;
  wiggle.moved_rad = 0.01;
  expect(wiggle, Tells::kWrong, "less than half the way");
  wiggle.moved_rad = -0.04;
  expect(wiggle, Tells::kWrong, "opposite signs");
}

}  // namespace
}  // namespace pmg::can
