// The drives of a robot, from robot.yaml: `drives` (kinds of drives), `buses`, and each joint's `bus`.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "drives/mit_protocol.hpp"
#include "drives/motor.hpp"
#include "drives/rod_linkage.hpp"
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

/// Motors that turn their joints through cranks and rods. A motor's transmission then leads from its crank to its
/// drive.
template <int N>
struct LinkedMotors {
  std::array<std::size_t, static_cast<std::size_t>(N)>
      motors{};  ///< in the bus's motors; the i-th has the i-th joint's bus address
  RodLinkage<N> linkage;
};

struct BusSetup {
  std::string name;      ///< of the network interface
  int bitrate = 0;       ///< [bit/s]
  int data_bitrate = 0;  ///< of CAN FD frames' data phase [bit/s]; 0: classic CAN
  bool imu = false;      ///< the robot's IMU sends on this bus
  std::vector<MotorSetup> motors;
  std::vector<LinkedMotors<1>> four_bars;
  std::vector<LinkedMotors<2>> parallel;
};

struct DriveSetup {
  std::vector<BusSetup> buses;  ///< those that joints name, in their order
};

/// Reads robot.directory/robot.yaml. Throws files::ConfigError when a joint has no drive, when a field of its drive's
/// frames doesn't cover the joint's range, speed, effort or gains, when a bus isn't described, or when the number of
/// buses with the IMU isn't one, when the joints of a linkage have drives on two buses, or when a linkage is close to a
/// singularity within its joints' ranges.
DriveSetup load_drives(const model::RobotModel& robot);

}  // namespace pmg::drives
