// Z1 with drives of both protocols and modes, on buses that carry them.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "can/bus_load.hpp"
#include "can/bus_setup.hpp"
#include "drive_protocols/canopen_drive.hpp"
#include "model/robot_model.hpp"

namespace pmg::test {

inline constexpr std::uint32_t kMixedReplyId = 0x7E;

/// A CiA 402 drive that covers this motor and has its joint's gains.
inline drives::Cia402Settings cia402_for(const drives::MotorSetup& motor, const model::RobotModel& robot,
                                         drives::Cia402Mode mode) {
  const model::Joint& joint = robot.joints[static_cast<std::size_t>(motor.index)];
  drives::MotorCommand gains;
  gains.kp_Nm_per_rad = joint.kp_Nm_per_rad;
  gains.kd_Nm_s_per_rad = joint.kd_Nm_s_per_rad;
  gains = motor.transmission.to_motor(gains);
  drives::Cia402Settings settings{.mode = mode,
                                  .counts_per_turn = 65536.0,
                                  .velocity_unit_rad_s = 1e-3,
                                  .rated_torque_Nm = motor.limits.torque_Nm / 3.0,
                                  .largest_torque_Nm = motor.limits.torque_Nm};
  if (mode == drives::Cia402Mode::kPosition) {
    settings.kp_Nm_per_rad = gains.kp_Nm_per_rad;
    settings.kd_Nm_s_per_rad = gains.kd_Nm_s_per_rad;
  }
  settings.temperature_index = 0x2030;
  settings.temperature_subindex = 1;
  settings.temperature_unit_degC = 0.1;
  return settings;
}

/// Every bus of robot.yaml becomes two: three CiA 402 motors each, then the rest as they are. Legs and waist are in
/// torque mode, the others in position mode. One bus has both protocols.
inline can::DriveSetup mixed_drives(const model::RobotModel& robot) {
  can::DriveSetup setup = can::load_drives(robot), mixed;
  for (can::BusSetup& bus : setup.buses) {
    can::BusSetup canopen = bus, rest = bus;
    canopen.imu = false;
    canopen.name += "a";
    rest.name += "b";
    canopen.motors.assign(bus.motors.begin(), bus.motors.begin() + 3);
    rest.motors.assign(bus.motors.begin() + 3, bus.motors.end());
    for (drives::MotorSetup& motor : canopen.motors) {
      const bool arm = bus.name == "can2" || bus.name == "can3";
      motor.drive = drives::cia402_drive(
          cia402_for(motor, robot, arm ? drives::Cia402Mode::kPosition : drives::Cia402Mode::kTorque));
    }
    if (bus.name == "can0") {
      canopen.motors.push_back(rest.motors.front());
      rest.motors.erase(rest.motors.begin());
      canopen.motors.back().drive = canopen.motors.back().drive->replying_as(kMixedReplyId);
    }
    mixed.buses.push_back(std::move(canopen));
    mixed.buses.push_back(std::move(rest));
  }
  can::check_load(mixed);
  return mixed;
}

}  // namespace pmg::test
