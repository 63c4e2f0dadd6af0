// What robot.yaml says of the robot's EtherCAT cable.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "can/bus_setup.hpp"
#include "ethercat/master.hpp"
#include "ethercat/process_data_imu.hpp"
#include "model/robot_model.hpp"

namespace pmg::ethercat {

/// Where the drives of a bus are on the cable: behind a bridge, or slaves of their own. Positions begin with 1, and 0
/// is none; an alias is a configured station alias, and 0 is any.
struct BusPlace {
  int bridge = 0, channel = 0, bridge_alias = 0;
  int first_slave = 0, first_alias = 0;  ///< of node 1; node n is n - 1 further
};

/// robot.yaml's `ethercat`, and what its `buses` and `imu` say of the cable.
struct EthercatSetup {
  std::string interface;
  std::vector<BusPlace> buses;                    ///< in the order of can::DriveSetup's
  std::optional<ImuSlave> imu;                    ///< nullopt: the IMU speaks on a bus, or has a line of its own
  int frames_out = 0, frames_in = 0;              ///< room of a bridge's channel in a cycle; 0: there is no bridge
  std::uint32_t vendor_id = 0, product_code = 0;  ///< of the bridges; 0: any
  StartTiming timing{};                           ///< not of robot.yaml
};

/// Throws files::ConfigError when robot.yaml doesn't describe it, when a bus is neither behind a bridge nor one of
/// drives that are slaves, when two things have one slave or one channel, when a position of the cable has no slave,
/// when two slaves can't be told apart, or when a channel has too little room for its bus.
EthercatSetup load_ethercat(const model::RobotModel& robot, const can::DriveSetup& drives);

/// robot.yaml's `bridge` or `first_slave` of each bus. Throws files::ConfigError.
std::vector<BusPlace> load_places(const model::RobotModel& robot, const can::DriveSetup& drives);

/// Called with each drive that is a slave, in pre-operational: the bus's and the motor's index, and its objects.
using PrepareDrive = std::function<void(std::size_t bus, std::size_t motor, drives::ObjectDictionary& objects)>;

/// The slaves that these buses and the IMU need, in the cable's order.
std::vector<SlaveSetup> expected_slaves(const EthercatSetup& setup, const can::DriveSetup& drives,
                                        const PrepareDrive& prepare);

}  // namespace pmg::ethercat
