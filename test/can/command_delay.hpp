// How late the commands of a robot behind emulated drives act.
#pragma once

#include <limits>
#include <vector>

#include "can/robot_behind_drives.hpp"
#include "sim/robots.hpp"

namespace pmg::test {

/// (limp robot that hangs, its world, joints of one bus) => bus cycles from the moment in which their drives had a
/// state to the one in which the first one's, an MIT drive, takes the command computed from it; -1: it never takes it.
inline int command_delay_cycles(RobotBehindDrives& robot, sim::World& world, const std::vector<int>& joints) {
  constexpr int kSwings = 100, kMost = 10;  // 0.2 s, after which limp limbs swing
  model::JointCommand command = standing_command(z1());
  command.kp.setZero();
  command.kd.setZero();
  std::vector<model::RobotState> truth;
  const auto exchange = [&] {
    model::RobotState told;
    world.read(truth.emplace_back());
    robot.exchange(command, told);
    return told;
  };
  for (int cycle = 1; cycle < kSwings; ++cycle) exchange();
  const model::RobotState told = exchange();
  double nearest = std::numeric_limits<double>::infinity();
  int age_cycles = 0;
  for (int age = 0; age < kMost; ++age) {
    double distance = 0.0;
    for (const int j : joints)
      distance += std::abs(truth[truth.size() - 1U - static_cast<std::size_t>(age)].q[j] - told.q[j]);
    if (distance < nearest) nearest = distance, age_cycles = age;
  }
  // What is computed from that goes out in the next cycle.
  command.kd[joints.front()] = 1.0;
  for (int cycle = 1; cycle < kMost; ++cycle) {
    exchange();
    if (robot.acting().kd[joints.front()] > 0.5) return age_cycles + cycle;
  }
  return -1;
}

/// Indices of the motors of a bus, the last one's first.
inline std::vector<int> joints_of(const can::BusSetup& bus) {
  std::vector<int> joints;
  for (const drives::MotorSetup& motor : bus.motors) joints.insert(joints.begin(), motor.index);
  return joints;
}

}  // namespace pmg::test
