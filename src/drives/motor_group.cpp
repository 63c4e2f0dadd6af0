#include "drives/motor_group.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

namespace pmg::drives {

namespace {

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
  motor.drive->check_covers({motor.limits, motor.transmission.to_motor(gains)}, motor.joint, drive, reader);
}

MotorSetup make_motor(const model::RobotModel& robot, int index, const std::map<std::string, DriveKind>& kinds,
                      files::ConfigReader& reader) {
  const model::Joint& joint = robot.joints[static_cast<std::size_t>(index)];
  if (joint.bus.drive.empty()) reader.fail("bus", "has no `drive`", "the name of an entry of `drives`");
  const auto kind = kinds.find(joint.bus.drive);
  if (kind == kinds.end())
    reader.fail("bus", "'" + joint.bus.drive + "' isn't a drive", "the name of an entry of `drives`");
  const int most_node = kind->second->most_node();
  if (joint.bus.node < 1 || joint.bus.node > most_node)
    reader.fail("bus", fmt::format("node is {}", joint.bus.node), fmt::format("1 to {}", most_node));
  DriveKind drive = kind->second;
  if (joint.bus.reply_id) {
    drive = drive->replying_as(static_cast<std::uint32_t>(*joint.bus.reply_id));
    if (drive == nullptr)
      reader.fail("bus", "has a `reply_id`, and its drive's protocol has none", "none: the node gives it");
  }
  return {.joint = joint.name,
          .index = index,
          .node = joint.bus.node,
          .drive = drive,
          .transmission = Transmission(joint.bus),
          .limits = {}};
}

Eigen::Vector3d vector3(files::ConfigReader& reader, const std::string& key) {
  const std::vector<double> v = reader.numbers(key, 3);
  return {v[0], v[1], v[2]};
}

template <int N>
LinkedMotors<N> link(const model::RobotModel& robot, MotorGroup& bus,
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
    LinkedMotors<N> linked{.motors = motors, .linkage = RodLinkage<N>(axes, rods), .joints = limits};
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

Found find_motor(const std::vector<MotorGroup>& groups, const std::string& joint, files::ConfigReader& reader) {
  for (std::size_t b = 0; b < groups.size(); ++b) {
    const auto motor = std::ranges::find(groups[b].motors, joint, &MotorSetup::joint);
    if (motor != groups[b].motors.end()) return {b, static_cast<std::size_t>(motor - groups[b].motors.begin())};
  }
  reader.fail("joints", "'" + joint + "' isn't a joint", "names of `joints`");
}

/// A linkage mixes the gains of its joints, so its drives must take any.
void check_gains_free(const MotorGroup& bus, std::size_t motor, const files::ConfigReader& reader) {
  if (bus.motors[motor].drive->loop() != LoopPlace::kOwnGains) return;
  reader.fail("joints", fmt::format("{}'s drive is in position mode", bus.motors[motor].joint),
              "drives that can be told gains, as in `mode: torque`");
}

void read_linkage(const model::RobotModel& robot, std::vector<MotorGroup>& groups, files::ConfigReader reader) {
  const auto joints = reader.required<std::vector<std::string>>("joints");
  std::vector<files::ConfigReader> motors = reader.maps("motors");
  if (joints.empty() || joints.size() > 2 || joints.size() != motors.size()) {
    reader.fail("joints", fmt::format("{} joints and {} motors", joints.size(), motors.size()),
                "one of each, or two of each");
  }
  const Found first = find_motor(groups, joints[0], reader), last = find_motor(groups, joints.back(), reader);
  if (first.bus != last.bus) reader.fail("joints", "their drives are on two buses", "one bus");
  MotorGroup& bus = groups[first.bus];
  for (const std::size_t motor : {first.motor, last.motor}) check_gains_free(bus, motor, reader);
  if (joints.size() == 1) {
    bus.four_bars.push_back(link<1>(robot, bus, {first.motor}, std::move(motors), reader));
  } else {
    bus.parallel.push_back(link<2>(robot, bus, {first.motor, last.motor}, std::move(motors), reader));
  }
  reader.finish();
}

template <int N>
void read_linked(const LinkedMotors<N>& linked, Readings& joints) {
  typename RodLinkage<N>::Readings cranks{};
  bool whole = true;
  for (std::size_t i = 0; i < cranks.size(); ++i) {
    whole = whole && joints[linked.motors[i]].has_value();
    cranks[i] = joints[linked.motors[i]].value_or(MotorReading{});
  }
  const auto found = whole ? linked.linkage.to_joints(cranks, RodLinkage<N>::Angles::Zero()) : std::nullopt;
  for (std::size_t i = 0; i < cranks.size(); ++i) {
    joints[linked.motors[i]] = found ? std::optional((*found)[i]) : std::nullopt;
  }
}

bool linked(const MotorGroup& bus, std::size_t motor) {
  const auto has = [motor](const auto& linkage) {
    return std::ranges::find(linkage.motors, motor) != linkage.motors.end();
  };
  return std::ranges::any_of(bus.four_bars, has) || std::ranges::any_of(bus.parallel, has);
}

}  // namespace

std::unique_ptr<Network> network_of(const MotorGroup& group) {
  for (const MotorSetup& motor : group.motors) {
    if (auto network = motor.drive->network()) return network;
  }
  return nullptr;
}

Readings joint_readings(const MotorGroup& group, const Readings& motors) {
  Readings joints = motors;
  for (std::size_t m = 0; m < joints.size(); ++m) {
    if (joints[m]) joints[m] = group.motors[m].transmission.to_joint(*joints[m]);
  }
  for (const auto& linked : group.four_bars) read_linked(linked, joints);
  for (const auto& linked : group.parallel) read_linked(linked, joints);
  return joints;
}

std::string name_of(const MotorGroup& group, const MotorSetup& motor) {
  return fmt::format("{} ({}, node {})", motor.joint, group.name, motor.node);
}

std::vector<MotorGroup> read_motor_groups(const model::RobotModel& robot, files::ConfigReader& reader,
                                          const DriveCatalogue& catalogue, const std::set<std::string>& buses) {
  std::map<std::string, DriveKind> kinds;
  files::ConfigReader drives = reader.map("drives");
  for (const std::string& name : drives.keys()) kinds.emplace(name, catalogue.read(drives.map(name)));

  std::vector<MotorGroup> groups;
  files::ConfigReader joints = reader.map("joints");
  for (int index = 0; index < robot.joint_index.size(); ++index) {
    const model::Joint& joint = robot.joints[static_cast<std::size_t>(index)];
    files::ConfigReader entry = joints.map(joint.name);
    if (!buses.contains(joint.bus.bus))
      entry.fail("bus", "'" + joint.bus.bus + "' isn't described", "a bus of `buses`");
    auto found = std::ranges::find(groups, joint.bus.bus, &MotorGroup::name);
    if (found == groups.end()) found = groups.insert(groups.end(), MotorGroup{.name = joint.bus.bus});
    found->motors.push_back(make_motor(robot, index, kinds, entry));
  }
  if (reader.has("linkages")) {
    for (const files::ConfigReader& linkage : reader.maps("linkages")) read_linkage(robot, groups, linkage);
  }
  for (MotorGroup& group : groups) {
    for (std::size_t m = 0; m < group.motors.size(); ++m) {
      MotorSetup& motor = group.motors[m];
      const model::Joint& joint = robot.joints[static_cast<std::size_t>(motor.index)];
      files::ConfigReader entry = joints.map(joint.name);
      if (!linked(group, m)) cover(motor, limits_of(joint), gains_of(joint), joint.bus.drive, entry);
    }
  }
  return groups;
}

}  // namespace pmg::drives
