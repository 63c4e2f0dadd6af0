// The motors of a robot, from robot.yaml: `drives` (kinds of drives), each joint's `bus`, and `linkages`.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "drives/drive_catalogue.hpp"
#include "drives/motor.hpp"
#include "drives/rod_linkage.hpp"
#include "drives/transmission.hpp"
#include "model/robot_model.hpp"

namespace pmg::drives {

struct MotorSetup {
  std::string joint;
  int index = 0;  ///< in joint order
  int node = 0;
  DriveKind drive;  ///< never null
  Transmission transmission;
  MotorLimits limits;  ///< the joint's, at the motor
};

/// Motors that turn their joints through cranks and rods. A motor's transmission then leads from its crank to its
/// drive.
template <int N>
struct LinkedMotors {
  std::array<std::size_t, static_cast<std::size_t>(N)>
      motors{};  ///< in the group's motors; the i-th has the i-th joint's bus address
  RodLinkage<N> linkage;
  std::array<MotorLimits, static_cast<std::size_t>(N)> joints{};  ///< the joints' limits
};

/// Motors that are reached the same way, and the linkages among them.
struct MotorGroup {
  std::string name{};  ///< of the way: a bus
  std::vector<MotorSetup> motors{};
  std::vector<LinkedMotors<1>> four_bars{};
  std::vector<LinkedMotors<2>> parallel{};
};

/// Of the drives that have one; null: none has. Drives of different networks don't share a bus (can::load_drives()).
std::unique_ptr<Network> network_of(const MotorGroup& group);

/// (what each motor of a group says, as its drive has it; nullopt: nothing) => (the same at each motor's joint),
/// through transmissions, cranks and rods. Nullopt where a motor of a linkage says nothing, or no joint angles belong
/// to the cranks'. Not for the bus thread: RobotDrives keeps the last angles as a guess.
using Readings = std::vector<std::optional<MotorReading>>;
Readings joint_readings(const MotorGroup& group, const Readings& motors);

/// "left_knee (can0, node 4)"
std::string name_of(const MotorGroup& group, const MotorSetup& motor);

/// Of robot.yaml's mapping: a group for each bus that joints name, in their order. buses: that are described. Throws
/// files::ConfigError when a joint has no drive, when its drive doesn't cover the joint's range, speed, effort or
/// gains, when a bus isn't described, when the joints of a linkage have drives on two buses or drives that can't be
/// told any gains, or when a linkage is close to a singularity within its joints' ranges.
std::vector<MotorGroup> read_motor_groups(const model::RobotModel& robot, files::ConfigReader& reader,
                                          const DriveCatalogue& catalogue, const std::set<std::string>& buses);

}  // namespace pmg::drives
