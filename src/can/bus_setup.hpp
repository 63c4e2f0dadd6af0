// The buses of a robot and the motors on them, from robot.yaml's `buses`: bit rates, where the IMU speaks.
#pragma once

#include <string>
#include <vector>

#include "drive_protocols/standard_drives.hpp"
#include "drives/motor_group.hpp"

namespace pmg::can {

/// Its name is that of the network interface.
struct BusSetup : drives::MotorGroup {
  int bitrate = 0;                                     ///< [bit/s]
  int data_bitrate = 0;                                ///< of CAN FD frames' data phase [bit/s]; 0: classic CAN
  double sample_point = 0.0, data_sample_point = 0.0;  ///< share of a bit; 0: not said
  bool imu = false;                                    ///< the robot's IMU sends on this bus
  bool relayed = false;  ///< another network carries its frames there and back, and makes them later
  bool on_can = true;    ///< false: its drives are members of another network, which asks them itself

  bool has_canopen() const;  ///< some motor's drive is a CiA 402 one
  /// For a monitor of one of its motors: see drives::MotorMonitor.
  int fresh_cycles() const noexcept;
};

struct DriveSetup {
  std::vector<BusSetup> buses;     ///< those that joints name, in their order
  bool imu_on_can_or_line = true;  ///< false: the IMU is a member of another network
};

/// Reads robot.directory/robot.yaml, but for what another network alone needs to know of a bus (src/ethercat). Throws
/// files::ConfigError as drives::read_motor_groups() does, when a bus can't carry its drives' protocols together, or
/// when the number of buses with the IMU isn't one (none with `imu.serial`).
DriveSetup load_drives(const model::RobotModel& robot,
                       const drives::DriveCatalogue& catalogue = drives::standard_drives());

}  // namespace pmg::can
