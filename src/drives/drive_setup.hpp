// The drives of a robot, from robot.yaml: `drives` (kinds of drives), `buses`, and each joint's `bus`.
#pragma once

#include <string>
#include <vector>

#include "drives/mit_protocol.hpp"
#include "drives/motor.hpp"
#include "drives/transmission.hpp"
#include "model/robot_model.hpp"

namespace pmg::drives {

struct MotorSetup {
  std::string joint;
  int index = 0;  ///< in joint order
  int node = 0;
  MitRanges ranges;
  Transmission transmission;
  MotorLimits limits;  ///< the joint's, at the motor
};

struct BusSetup {
  std::string name;      ///< of the network interface
  int bitrate = 0;       ///< [bit/s]
  int data_bitrate = 0;  ///< of CAN FD frames' data phase [bit/s]; 0: classic CAN
  bool imu = false;      ///< the robot's IMU sends on this bus
  std::vector<MotorSetup> motors;
};

struct DriveSetup {
  std::vector<BusSetup> buses;  ///< those that joints name, in their order
};

/// Reads robot.directory/robot.yaml. Throws model::ConfigError when a joint has no drive, when a field of its drive's
/// frames doesn't cover the joint's range, speed, effort or gains, when a bus isn't described, or when the number of
/// buses with the IMU isn't one.
DriveSetup load_drives(const model::RobotModel& robot);

}  // namespace pmg::drives
