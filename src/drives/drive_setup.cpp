#include "drives/drive_setup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

#include "files/config_reader.hpp"

namespace pmg::drives {

namespace {

constexpr int kMostNode = 127;  // CANopen's; MIT-derived drives take it too

MitRanges read_ranges(files::ConfigReader reader) {
  reader.one_of("protocol", {"mit"});
  const MitRanges ranges = {.position_rad = reader.required<double>("position_rad", files::positive()),
                            .velocity_rad_s = reader.required<double>("velocity_rad_s", files::positive()),
                            .torque_Nm = reader.required<double>("torque_Nm", files::positive()),
                            .kp_Nm_per_rad = reader.required<double>("kp_Nm_per_rad", files::positive()),
                            .kd_Nm_s_per_rad = reader.required<double>("kd_Nm_s_per_rad", files::positive())};
  reader.finish();
  return ranges;
}

BusSetup read_bus(files::ConfigReader reader, const std::string& name) {
  BusSetup bus;
  bus.name = name;
  bus.bitrate = reader.required<int>("bitrate", files::in_range(10'000, 1'000'000));
  bus.data_bitrate = reader.optional<int>("data_bitrate", 0, files::in_range(bus.bitrate, 8'000'000));
  if (reader.has("imu")) bus.imu = reader.one_of("imu", {"xsens_can"}) == "xsens_can";
  reader.finish();
  return bus;
}

/// Throws when a field of the drive's frames doesn't cover what the joint needs.
void check_covers(const MitRanges& ranges, const MotorSetup& motor, const MotorCommand& gains, const std::string& drive,
                  files::ConfigReader& reader) {
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

MotorLimits limits_of(const model::Joint& joint) {
  return {.q_lower_rad = joint.lower_rad,
          .q_upper_rad = joint.upper_rad,
          .dq_rad_s = joint.velocity_limit_rad_s,
          .torque_Nm = joint.effort_limit_Nm};
}

MotorCommand gains_of(const model::Joint& joint) {
  MotorCommand gains;
  gains.kp_Nm_per_rad = joint.kp_Nm_per_rad;
  gains.kd_Nm_s_per_rad = joint.kd_Nm_s_per_rad;
  return gains;
}

/// limits and gains: at the joint, or at the crank of a linkage.
void cover(MotorSetup& motor, const MotorLimits& limits, const MotorCommand& gains, const std::string& drive,
           files::ConfigReader& reader) {
  motor.limits = motor.transmission.to_motor(limits);
  check_covers(motor.ranges, motor, motor.transmission.to_motor(gains), drive, reader);
}

MotorSetup make_motor(const model::RobotModel& robot, int index, const std::map<std::string, MitRanges>& kinds,
                      files::ConfigReader& reader) {
  const model::Joint& joint = robot.joints[static_cast<std::size_t>(index)];
  if (joint.bus.drive.empty()) reader.fail("bus", "has no `drive`", "the name of an entry of `drives`");
  const auto kind = kinds.find(joint.bus.drive);
  if (kind == kinds.end())
    reader.fail("bus", "'" + joint.bus.drive + "' isn't a drive", "the name of an entry of `drives`");
  if (joint.bus.node < 1 || joint.bus.node > kMostNode) {
    reader.fail("bus", fmt::format("node is {}", joint.bus.node), fmt::format("1 to {}", kMostNode));
  }
  return {.joint = joint.name,
          .index = index,
          .node = joint.bus.node,
          .ranges = kind->second,
          .transmission = Transmission(joint.bus),
          .limits = {}};
}

Eigen::Vector3d vector3(files::ConfigReader& reader, const std::string& key) {
  const std::vector<double> v = reader.numbers(key, 3);
  return {v[0], v[1], v[2]};
}

template <int N>
LinkedMotors<N> link(const model::RobotModel& robot, BusSetup& bus,
                     const std::array<std::size_t, static_cast<std::size_t>(N)>& motors,
                     std::vector<files::ConfigReader> entries, files::ConfigReader& reader) {
  constexpr std::size_t kN = N;
  std::array<Eigen::Vector3d, kN> axes;
  std::array<CrankAndRod, kN> rods;
  std::array<MotorLimits, kN> limits{};
  std::array<MotorCommand, kN> gains{};
  typename RodLinkage<N>::Angles lower, upper;
  for (std::size_t i = 0; i < kN; ++i) {
    const model::Joint& joint = robot.joints[static_cast<std::size_t>(bus.motors[motors[i]].index)];
    axes[i] = joint.axis;
    limits[i] = limits_of(joint);
    gains[i] = gains_of(joint);
    lower[static_cast<Eigen::Index>(i)] = joint.lower_rad;
    upper[static_cast<Eigen::Index>(i)] = joint.upper_rad;
    rods[i] = {.crank_centre_m = vector3(entries[i], "crank_centre_m"),
               .axis = vector3(entries[i], "axis"),
               .crank_end_m = vector3(entries[i], "crank_end_m"),
               .rod_end_m = vector3(entries[i], "rod_end_m")};
    entries[i].finish();
  }
  try {
    LinkedMotors<N> linked{.motors = motors, .linkage = RodLinkage<N>(axes, rods)};
    linked.linkage.check_ranges(lower, upper);
    const auto needs = linked.linkage.needs(limits, gains);
    for (std::size_t i = 0; i < kN; ++i) {
      MotorSetup& motor = bus.motors[motors[i]];
      cover(motor, needs[i].limits, needs[i].gains, robot.joints[static_cast<std::size_t>(motor.index)].bus.drive,
            reader);
    }
    return linked;
  } catch (const std::invalid_argument& error) {
    files::raise(reader.place(), reader.path("motors"), error.what(), "");
  }
}

/// Where a joint's motor is.
struct Found {
  std::size_t bus, motor;
};

Found find_motor(const DriveSetup& setup, const std::string& joint, files::ConfigReader& reader) {
  for (std::size_t b = 0; b < setup.buses.size(); ++b) {
    const auto motor = std::ranges::find(setup.buses[b].motors, joint, &MotorSetup::joint);
    if (motor != setup.buses[b].motors.end())
      return {b, static_cast<std::size_t>(motor - setup.buses[b].motors.begin())};
  }
  reader.fail("joints", "'" + joint + "' isn't a joint", "names of `joints`");
}

void read_linkage(const model::RobotModel& robot, DriveSetup& setup, files::ConfigReader reader) {
  const auto joints = reader.required<std::vector<std::string>>("joints");
  std::vector<files::ConfigReader> motors = reader.maps("motors");
  if (joints.empty() || joints.size() > 2 || joints.size() != motors.size()) {
    reader.fail("joints", fmt::format("{} joints and {} motors", joints.size(), motors.size()),
                "one of each, or two of each");
  }
  const Found first = find_motor(setup, joints[0], reader), last = find_motor(setup, joints.back(), reader);
  if (first.bus != last.bus) reader.fail("joints", "their drives are on two buses", "one bus");
  BusSetup& bus = setup.buses[first.bus];
  if (joints.size() == 1) {
    bus.four_bars.push_back(link<1>(robot, bus, {first.motor}, std::move(motors), reader));
  } else {
    bus.parallel.push_back(link<2>(robot, bus, {first.motor, last.motor}, std::move(motors), reader));
  }
  reader.finish();
}

bool linked(const BusSetup& bus, std::size_t motor) {
  const auto has = [motor](const auto& linkage) {
    return std::ranges::find(linkage.motors, motor) != linkage.motors.end();
  };
  return std::ranges::any_of(bus.four_bars, has) || std::ranges::any_of(bus.parallel, has);
}

}  // namespace

DriveSetup load_drives(const model::RobotModel& robot) {
  files::ConfigReader reader = files::ConfigReader::from_file(robot.directory / "robot.yaml");
  std::map<std::string, MitRanges> kinds;
  files::ConfigReader drives = reader.map("drives");
  for (const std::string& name : drives.keys()) kinds[name] = read_ranges(drives.map(name));
  files::ConfigReader buses = reader.map("buses");
  std::map<std::string, BusSetup> known;
  for (const std::string& name : buses.keys()) known[name] = read_bus(buses.map(name), name);

  DriveSetup setup;
  files::ConfigReader joints = reader.map("joints");
  for (int index = 0; index < robot.joint_index.size(); ++index) {
    const model::Joint& joint = robot.joints[static_cast<std::size_t>(index)];
    files::ConfigReader entry = joints.map(joint.name);
    const auto bus = known.find(joint.bus.bus);
    if (bus == known.end()) entry.fail("bus", "'" + joint.bus.bus + "' isn't described", "a bus of `buses`");
    auto found = std::ranges::find(setup.buses, joint.bus.bus, &BusSetup::name);
    if (found == setup.buses.end()) found = setup.buses.insert(setup.buses.end(), bus->second);
    found->motors.push_back(make_motor(robot, index, kinds, entry));
  }
  if (reader.has("linkages")) {
    for (const files::ConfigReader& linkage : reader.maps("linkages")) read_linkage(robot, setup, linkage);
  }
  for (BusSetup& bus : setup.buses) {
    for (std::size_t m = 0; m < bus.motors.size(); ++m) {
      MotorSetup& motor = bus.motors[m];
      const model::Joint& joint = robot.joints[static_cast<std::size_t>(motor.index)];
      files::ConfigReader entry = joints.map(joint.name);
      if (!linked(bus, m)) cover(motor, limits_of(joint), gains_of(joint), joint.bus.drive, entry);
    }
  }
  const auto with_imu = std::ranges::count(setup.buses, true, &BusSetup::imu);
  if (with_imu != 1) {
    reader.fail("buses", fmt::format("{} buses with drives have the IMU", with_imu), "one bus with `imu: xsens_can`");
  }
  return setup;
}

}  // namespace pmg::drives
