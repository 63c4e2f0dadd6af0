// Linkages of Z1's ankles and waist, which robot.yaml has without any.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <utility>

#include "can/bus_setup.hpp"
#include "drive_protocols/mit_drive.hpp"
#include "model/robot_model.hpp"

namespace pmg::test {

/// Two motors beside each other turn two joints through upright rods behind them. below_m: the motors, under the
/// joints' centre; negative: above. The drives cover what the cranks need.
inline void link_pair(can::DriveSetup& setup, const model::RobotModel& robot, const std::string& first,
                      const std::string& second, double below_m) {
  const auto bus = std::ranges::find_if(setup.buses, [&](const can::BusSetup& one) {
    return std::ranges::find(one.motors, first, &drives::MotorSetup::joint) != one.motors.end();
  });
  const auto at = [&](const std::string& joint) {
    return static_cast<std::size_t>(std::ranges::find(bus->motors, joint, &drives::MotorSetup::joint) -
                                    bus->motors.begin());
  };
  const std::array<std::size_t, 2> motors = {at(first), at(second)};
  const auto rod = [below_m](double y) {
    return drives::CrankAndRod{.crank_centre_m = {0.0, y, -below_m},
                               .axis = {0.0, 1.0, 0.0},
                               .crank_end_m = {-0.05, y, -below_m},
                               .rod_end_m = {-0.05, y, 0.0}};
  };
  const auto joint = [&](std::size_t m) -> const model::Joint& {
    return robot.joints[static_cast<std::size_t>(bus->motors[m].index)];
  };
  drives::LinkedMotors<2> linked{
      .motors = motors,
      .linkage = drives::RodLinkage<2>({joint(motors[0]).axis, joint(motors[1]).axis}, {rod(0.05), rod(-0.05)})};
  drives::RodLinkage<2>::Commands gains{};
  for (std::size_t i = 0; i < 2; ++i) {
    const model::Joint& one = joint(motors[i]);
    linked.joints[i] = {.q_lower_rad = one.lower_rad,
                        .q_upper_rad = one.upper_rad,
                        .dq_rad_s = one.velocity_limit_rad_s,
                        .torque_Nm = one.effort_limit_Nm};
    gains[i].kp_Nm_per_rad = one.kp_Nm_per_rad;
    gains[i].kd_Nm_s_per_rad = one.kd_Nm_s_per_rad;
  }
  const auto needs = linked.linkage.needs(linked.joints, gains);
  for (std::size_t i = 0; i < 2; ++i) {
    drives::MotorSetup& motor = bus->motors[motors[i]];
    motor.limits = motor.transmission.to_motor(needs[i].limits);
    drives::MitRanges ranges = drives::as_mit(motor.drive)->ranges();
    ranges.velocity_rad_s = std::max(ranges.velocity_rad_s, motor.limits.dq_rad_s);
    ranges.torque_Nm = std::max(ranges.torque_Nm, motor.limits.torque_Nm);
    motor.drive = drives::mit_drive(ranges);
  }
  bus->parallel.push_back(linked);
}

/// Who connected the motors of a bus's first linkage made mistakes: robot.yaml has them otherwise.
inline void connect_otherwise(can::BusSetup& bus, const model::RobotModel& robot, bool swapped,
                              std::array<bool, 2> inverted) {
  for (std::size_t i = 0; i < 2; ++i) {
    // The motor that robot.yaml has as the i-th turns this crank.
    drives::MotorSetup& motor = bus.motors[bus.parallel[0].motors[swapped ? 1 - i : i]];
    if (!inverted[i]) continue;
    model::BusAddress address = robot.joints[static_cast<std::size_t>(motor.index)].bus;
    address.direction = -address.direction;
    motor.transmission = drives::Transmission(address);
    std::swap(motor.limits.q_lower_rad, motor.limits.q_upper_rad);
    motor.limits.q_lower_rad = -motor.limits.q_lower_rad;
    motor.limits.q_upper_rad = -motor.limits.q_upper_rad;
  }
  if (swapped) std::swap(bus.motors[bus.parallel[0].motors[0]].node, bus.motors[bus.parallel[0].motors[1]].node);
}

}  // namespace pmg::test
