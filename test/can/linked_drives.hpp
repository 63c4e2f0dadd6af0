// Linkages of Z1's ankles and waist, which robot.yaml has without any.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "can/bus_setup.hpp"
#include "drive_protocols/mit_drive.hpp"
#include "model/robot_model.hpp"
#include "model/robots.hpp"

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
                               .crank_end_m = {-0.08, y, -below_m},
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
  linked.linkage.check_ranges({linked.joints[0].q_lower_rad, linked.joints[1].q_lower_rad},
                              {linked.joints[0].q_upper_rad, linked.joints[1].q_upper_rad});
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

/// How somebody connected the motors of a linkage, against robot.yaml.
struct Connected {
  bool swapped = false;
  std::array<bool, 2> inverted{};
};

inline std::vector<Connected> all_ways_to_connect() {
  std::vector<Connected> all;
  for (const bool swapped : {false, true}) {
    for (const bool first : {false, true}) {
      for (const bool second : {false, true}) all.push_back({swapped, {first, second}});
    }
  }
  return all;
}

/// As pmg_bus says it; empty: as robot.yaml has it.
inline std::string words_of(const Connected& truth, const std::string& first, const std::string& second) {
  std::string words = truth.swapped ? fmt::format("the motors of {} and {} are swapped", first, second) : "";
  for (std::size_t i = 0; i < 2; ++i) {
    if (!truth.inverted[i]) continue;
    words +=
        (words.empty() ? "" : ", and ") + fmt::format("`direction` of {}'s motor is wrong", i == 0 ? first : second);
  }
  return words;
}

using CrankAngles = drives::RodLinkage<2>::Angles;

/// (of the motors as robot.yaml has them) => (of the cranks), angles or torques.
inline CrankAngles cranks_of(const Connected& truth, const CrankAngles& motors) {
  CrankAngles cranks;
  for (Eigen::Index i = 0; i < 2; ++i)
    cranks[truth.swapped ? 1 - i : i] = (truth.inverted[static_cast<std::size_t>(i)] ? -1.0 : 1.0) * motors[i];
  return cranks;
}
/// The other way.
inline CrankAngles motors_of(const Connected& truth, const CrankAngles& cranks) {
  CrankAngles motors;
  for (Eigen::Index i = 0; i < 2; ++i)
    motors[i] = (truth.inverted[static_cast<std::size_t>(i)] ? -1.0 : 1.0) * cranks[truth.swapped ? 1 - i : i];
  return motors;
}

/// Z1 with one linkage.
inline can::DriveSetup z1_with(const std::string& first, const std::string& second, double below_m) {
  can::DriveSetup setup = can::load_drives(z1());
  link_pair(setup, z1(), first, second, below_m);
  return setup;
}
inline const can::BusSetup& bus_of(const can::DriveSetup& setup) {
  return *std::ranges::find_if(setup.buses, [](const can::BusSetup& bus) { return !bus.parallel.empty(); });
}
inline const drives::MotorSetup& first_motor(const can::BusSetup& bus) { return bus.motors[bus.parallel[0].motors[0]]; }

/// Who connected the motors of a bus's first linkage made mistakes: robot.yaml has them otherwise.
inline void connect_otherwise(can::BusSetup& bus, const model::RobotModel& robot, const Connected& truth) {
  for (std::size_t i = 0; i < 2; ++i) {
    // The motor that robot.yaml has as the i-th turns this crank.
    drives::MotorSetup& motor = bus.motors[bus.parallel[0].motors[truth.swapped ? 1 - i : i]];
    if (!truth.inverted[i]) continue;
    model::BusAddress address = robot.joints[static_cast<std::size_t>(motor.index)].bus;
    address.direction = -address.direction;
    motor.transmission = drives::Transmission(address);
    std::swap(motor.limits.q_lower_rad, motor.limits.q_upper_rad);
    motor.limits.q_lower_rad = -motor.limits.q_lower_rad;
    motor.limits.q_upper_rad = -motor.limits.q_upper_rad;
  }
  if (truth.swapped) std::swap(bus.motors[bus.parallel[0].motors[0]].node, bus.motors[bus.parallel[0].motors[1]].node);
}

}  // namespace pmg::test
