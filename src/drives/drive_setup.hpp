// The drives of a robot, from robot.yaml: `drives` (kinds of drives), `buses`, and each joint's `bus`.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drives/drive_kind.hpp"
#include "drives/motor.hpp"
#include "drives/rod_linkage.hpp"
#include "drives/transmission.hpp"
#include "model/robot_model.hpp"

namespace pmg::drives {

struct MotorSetup {
  std::string joint;
  int index = 0;  ///< in joint order
  int node = 0;
  DriveKind drive;
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
  std::string name;                                    ///< of the network interface
  int bitrate = 0;                                     ///< [bit/s]
  int data_bitrate = 0;                                ///< of CAN FD frames' data phase [bit/s]; 0: classic CAN
  double sample_point = 0.0, data_sample_point = 0.0;  ///< share of a bit; 0: not said
  bool imu = false;                                    ///< the robot's IMU sends on this bus
  int bridge_slave = 0, bridge_channel = 0;  ///< EtherCAT slave that bridges this bus, the first being 1; 0: none
  int bridge_alias = 0;                      ///< configured station alias of that slave; 0: any
  int first_slave = 0;  ///< its drives are EtherCAT slaves: node n is slave first_slave + n - 1; 0: no
  int first_alias = 0;  ///< alias of node 1, that of node n being first_alias + n - 1; 0: any
  std::vector<MotorSetup> motors;
  std::vector<LinkedMotors<1>> four_bars;
  std::vector<LinkedMotors<2>> parallel;

  bool has_canopen() const;  ///< some motor's drive is a CiA 402 one
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

/// Reads robot.directory/robot.yaml. Throws files::ConfigError when a joint has no drive, when its drive doesn't cover
/// the joint's range, speed, effort or gains, when a bus isn't described or can't carry its drives' protocols together,
/// when the number of buses with the IMU isn't one (none with `imu.serial`), when the joints of a linkage have drives
/// on two buses or drives that can't be told any gains, or when a linkage is close to a singularity within its joints'
/// ranges.
DriveSetup load_drives(const model::RobotModel& robot);

}  // namespace pmg::drives
