// The buses of a robot and the motors on them, from robot.yaml's `buses`: bit rates, bridges, where the IMU speaks.
#pragma once

#include <cstdint>
#include <optional>
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
  int bridge_slave = 0, bridge_channel = 0;  ///< EtherCAT slave that bridges this bus, the first being 1; 0: none
  int bridge_alias = 0;                      ///< configured station alias of that slave; 0: any
  int first_slave = 0;  ///< its drives are EtherCAT slaves: node n is slave first_slave + n - 1; 0: no
  int first_alias = 0;  ///< alias of node 1, that of node n being first_alias + n - 1; 0: any

  bool has_canopen() const;  ///< some motor's drive is a CiA 402 one
  /// For a monitor of one of its motors: see drives::MotorMonitor.
  int fresh_cycles() const noexcept;
};

/// An IMU that is an EtherCAT slave (src/ethercat). Numbers are low byte first; offsets in bytes within its inputs.
struct ImuSlave {
  int slave = 0;                                  ///< position on the cable, the first being 1
  int alias = 0;                                  ///< configured station alias; 0: any
  std::uint32_t vendor_id = 0, product_code = 0;  ///< 0: any
  int input_bytes = 0, output_bytes = 0;
  int counter_at = 0;       ///< 2 bytes, another value with each sample
  int status_at = -1;       ///< 2 bytes, 0: self-test passed and sensors in their range; -1: not given
  int quaternion_at = 0;    ///< w, x, y, z; 32-bit floats, as all that follows
  int rate_of_turn_at = 0;  ///< x, y, z [rad/s]
  int acceleration_at = 0;  ///< x, y, z [m/s^2]
};

struct DriveSetup {
  std::vector<BusSetup> buses;        ///< those that joints name, in their order
  std::optional<ImuSlave> imu_slave;  ///< nullopt: the IMU speaks on a bus, or has a line of its own
};

/// Reads robot.directory/robot.yaml. Throws files::ConfigError as drives::read_motor_groups() does, when a bus can't
/// carry its drives' protocols together, or when the number of buses with the IMU isn't one (none with `imu.serial`).
DriveSetup load_drives(const model::RobotModel& robot,
                       const drives::DriveCatalogue& catalogue = drives::standard_drives());

}  // namespace pmg::can
