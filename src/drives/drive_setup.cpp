#include "drives/drive_setup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "model/config_reader.hpp"

namespace pmg::drives {

namespace {

constexpr int kMostNode = 127;  // CANopen's; MIT-derived drives take it too

MitRanges read_ranges(model::ConfigReader reader) {
  reader.one_of("protocol", {"mit"});
  const MitRanges ranges = {.position_rad = reader.required<double>("position_rad", model::positive()),
                            .velocity_rad_s = reader.required<double>("velocity_rad_s", model::positive()),
                            .torque_Nm = reader.required<double>("torque_Nm", model::positive()),
                            .kp_Nm_per_rad = reader.required<double>("kp_Nm_per_rad", model::positive()),
                            .kd_Nm_s_per_rad = reader.required<double>("kd_Nm_s_per_rad", model::positive())};
  reader.finish();
  return ranges;
}

BusSetup read_bus(model::ConfigReader reader, const std::string& name) {
  BusSetup bus;
  bus.name = name;
  bus.bitrate = reader.required<int>("bitrate", model::in_range(10'000, 1'000'000));
  bus.data_bitrate = reader.optional<int>("data_bitrate", 0, model::in_range(bus.bitrate, 8'000'000));
  if (reader.has("imu")) bus.imu = reader.one_of("imu", {"xsens_can"}) == "xsens_can";
  reader.finish();
  return bus;
}

/// Throws when a field of the drive's frames doesn't cover what the joint needs.
void check_covers(const MitRanges& ranges, const MotorSetup& motor, const MotorCommand& gains, const std::string& drive,
                  model::ConfigReader& reader) {
  const struct {
    const char *field, *what;
    double needs, covers;
  } checks[] = {
      {"position_rad", "range", std::max(std::abs(motor.limits.q_lower_rad), std::abs(motor.limits.q_upper_rad)),
       ranges.position_rad},
      {"velocity_rad_s", "speed limit", motor.limits.dq_rad_s, ranges.velocity_rad_s},
      {"torque_Nm", "effort", motor.limits.torque_Nm, ranges.torque_Nm},
      {"kp_Nm_per_rad", "kp", gains.kp_Nm_per_rad, ranges.kp_Nm_per_rad},
      {"kd_Nm_s_per_rad", "kd", gains.kd_Nm_s_per_rad, ranges.kd_Nm_s_per_rad},
  };
  for (const auto& check : checks) {
    if (check.needs <= check.covers) continue;
    reader.fail("bus",
                fmt::format("the drive '{}' covers a {} of {:g} and {}'s {} needs {:g} at the motor", drive,
                            check.field, check.covers, motor.joint, check.what, check.needs),
                fmt::format("a drive whose {} is {:g} or more", check.field, check.needs));
  }
}

MotorSetup make_motor(const model::RobotModel& robot, int index, const std::map<std::string, MitRanges>& kinds,
                      model::ConfigReader reader) {
  const model::Joint& joint = robot.joints[static_cast<std::size_t>(index)];
  if (joint.bus.drive.empty()) reader.fail("bus", "has no `drive`", "the name of an entry of `drives`");
  const auto kind = kinds.find(joint.bus.drive);
  if (kind == kinds.end())
    reader.fail("bus", "'" + joint.bus.drive + "' isn't a drive", "the name of an entry of `drives`");
  if (joint.bus.node < 1 || joint.bus.node > kMostNode) {
    reader.fail("bus", fmt::format("node is {}", joint.bus.node), fmt::format("1 to {}", kMostNode));
  }
  const Transmission transmission(joint.bus);
  MotorSetup motor = {.joint = joint.name,
                      .index = index,
                      .node = joint.bus.node,
                      .ranges = kind->second,
                      .transmission = transmission,
                      .limits = transmission.to_motor(MotorLimits{.q_lower_rad = joint.lower_rad,
                                                                  .q_upper_rad = joint.upper_rad,
                                                                  .dq_rad_s = joint.velocity_limit_rad_s,
                                                                  .torque_Nm = joint.effort_limit_Nm})};
  const MotorCommand gains = transmission.to_motor(
      MotorCommand{.kp_Nm_per_rad = joint.kp_Nm_per_rad, .kd_Nm_s_per_rad = joint.kd_Nm_s_per_rad});
  check_covers(motor.ranges, motor, gains, joint.bus.drive, reader);
  return motor;
}

}  // namespace

DriveSetup load_drives(const model::RobotModel& robot) {
  model::ConfigReader reader = model::ConfigReader::from_file(robot.directory / "robot.yaml");
  std::map<std::string, MitRanges> kinds;
  model::ConfigReader drives = reader.map("drives");
  for (const std::string& name : drives.keys()) kinds[name] = read_ranges(drives.map(name));
  model::ConfigReader buses = reader.map("buses");
  std::map<std::string, BusSetup> known;
  for (const std::string& name : buses.keys()) known[name] = read_bus(buses.map(name), name);

  DriveSetup setup;
  model::ConfigReader joints = reader.map("joints");
  for (int index = 0; index < robot.joint_index.size(); ++index) {
    const model::Joint& joint = robot.joints[static_cast<std::size_t>(index)];
    model::ConfigReader entry = joints.map(joint.name);
    const auto bus = known.find(joint.bus.bus);
    if (bus == known.end()) entry.fail("bus", "'" + joint.bus.bus + "' isn't described", "a bus of `buses`");
    auto found = std::ranges::find(setup.buses, joint.bus.bus, &BusSetup::name);
    if (found == setup.buses.end()) found = setup.buses.insert(setup.buses.end(), bus->second);
    found->motors.push_back(make_motor(robot, index, kinds, entry));
  }
  const auto with_imu = std::ranges::count(setup.buses, true, &BusSetup::imu);
  if (with_imu != 1) {
    reader.fail("buses", fmt::format("{} buses with drives have the IMU", with_imu), "one bus with `imu: xsens_can`");
  }
  return setup;
}

}  // namespace pmg::drives
