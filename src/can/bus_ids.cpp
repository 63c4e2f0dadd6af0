#include "can/bus_ids.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string_view>

#include "can/xsens_imu.hpp"
#include "drive_protocols/canopen.hpp"

namespace pmg::can {

namespace {

constexpr std::array kImuIds = {kImuQuaternion, kImuRateOfTurn, kImuAcceleration};

bool known(const BusSetup& bus, int node) noexcept {
  return std::ranges::find(bus.motors, node, &drives::MotorSetup::node) != bus.motors.end();
}

}  // namespace

std::vector<SentId> sent_ids(const BusSetup& bus) {
  std::vector<SentId> ids;
  for (const drives::MotorSetup& motor : bus.motors) {
    for (const drives::MotorId& id : motor.drive->ids(motor.node))
      ids.push_back({.id = id.id, .who = motor.joint + "'s " + id.what, .shared_by = id.shared_by, .mark = id.mark});
  }
  if (bus.imu) {
    for (const std::uint32_t id : kImuIds) ids.push_back({.id = id, .who = "the IMU"});
  }
  if (const auto network = drives::network_of(bus)) {
    for (const drives::NetworkMessage& message : network->messages())
      ids.push_back({.id = message.id, .who = message.who});
  }
  return ids;
}

void check_ids(const DriveSetup& setup) {
  for (const BusSetup& bus : setup.buses) {
    if (!bus.on_can) continue;
    std::vector<SentId> senders;
    for (const SentId& sent : sent_ids(bus)) {
      const auto other = std::ranges::find_if(senders, [&](const SentId& one) {
        const bool apart = one.shared_by != nullptr && sent.shared_by != nullptr && one.mark != sent.mark &&
                           std::string_view(one.shared_by) == sent.shared_by;
        return one.id == sent.id && !apart;
      });
      if (other == senders.end()) {
        senders.push_back(sent);
        continue;
      }
      throw std::invalid_argument(
          fmt::format("{}: {} and {} have the identifier 0x{:X}; expected one sender: another `node`, or `reply_id`",
                      bus.name, other->who, sent.who, sent.id));
    }
  }
}

std::vector<std::uint32_t> awaited_ids(const BusSetup& bus) {
  std::vector<std::uint32_t> ids;
  for (const drives::MotorSetup& motor : bus.motors) {
    for (const drives::MotorId& id : motor.drive->ids(motor.node)) {
      if (id.answer && std::ranges::find(ids, id.id) == ids.end()) ids.push_back(id.id);
    }
  }
  if (bus.imu) ids.insert(ids.end(), kImuIds.begin(), kImuIds.end());
  return ids;
}

std::optional<int> stranger(const BusSetup& bus, const drives::Message& frame) noexcept {
  for (const drives::MotorSetup& motor : bus.motors) {
    const auto node = motor.drive->sender(frame);
    if (node && !known(bus, *node)) return node;
  }
  const auto node = drives::canopen::sender(frame);
  return node && !known(bus, *node) ? node : std::nullopt;
}

}  // namespace pmg::can
