#include "can/bus_setup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "drive_protocols/canopen_drive.hpp"
#include "drive_protocols/mit_drive.hpp"
#include "drives/motor_monitor.hpp"
#include "files/config_reader.hpp"

namespace pmg::can {

namespace {

constexpr int kMostNode = 127, kMostCanopenNode = 126;  // 127 is this computer's own

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

/// Throws when drives on this bus disturb each other.
void check_together(const BusSetup& bus, files::ConfigReader& buses) {
  const bool with_mit = std::ranges::any_of(
      bus.motors, [](const drives::MotorSetup& motor) { return drives::as_mit(motor.drive) != nullptr; });
  if (bus.first_slave != 0 && with_mit)
    buses.fail(bus.name, "has drives of the MIT protocol as EtherCAT slaves", "drives of `protocol: cia402`");
  if (!bus.has_canopen()) return;
  if (bus.data_bitrate != 0)
    buses.fail(bus.name, "has CANopen drives and CAN FD frames, which their controllers take for errors",
               "no `data_bitrate` on a bus with drives of `protocol: cia402`");
  for (const drives::MotorSetup& motor : bus.motors) {
    if (motor.node > kMostCanopenNode)
      buses.fail(bus.name, fmt::format("has CANopen drives, and {}'s node is {}", motor.joint, motor.node),
                 fmt::format("nodes up to {}: {} is this computer's own", kMostCanopenNode, kMostNode));
    const drives::MitDrive* mit = drives::as_mit(motor.drive);
    if (mit == nullptr) continue;
    const auto command =
        std::ranges::find(bus.motors, static_cast<int>(mit->ranges().reply_id), &drives::MotorSetup::node);
    if (mit->ranges().reply_id != 0 && command == bus.motors.end()) continue;
    buses.fail(bus.name,
               fmt::format("has CANopen drives, and {}'s replies have the identifier {}, which {}", motor.joint,
                           mit->ranges().reply_id,
                           mit->ranges().reply_id == 0 ? "switches CANopen nodes" : "commands a drive"),
               "a `reply_id` that no node of this bus has");
  }
}

}  // namespace

bool BusSetup::has_canopen() const {
  return std::ranges::any_of(motors,
                             [](const drives::MotorSetup& motor) { return drives::as_cia402(motor.drive) != nullptr; });
}

int BusSetup::fresh_cycles() const noexcept {
  return bridge_slave != 0 ? drives::MotorMonitor::kFreshOverBridge : drives::MotorMonitor::kFreshCycles;
}

DriveSetup load_drives(const model::RobotModel& robot, const drives::DriveCatalogue& catalogue) {
  files::ConfigReader reader = files::ConfigReader::from_file(robot.directory / "robot.yaml");
  files::ConfigReader buses = reader.map("buses");
  std::map<std::string, BusSetup> known;
  std::set<std::string> names;
  for (const std::string& name : buses.keys()) {
    known[name] = read_bus(buses.map(name), name);
    names.insert(name);
  }
  DriveSetup setup;
  files::ConfigReader imu = reader.map("imu");
  if (imu.has("process_data")) setup.imu_slave = read_imu_slave(imu.map("process_data"));
  for (drives::MotorGroup& group : drives::read_motor_groups(robot, reader, catalogue, names)) {
    BusSetup& bus = setup.buses.emplace_back(known.at(group.name));
    static_cast<drives::MotorGroup&>(bus) = std::move(group);
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

}  // namespace pmg::can
