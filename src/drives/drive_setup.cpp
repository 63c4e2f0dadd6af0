#include "drives/drive_setup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

#include "files/config_reader.hpp"

namespace pmg::drives {

namespace {

constexpr int kMostNode = 127;         // CANopen's; MIT-derived drives take it too
constexpr int kMostCanopenNode = 126;  // 127 is this computer's own

BusSetup read_bus(files::ConfigReader reader, const std::string& name) {
  BusSetup bus;
  bus.name = name;
  if (reader.has("first_slave")) {
    bus.first_slave = reader.required<int>("first_slave", files::in_range(1, 64));
    bus.first_alias = reader.optional<int>("first_alias", 0, files::in_range(1, 0xFFFF));
    reader.finish();
    return bus;
  }
  bus.bitrate = reader.required<int>("bitrate", files::in_range(10'000, 1'000'000));
  bus.data_bitrate = reader.optional<int>("data_bitrate", 0, files::in_range(bus.bitrate, 8'000'000));
  bus.sample_point = reader.optional<double>("sample_point", 0.0, files::in_range(0.5, 0.95));
  bus.data_sample_point = reader.optional<double>("data_sample_point", 0.0, files::in_range(0.5, 0.95));
  if (reader.has("imu")) bus.imu = reader.one_of("imu", {"xsens_can"}) == "xsens_can";
  if (reader.has("bridge")) {
    files::ConfigReader bridge = reader.map("bridge");
    bus.bridge_slave = bridge.required<int>("slave", files::in_range(1, 64));
    bus.bridge_channel = bridge.optional<int>("channel", 0, files::in_range(0, 15));
    bus.bridge_alias = bridge.optional<int>("alias", 0, files::in_range(1, 0xFFFF));
    bridge.finish();
  }
  reader.finish();
  return bus;
}

ImuSlave read_imu_slave(files::ConfigReader reader) {
  ImuSlave imu;
  constexpr int kMostSlaves = 64, kMostBytes = 256;
  imu.slave = reader.required<int>("slave", files::in_range(1, kMostSlaves));
  imu.alias = reader.optional<int>("alias", 0, files::in_range(1, 0xFFFF));
  imu.vendor_id = static_cast<std::uint32_t>(reader.optional<double>("vendor_id", 0, files::in_range(0, 0xFFFFFFFFU)));
  imu.product_code =
      static_cast<std::uint32_t>(reader.optional<double>("product_code", 0, files::in_range(0, 0xFFFFFFFFU)));
  imu.input_bytes = reader.required<int>("input_bytes", files::in_range(1, kMostBytes));
  imu.output_bytes = reader.optional<int>("output_bytes", 0, files::in_range(0, kMostBytes));
  const auto offset = [&](const char* key, int bytes) {
    const int at = reader.required<int>(key, files::in_range(0, kMostBytes));
    if (at + bytes > imu.input_bytes)
      reader.fail(key, "lies beyond the inputs", fmt::format("at most {}", imu.input_bytes - bytes));
    return at;
  };
  imu.counter_at = offset("counter_at", 2);
  imu.quaternion_at = offset("quaternion_at", 16);
  imu.rate_of_turn_at = offset("rate_of_turn_at", 12);
  imu.acceleration_at = offset("acceleration_at", 12);
  if (reader.has("status_at")) imu.status_at = offset("status_at", 2);
  reader.finish();
  return imu;
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
  check_covers(motor.drive, {motor.limits, motor.transmission.to_motor(gains)}, motor.joint, drive, reader);
}

MotorSetup make_motor(const model::RobotModel& robot, int index, const std::map<std::string, DriveKind>& kinds,
                      files::ConfigReader& reader) {
  const model::Joint& joint = robot.joints[static_cast<std::size_t>(index)];
  if (joint.bus.drive.empty()) reader.fail("bus", "has no `drive`", "the name of an entry of `drives`");
  const auto kind = kinds.find(joint.bus.drive);
  if (kind == kinds.end())
    reader.fail("bus", "'" + joint.bus.drive + "' isn't a drive", "the name of an entry of `drives`");
  if (joint.bus.node < 1 || joint.bus.node > kMostNode) {
    reader.fail("bus", fmt::format("node is {}", joint.bus.node), fmt::format("1 to {}", kMostNode));
  }
  DriveKind drive = kind->second;
  if (joint.bus.reply_id) {
    auto* mit = std::get_if<MitRanges>(&drive);
    if (mit == nullptr)
      reader.fail("bus", "has a `reply_id`, and its drive isn't of the MIT protocol",
                  "none: CANopen gives it by the node");
    mit->reply_id = static_cast<std::uint32_t>(*joint.bus.reply_id);
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

/// A linkage mixes the gains of its joints, so its drives must take any.
void check_gains_free(const BusSetup& bus, std::size_t motor, const files::ConfigReader& reader) {
  const auto* settings = std::get_if<Cia402Settings>(&bus.motors[motor].drive);
  if (settings == nullptr || settings->mode == Cia402Mode::kTorque) return;
  reader.fail("joints", fmt::format("{}'s drive is in position mode", bus.motors[motor].joint),
              "drives that can be told gains: `mode: torque`, or `protocol: mit`");
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
  for (const std::size_t motor : {first.motor, last.motor}) check_gains_free(bus, motor, reader);
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

/// Throws when drives on this bus disturb each other.
void check_together(const BusSetup& bus, files::ConfigReader& buses) {
  const bool with_mit = std::ranges::any_of(
      bus.motors, [](const MotorSetup& motor) { return std::holds_alternative<MitRanges>(motor.drive); });
  if (bus.first_slave != 0 && with_mit)
    buses.fail(bus.name, "has drives of the MIT protocol as EtherCAT slaves", "drives of `protocol: cia402`");
  if (!bus.has_canopen()) return;
  if (bus.data_bitrate != 0)
    buses.fail(bus.name, "has CANopen drives and CAN FD frames, which their controllers take for errors",
               "no `data_bitrate` on a bus with drives of `protocol: cia402`");
  for (const MotorSetup& motor : bus.motors) {
    if (motor.node > kMostCanopenNode)
      buses.fail(bus.name, fmt::format("has CANopen drives, and {}'s node is {}", motor.joint, motor.node),
                 fmt::format("nodes up to {}: {} is this computer's own", kMostCanopenNode, kMostNode));
    const auto* mit = std::get_if<MitRanges>(&motor.drive);
    if (mit == nullptr) continue;
    const auto command = std::ranges::find(bus.motors, static_cast<int>(mit->reply_id), &MotorSetup::node);
    if (mit->reply_id != 0 && command == bus.motors.end()) continue;
    buses.fail(bus.name,
               fmt::format("has CANopen drives, and {}'s replies have the identifier {}, which {}", motor.joint,
                           mit->reply_id, mit->reply_id == 0 ? "switches CANopen nodes" : "commands a drive"),
               "a `reply_id` that no node of this bus has");
  }
}

}  // namespace

bool BusSetup::has_canopen() const {
  return std::ranges::any_of(
      motors, [](const MotorSetup& motor) { return std::holds_alternative<Cia402Settings>(motor.drive); });
}

DriveSetup load_drives(const model::RobotModel& robot) {
  files::ConfigReader reader = files::ConfigReader::from_file(robot.directory / "robot.yaml");
  std::map<std::string, DriveKind> kinds;
  files::ConfigReader drives = reader.map("drives");
  for (const std::string& name : drives.keys()) kinds.emplace(name, read_drive_kind(drives.map(name)));
  files::ConfigReader buses = reader.map("buses");
  std::map<std::string, BusSetup> known;
  for (const std::string& name : buses.keys()) known[name] = read_bus(buses.map(name), name);

  DriveSetup setup;
  files::ConfigReader imu = reader.map("imu");
  if (imu.has("process_data")) setup.imu_slave = read_imu_slave(imu.map("process_data"));
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
  for (const BusSetup& bus : setup.buses) check_together(bus, buses);
  const auto with_imu = std::ranges::count(setup.buses, true, &BusSetup::imu);
  const char* own = robot.imu.serial ? "`imu.serial`" : (setup.imu_slave ? "`imu.process_data`" : nullptr);
  if (with_imu != (own != nullptr ? 0 : 1)) {
    reader.fail("buses", fmt::format("{} buses with drives have the IMU", with_imu),
                own != nullptr ? fmt::format("none: robot.yaml has {}", own) : "one bus with `imu: xsens_can`");
  }
  return setup;
}

}  // namespace pmg::drives
