#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "robots.hpp"
#include "sim/world.hpp"

namespace pmg {
namespace {

double torso_tilt_rad(const model::GroundTruth& truth) {
  return std::acos(std::clamp((truth.q_WT * Eigen::Vector3d::UnitZ()).z(), -1.0, 1.0));
}

TEST(Gantry, HoldsTheRobotStillInTheAir) {
  for (const model::RobotModel* robot : {&z1(), &biped()}) {
    sim::WorldOptions options;
    options.gantry = true;
    sim::World world(*robot, options);
    const model::JointCommand command = standing_command(*robot);
    for (int i = 0; i < 2500; ++i) {
      world.step(command);
      ASSERT_EQ(world.truth().foot_force_N[kLeft] + world.truth().foot_force_N[kRight], 0.0) << robot->name << " " << i;
    }
    const model::GroundTruth truth = world.truth();
    EXPECT_LT(truth.v_WB_W.norm(), 0.005) << robot->name;
    EXPECT_LT(truth.omega_WB_B.norm(), 0.01) << robot->name;
    EXPECT_LT(torso_tilt_rad(truth), 0.15) << robot->name;
    EXPECT_NEAR(truth.p_WB.z(), robot->standing_height_m + 0.18, 0.02) << robot->name;
  }
}

TEST(Gantry, TakesAStandingRobotUpAndSetsItDownAgain) {
  sim::World world(z1(), {});
  const model::JointCommand command = standing_command(z1());
  const auto ramp = [&](double lift_from, double lift_to, double engaged_from, double engaged_to, int steps) {
    for (int i = 1; i <= steps; ++i) {
      const double s = static_cast<double>(i) / steps;
      world.set_hoist(lift_from + s * (lift_to - lift_from), engaged_from + s * (engaged_to - engaged_from));
      world.step(command);
      ASSERT_LT(torso_tilt_rad(world.truth()), 0.2);
    }
  };
  ramp(0.0, 0.0, 0.0, 0.0, 500);
  ramp(0.0, 0.0, 0.0, 1.0, 250);
  ramp(0.0, 0.2, 1.0, 1.0, 1000);
  ramp(0.2, 0.2, 1.0, 1.0, 500);
  EXPECT_GT(world.truth().p_WB.z(), z1().standing_height_m + 0.15);
  EXPECT_EQ(world.truth().foot_force_N[kLeft], 0.0);
  ramp(0.2, 0.0, 1.0, 1.0, 1000);
  ramp(0.0, 0.0, 1.0, 0.0, 250);
  ramp(0.0, 0.0, 0.0, 0.0, 2500);
  EXPECT_NEAR(world.truth().p_WB.z(), z1().standing_height_m, 0.02);
  EXPECT_GT(world.truth().foot_force_N[kLeft], 0.3 * z1().total_mass_kg * 9.81);
}

TEST(Gantry, LetsTheLegsMoveFreely) {
  sim::WorldOptions options;
  options.gantry = true;
  sim::World world(z1(), options);
  model::JointCommand command = standing_command(z1());
  const int left = z1().joint_index.at("left_hip_pitch"), right = z1().joint_index.at("right_hip_pitch");
  double greatest_tilt_rad = 0.0;
  for (int i = 0; i < 2500; ++i) {
    const double swing = 0.5 * std::sin(2.0 * 3.14159265358979 * 0.002 * i);
    command.q[left] = -0.15 + swing;
    command.q[right] = -0.15 - swing;
    world.step(command);
    greatest_tilt_rad = std::max(greatest_tilt_rad, torso_tilt_rad(world.truth()));
    ASSERT_EQ(world.truth().foot_force_N[kLeft], 0.0);
  }
  EXPECT_LT(greatest_tilt_rad, 0.2);
}

TEST(Gantry, PullsBackWhatIsPushedAside) {
  sim::WorldOptions options;
  options.gantry = true;
  sim::World world(z1(), options);
  const model::JointCommand command = standing_command(z1());
  for (int i = 0; i < 1500; ++i) world.step(command);
  const double before = world.truth().p_WB.x();
  world.set_push({30.0, 0.0, 0.0});
  for (int i = 0; i < 1500; ++i) world.step(command);
  const double pushed = world.truth().p_WB.x() - before;
  EXPECT_GT(pushed, 0.001);
  EXPECT_LT(pushed, 0.05);
  world.set_push(Eigen::Vector3d::Zero());
  for (int i = 0; i < 1500; ++i) world.step(command);
  EXPECT_NEAR(world.truth().p_WB.x(), before, 0.001);
}

TEST(Gantry, DisengagedItDoesNothing) {
  sim::World free(z1(), {}), hoisted(z1(), {});
  const model::JointCommand command = standing_command(z1());
  for (int i = 0; i < 200; ++i) {
    hoisted.set_hoist(0.3, 0.0);
    free.step(command);
    hoisted.step(command);
  }
  EXPECT_EQ(free.truth().p_WB, hoisted.truth().p_WB);
}

}  // namespace
}  // namespace pmg
