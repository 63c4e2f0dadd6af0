// motor.yaml: written files read back, wrong files are refused, and a world's drives follow the file.
#include "sim/motor_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "files/config_error.hpp"
#include "generator_core/allocation_count.hpp"
#include "sim/motors_in_force.hpp"
#include "sim/robots.hpp"
#include "sim/world.hpp"
#include "temporary_folder.hpp"

namespace pmg::sim {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

class MotorFile : public testing::Test {
 protected:
  ~MotorFile() override { fs::remove(file_); }
  void write(const std::string& text) const { std::ofstream(file_) << text; }
  std::string refusal() const {
    try {
      read_motor_file(file_, robot_.joint_index);
    } catch (const files::ConfigError& error) {
      return error.what();
    }
    return "accepted";
  }
  const model::RobotModel& robot_ = z1();
  const std::string joint_ = robot_.joint_index.name(0);
  const test::TemporaryFolder folder_;
  const fs::path file_ = folder_.file("motor.yaml");
};

TEST_F(MotorFile, HoldsEveryParameterExactly) {
  model::ActuatorParameters all;
  double number = 0.013;
  for (const model::ActuatorParameter& p : model::actuator_parameters()) p.in(all) = number *= 1.05;
  all.transmission.backlash_rad = 0.01;
  all.sensor.angle_scale = 1.013;  // more than the disc wobbles
  all.sensor.lag_stages = 2.0;     // whole numbers only
  write(motor_yaml({{joint_, all}, {robot_.joint_index.name(1), {}}}, {"made by a test"}));
  const ActuatorsByJoint read = read_motor_file(file_, robot_.joint_index);
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read.at(joint_), all);
  EXPECT_EQ(read.at(robot_.joint_index.name(1)), model::ActuatorParameters{});
}

TEST_F(MotorFile, IsRefusedWithPlaceAndReason) {
  write("joints:\n  " + joint_ + ":\n    friction: {coulomb: 1}\n");
  EXPECT_THAT(refusal(), AllOf(HasSubstr("motor.yaml:3"), HasSubstr("friction.coulomb"), HasSubstr("unknown")));
  write("joints:\n  " + joint_ + ":\n    frictions: {coulomb_Nm: 1}\n");
  EXPECT_THAT(refusal(), AllOf(HasSubstr("motor.yaml:3"), HasSubstr("frictions"), HasSubstr("unknown")));
  write("joints:\n  " + joint_ + ":\n    friction: {coulomb_Nm: -1}\n");
  EXPECT_THAT(refusal(), AllOf(HasSubstr("motor.yaml:3"), HasSubstr("coulomb_Nm"), HasSubstr("at least 0")));
  write("joints:\n  " + joint_ + ":\n    command: {delay_s: 3}\n");
  EXPECT_THAT(refusal(), AllOf(HasSubstr(joint_), HasSubstr("delay")));
  write("joints:\n  tail: {}\n");
  EXPECT_THAT(refusal(), AllOf(HasSubstr("motor.yaml:2"), HasSubstr("tail"), HasSubstr("joint")));
}

WorldOptions on_gantry() {
  WorldOptions options;
  options.gantry = true;
  return options;
}

model::JointCommand hold(const model::RobotModel& robot) {
  model::JointCommand command = standing_command(robot);
  command.q[0] += 0.05;
  return command;
}

model::RobotState after(World& world, const model::JointCommand& command, int steps) {
  model::RobotState state;
  for (int k = 0; k < steps; ++k) world.step(command);
  world.read(state);
  return state;
}

TEST_F(MotorFile, WhatIsAnotherFileIsToldWhichOneIsExpected) {
  const auto refused = [](const fs::path& file) -> std::string {
    try {
      read_motor_file(file);
    } catch (const files::ConfigError& error) {
      return error.what();
    }
    return "accepted";
  };
  const std::string robot = refused("config/robots/z1/robot.yaml");
  EXPECT_THAT(robot, AllOf(HasSubstr("is of a robot; expected a motor.yaml, as pmg_calibrate_motor"), HasSubstr(":")));
  write("{\"parameters\": 3}\n");
  EXPECT_THAT(refusal(), HasSubstr("joints: is missing; expected a motor.yaml, as pmg_calibrate_motor"));
  const fs::path folder = file_.string() + "_results";
  fs::create_directories(folder);
  EXPECT_THAT(refused(folder), HasSubstr("is a folder"));
  std::ofstream(folder / "motor.yaml") << "joints: {}\n";
  EXPECT_EQ(refused(folder), folder.string() + ": is a folder; did you mean " + (folder / "motor.yaml").string() + "?");
  fs::remove_all(folder);
}

