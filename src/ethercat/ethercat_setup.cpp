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

constexpr int kImuFrames = 3, kMostFrames = 64, kMostPosition = 64, kMostChannel = 15, kMostAlias = 0xFFFF;

/// Who has each position of the cable, with its alias.
struct Place {
  std::string who;
  int alias = 0;
  bool bridge = false;
};

BusPlace read_place(files::ConfigReader bus) {
  BusPlace place;
  if (bus.has("first_slave")) {
    place.first_slave = bus.required<int>("first_slave", files::in_range(1, kMostPosition));
    place.first_alias = bus.optional<int>("first_alias", 0, files::in_range(1, kMostAlias));
  } else if (bus.has("bridge")) {
    files::ConfigReader bridge = bus.map("bridge");
    place.bridge = bridge.required<int>("slave", files::in_range(1, kMostPosition));
    place.channel = bridge.optional<int>("channel", 0, files::in_range(0, kMostChannel));
    place.bridge_alias = bridge.optional<int>("alias", 0, files::in_range(1, kMostAlias));
    bridge.finish();
  }
  return place;
}

ImuSlave read_imu_slave(files::ConfigReader reader) {
  ImuSlave imu;
  constexpr int kMostBytes = 256;
  imu.slave = reader.required<int>("slave", files::in_range(1, kMostPosition));
  imu.alias = reader.optional<int>("alias", 0, files::in_range(1, kMostAlias));
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

int channels_of(const EthercatSetup& setup, int bridge) {
  int most = -1;
  for (const BusPlace& place : setup.buses) {
    if (place.bridge == bridge) most = std::max(most, place.channel);
  }
  return most + 1;
}

int slave_of(const BusPlace& place, const drives::MotorSetup& motor) { return place.first_slave + motor.node - 1; }
int alias_of(const BusPlace& place, const drives::MotorSetup& motor) {
  return place.first_alias == 0 ? 0 : place.first_alias + motor.node - 1;
}

void check_bridge(const EthercatSetup& setup, const BusPlace& place, const can::BusSetup& bus,
                  const files::ConfigReader& buses) {
  if (place.bridge == 0)
    buses.fail(bus.name, "has no `bridge`",
               "the slave that bridges this bus, or `first_slave` of drives that are slaves");
  if (bus.data_bitrate != 0) buses.fail(bus.name, "has CAN FD behind a bridge", "no `data_bitrate`: classic frames");
  if (bus.has_canopen()) buses.fail(bus.name, "has CANopen drives behind a bridge", "drives of `protocol: mit`");
  const auto same = std::ranges::count_if(setup.buses, [&](const BusPlace& other) {
    return other.bridge == place.bridge && other.channel == place.channel;
  });
  if (same > 1) buses.fail(bus.name, "has the bridge's channel of another bus", "a channel of its own");
  const int motors = static_cast<int>(bus.motors.size()), answers = motors + (bus.imu ? kImuFrames : 0);
  if (motors > setup.frames_out || answers > setup.frames_in)
    buses.fail(bus.name, fmt::format("sends {} frames a cycle and gets {}", motors, answers),
               fmt::format("{} and {} at most: `frames_out` and `frames_in`", setup.frames_out, setup.frames_in));
}

/// Every position of the cable once. Throws files::ConfigError.
std::map<int, Place> places(const EthercatSetup& setup, const can::DriveSetup& drives,
                            const files::ConfigReader& buses) {
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
  for (std::size_t b = 0; b < drives.buses.size(); ++b) {
    const can::BusSetup& bus = drives.buses[b];
    const BusPlace& place = setup.buses[b];
    if (bus.on_can) {
      add(bus.name, place.bridge, {.who = bus.name + "'s bridge", .alias = place.bridge_alias, .bridge = true});
      continue;
    }
    for (const drives::MotorSetup& motor : bus.motors)
      add(bus.name, slave_of(place, motor), {.who = drives::name_of(bus, motor), .alias = alias_of(place, motor)});
  }
  if (const auto& own = setup.imu) add("imu", own->slave, {.who = "the IMU", .alias = own->alias});
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

std::vector<BusPlace> load_places(const model::RobotModel& robot, const can::DriveSetup& drives) {
  files::ConfigReader buses = files::ConfigReader::from_file(robot.directory / "robot.yaml").map("buses");
  std::vector<BusPlace> places;
  for (const can::BusSetup& bus : drives.buses) places.push_back(read_place(buses.map(bus.name)));
  return places;
}

EthercatSetup load_ethercat(const model::RobotModel& robot, const can::DriveSetup& drives) {
  files::ConfigReader root = files::ConfigReader::from_file(robot.directory / "robot.yaml");
  files::ConfigReader reader = root.map("ethercat"), buses = root.map("buses");
  EthercatSetup setup;
  setup.interface = reader.required<std::string>("interface");
  setup.buses = load_places(robot, drives);
  files::ConfigReader imu = root.map("imu");
  if (imu.has("process_data")) setup.imu = read_imu_slave(imu.map("process_data"));
  if (std::ranges::any_of(setup.buses, [](const BusPlace& place) { return place.bridge != 0; })) {
    setup.frames_out = reader.required<int>("frames_out", files::in_range(1, kMostFrames));
    setup.frames_in = reader.required<int>("frames_in", files::in_range(1, kMostFrames));
  }
  const auto identity = [&](const char* key) {
    return static_cast<std::uint32_t>(reader.optional<double>(key, 0, files::in_range(0, 0xFFFFFFFFU)));
  };
  setup.vendor_id = identity("vendor_id");
  setup.product_code = identity("product_code");
  reader.finish();
  for (std::size_t b = 0; b < drives.buses.size(); ++b) {
    if (drives.buses[b].on_can) check_bridge(setup, setup.buses[b], drives.buses[b], buses);
  }
  check_told_apart(places(setup, drives, buses), root);
  return setup;
}

std::vector<SlaveSetup> expected_slaves(const EthercatSetup& setup, const can::DriveSetup& drives,
                                        const PrepareDrive& prepare) {
  std::map<int, SlaveSetup> slaves;
  for (std::size_t b = 0; b < drives.buses.size(); ++b) {
    const can::BusSetup& bus = drives.buses[b];
    const BusPlace& place = setup.buses[b];
    if (bus.on_can) {
      const auto channels = static_cast<std::size_t>(channels_of(setup, place.bridge));
      slaves[place.bridge] = {.vendor_id = setup.vendor_id,
                              .product_code = setup.product_code,
                              .alias = place.bridge_alias,
                              .output_bytes = channels * block_bytes(setup.frames_out),
                              .input_bytes = channels * block_bytes(setup.frames_in),
                              .who = bus.name + "'s bridge",
                              .prepare = {}};
      continue;
    }
    for (std::size_t m = 0; m < bus.motors.size(); ++m) {
      const drives::MotorSetup& motor = bus.motors[m];
      const auto& settings = *drives::as_cia402(motor.drive);
      slaves[slave_of(place, motor)] = {.vendor_id = settings.vendor_id,
                                        .product_code = settings.product_code,
                                        .alias = alias_of(place, motor),
                                        .output_bytes = kDriveOutputs,
                                        .input_bytes = drive_inputs(settings.temperature_index != 0),
                                        .who = drives::name_of(bus, motor),
                                        .prepare = [prepare, b, m](drives::ObjectDictionary& objects) {
                                          if (prepare) prepare(b, m, objects);
                                        }};
    }
  }
  if (const auto& own = setup.imu) {
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
