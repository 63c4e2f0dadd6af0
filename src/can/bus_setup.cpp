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
  if (reader.leave("first_slave")) {
    bus.on_can = false;
    reader.leave("first_alias");
    reader.finish();
    return bus;
  }
  bus.bitrate = reader.required<int>("bitrate", files::in_range(10'000, 1'000'000));
  bus.data_bitrate = reader.optional<int>("data_bitrate", 0, files::in_range(bus.bitrate, 8'000'000));
  bus.sample_point = reader.optional<double>("sample_point", 0.0, files::in_range(0.5, 0.95));
  bus.data_sample_point = reader.optional<double>("data_sample_point", 0.0, files::in_range(0.5, 0.95));
  if (reader.has("imu")) bus.imu = reader.one_of("imu", {"xsens_can"}) == "xsens_can";
  bus.relayed = reader.leave("bridge");
  reader.finish();
  return bus;
}

/// Throws when drives on this bus disturb each other.
void check_together(const BusSetup& bus, files::ConfigReader& buses) {
  const bool with_mit = std::ranges::any_of(
      bus.motors, [](const drives::MotorSetup& motor) { return drives::as_mit(motor.drive) != nullptr; });
  if (!bus.on_can && with_mit)
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
  return relayed ? drives::MotorMonitor::kFreshOverBridge : drives::MotorMonitor::kFreshCycles;
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
  setup.imu_on_can_or_line = !imu.leave("process_data");
  for (drives::MotorGroup& group : drives::read_motor_groups(robot, reader, catalogue, names)) {
    BusSetup& bus = setup.buses.emplace_back(known.at(group.name));
    static_cast<drives::MotorGroup&>(bus) = std::move(group);
  }
  for (const BusSetup& bus : setup.buses) check_together(bus, buses);
  const auto with_imu = std::ranges::count(setup.buses, true, &BusSetup::imu);
  const char* own = robot.imu.serial ? "`imu.serial`" : (setup.imu_on_can_or_line ? nullptr : "`imu.process_data`");
  if (with_imu != (own != nullptr ? 0 : 1)) {
    reader.fail("buses", fmt::format("{} buses with drives have the IMU", with_imu),
                own != nullptr ? fmt::format("none: robot.yaml has {}", own) : "one bus with `imu: xsens_can`");
  }
  return setup;
}

}  // namespace pmg::can