TEST_F(MotorFile, IsTheOneThatIsNamedOrElseTheRobots) {
  write("joints: {" + joint_ + ": {friction: {coulomb_Nm: 0.7}}}\n");
  EXPECT_TRUE(motors_in_force(robot_, "none").empty());
  EXPECT_EQ(motors_in_force(robot_, file_).at(joint_).friction.coulomb_Nm, 0.7);
  const fs::path copy = folder_.file("robot that names its motors");
  fs::copy(robot_.directory, copy, fs::copy_options::recursive);
  std::ofstream(copy / "robot.yaml", std::ios::app) << "\nmotor: motor.yaml\n";
  fs::copy_file(file_, copy / "motor.yaml");
  const model::RobotModel named = model::load_robot(copy);
  EXPECT_EQ(motors_in_force(named, "").at(joint_).friction.coulomb_Nm, 0.7);
  EXPECT_TRUE(motors_in_force(named, "none").empty());
}

TEST_F(MotorFile, LeavesToTheRobotWhatItDoesntSay) {
  const model::Joint& joint = robot_.joints[0];
  const auto expect_robots = [&](const model::ActuatorParameters& p) {
    EXPECT_EQ(p.drive.limit, joint.effort_limit_Nm);
    EXPECT_EQ(p.transmission.armature_kg_m2, joint.armature_kg_m2);
    EXPECT_EQ(p.friction.coulomb_Nm, joint.friction_Nm);
    EXPECT_EQ(p.friction.viscous_Nm_s_per_rad, joint.damping_Nm_s_per_rad);
  };
  expect_robots(actuator_in_force(joint, {}));
  model::ActuatorParameters late;
  late.command.delay_s = 0.01;
  expect_robots(actuator_in_force(joint, {{joint.name, late}}));
  model::ActuatorParameters other;
  other.drive.limit = 3.0, other.transmission.armature_kg_m2 = 0.5, other.friction.viscous_Nm_s_per_rad = 2.0;
  EXPECT_EQ(actuator_in_force(joint, {{joint.name, other}}), other) << "viscous friction alone: no dry friction";
}

TEST_F(MotorFile, ThatSaysNothingChangesNothing) {
  World plain(robot_, on_gantry());
  WorldOptions options = on_gantry();
  for (const std::string& name : robot_.joint_index.names()) options.motors[name] = {};
  World neutral(robot_, options);
  const model::JointCommand command = hold(robot_);
  const model::RobotState expected = after(plain, command, 250), got = after(neutral, command, 250);
  EXPECT_GT((expected.q - robot_.q_stand()).cwiseAbs().maxCoeff(), 0.03);
  EXPECT_EQ(expected.q, got.q);
}

TEST_F(MotorFile, MakesTheSimulatedDriveLate) {
  WorldOptions options = on_gantry();
  options.motors[joint_].command.delay_s = 0.1;
  World world(robot_, options), prompt(robot_, on_gantry());
  const model::JointCommand command = hold(robot_);
  const double late_rad = after(world, command, 40).q[0], prompt_rad = after(prompt, command, 40).q[0];
  EXPECT_LT(std::abs(late_rad - robot_.q_stand()[0]), 0.3 * std::abs(prompt_rad - robot_.q_stand()[0]));
}

TEST_F(MotorFile, CostsAWorldNoHeap) {
  PMG_SKIP_IF_HEAP_IS_NOT_COUNTED();
  WorldOptions options = on_gantry();
  options.motors[joint_].friction = {.coulomb_Nm = 0.5, .load_driving = 0.2};
  World world(robot_, options);
  const model::JointCommand command = hold(robot_);
  world.step(command);
  const long before = test::allocation_count();
  for (int k = 0; k < 20; ++k) world.step(command);
  EXPECT_EQ(test::allocation_count(), before);
}

}  // namespace
}  // namespace pmg::sim
