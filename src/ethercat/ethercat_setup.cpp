#include "ethercat/ethercat_setup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "drive_protocols/canopen_drive.hpp"
#include "ethercat/bridge_link.hpp"
#include "ethercat/drive_link.hpp"
#include "files/config_reader.hpp"

namespace pmg::ethercat {

namespace {

constexpr int kImuFrames = 3, kMostFrames = 64;

/// Who has each position of the cable, with its alias.
struct Place {
  std::string who;
  int alias = 0;
  bool bridge = false;
};

int channels_of(const can::DriveSetup& drives, int slave) {
  int most = -1;
  for (const can::BusSetup& bus : drives.buses) {
    if (bus.bridge_slave == slave) most = std::max(most, bus.bridge_channel);
  }
  return most + 1;
}

int slave_of(const can::BusSetup& bus, const drives::MotorSetup& motor) { return bus.first_slave + motor.node - 1; }
int alias_of(const can::BusSetup& bus, const drives::MotorSetup& motor) {
  return bus.first_alias == 0 ? 0 : bus.first_alias + motor.node - 1;
}

void check_bridge(const EthercatSetup& setup, const can::DriveSetup& drives, const can::BusSetup& bus,
                  const files::ConfigReader& buses) {
  if (bus.bridge_slave == 0)
    buses.fail(bus.name, "has no `bridge`",
               "the slave that bridges this bus, or `first_slave` of drives that are slaves");
  if (bus.data_bitrate != 0) buses.fail(bus.name, "has CAN FD behind a bridge", "no `data_bitrate`: classic frames");
  if (bus.has_canopen()) buses.fail(bus.name, "has CANopen drives behind a bridge", "drives of `protocol: mit`");
  const auto same = std::ranges::count_if(drives.buses, [&](const can::BusSetup& other) {
    return other.bridge_slave == bus.bridge_slave && other.bridge_channel == bus.bridge_channel;
  });
  if (same > 1) buses.fail(bus.name, "has the bridge's channel of another bus", "a channel of its own");
  const int motors = static_cast<int>(bus.motors.size()), answers = motors + (bus.imu ? kImuFrames : 0);
  if (motors > setup.frames_out || answers > setup.frames_in)
    buses.fail(bus.name, fmt::format("sends {} frames a cycle and gets {}", motors, answers),
               fmt::format("{} and {} at most: `frames_out` and `frames_in`", setup.frames_out, setup.frames_in));
}

/// Every position of the cable once. Throws files::ConfigError.
std::map<int, Place> places(const can::DriveSetup& drives, const files::ConfigReader& buses) {
  std::map<int, Place> all;
  const auto add = [&](const std::string& key, int slave, const Place& place) {
    const auto [found, added] = all.emplace(slave, place);
    if (added) return;
    if (place.bridge && found->second.bridge) {
      if (found->second.alias != place.alias)
        buses.fail(key, "names another `alias` of its bridge than another bus", "one alias of a slave");
      return;
    }
    buses.fail(key, fmt::format("has slave {}, which is {}, too", slave, found->second.who), "a slave of its own");
  };
  for (const can::BusSetup& bus : drives.buses) {
    if (bus.first_slave == 0)
      add(bus.name, bus.bridge_slave, {.who = bus.name + "'s bridge", .alias = bus.bridge_alias, .bridge = true});
    for (const drives::MotorSetup& motor : bus.motors) {
      if (bus.first_slave != 0)
        add(bus.name, slave_of(bus, motor), {.who = drives::name_of(bus, motor), .alias = alias_of(bus, motor)});
    }
  }
  if (const auto& own = drives.imu_slave) add("imu", own->slave, {.who = "the IMU", .alias = own->alias});
  return all;
}

/// A left and a right leg may have the same nodes: in another order, each would get the other's commands.
void check_told_apart(const std::map<int, Place>& places, const files::ConfigReader& root) {
  int last = 0;
  for (const auto& [slave, place] : places) {
    if (slave != ++last)
      root.fail("buses", fmt::format("have nobody as slave {}", last),
                fmt::format("all of the slaves 1 to {}", places.rbegin()->first));
    const bool taken = std::ranges::any_of(
        places, [&](const auto& other) { return other.first != slave && other.second.alias == place.alias; });
    if (places.size() > 1 && (place.alias == 0 || taken))
      root.fail("buses", fmt::format("don't tell slave {} ({}) from the others", slave, place.who),
                "`alias` in its `bridge`, `first_alias` of its bus, or `alias` of the IMU: another one for each slave");
  }
}

}  // namespace

EthercatSetup load_ethercat(const model::RobotModel& robot, const can::DriveSetup& drives) {
  files::ConfigReader root = files::ConfigReader::from_file(robot.directory / "robot.yaml");
  files::ConfigReader reader = root.map("ethercat"), buses = root.map("buses");
  EthercatSetup setup{.interface = reader.required<std::string>("interface")};
  if (std::ranges::any_of(drives.buses, [](const can::BusSetup& bus) { return bus.bridge_slave != 0; })) {
    setup.frames_out = reader.required<int>("frames_out", files::in_range(1, kMostFrames));
    setup.frames_in = reader.required<int>("frames_in", files::in_range(1, kMostFrames));
  }
  const auto identity = [&](const char* key) {
    return static_cast<std::uint32_t>(reader.optional<double>(key, 0, files::in_range(0, 0xFFFFFFFFU)));
  };
  setup.vendor_id = identity("vendor_id");
  setup.product_code = identity("product_code");
  reader.finish();
  for (const can::BusSetup& bus : drives.buses) {
    if (bus.first_slave == 0) check_bridge(setup, drives, bus, buses);
  }
  check_told_apart(places(drives, buses), root);
  return setup;
}

std::vector<SlaveSetup> expected_slaves(const EthercatSetup& setup, const can::DriveSetup& drives,
                                        const PrepareDrive& prepare) {
  std::map<int, SlaveSetup> slaves;
  for (std::size_t b = 0; b < drives.buses.size(); ++b) {
    const can::BusSetup& bus = drives.buses[b];
    if (bus.first_slave == 0) {
      const auto channels = static_cast<std::size_t>(channels_of(drives, bus.bridge_slave));
      slaves[bus.bridge_slave] = {.vendor_id = setup.vendor_id,
                                  .product_code = setup.product_code,
                                  .alias = bus.bridge_alias,
                                  .output_bytes = channels * block_bytes(setup.frames_out),
                                  .input_bytes = channels * block_bytes(setup.frames_in),
                                  .who = bus.name + "'s bridge",
                                  .prepare = {}};
      continue;
    }
    for (std::size_t m = 0; m < bus.motors.size(); ++m) {
      const drives::MotorSetup& motor = bus.motors[m];
      const auto& settings = *drives::as_cia402(motor.drive);
      slaves[slave_of(bus, motor)] = {.vendor_id = settings.vendor_id,
                                      .product_code = settings.product_code,
                                      .alias = alias_of(bus, motor),
                                      .output_bytes = kDriveOutputs,
                                      .input_bytes = drive_inputs(settings.temperature_index != 0),
                                      .who = drives::name_of(bus, motor),
                                      .prepare = [prepare, b, m](drives::ObjectDictionary& objects) {
                                        if (prepare) prepare(b, m, objects);
                                      }};
    }
  }
  if (const auto& own = drives.imu_slave) {
    slaves[own->slave] = {.vendor_id = own->vendor_id,
                          .product_code = own->product_code,
                          .alias = own->alias,
                          .output_bytes = static_cast<std::size_t>(own->output_bytes),
                          .input_bytes = static_cast<std::size_t>(own->input_bytes),
                          .who = "the IMU",
                          .prepare = {}};
  }
  std::vector<SlaveSetup> list;
  for (const auto& [position, slave] : slaves) list.push_back(slave);
  return list;
}

}  // namespace pmg::ethercat
