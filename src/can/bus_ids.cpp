#include "can/bus_ids.hpp"

#include <fmt/format.h>

#include <map>
#include <stdexcept>

#include "can/canopen.hpp"
#include "can/xsens_imu.hpp"

namespace pmg::can {

namespace {

void add_canopen(const drives::MotorSetup& motor, std::vector<SentId>& ids) {
  const auto node = static_cast<std::uint32_t>(motor.node);
  for (const std::uint32_t function : {canopen::kReceive1, canopen::kSdoRequest})
    ids.push_back({.id = function + node, .who = motor.joint + "'s commands"});
  for (const std::uint32_t function :
       {canopen::kEmergency, canopen::kTransmit1, canopen::kTransmit2, canopen::kSdoAnswer, canopen::kHeartbeat})
    ids.push_back({.id = function + node, .who = motor.joint + "'s answers"});
}

}  // namespace

std::vector<SentId> sent_ids(const drives::BusSetup& bus) {
  std::vector<SentId> ids;
  for (const drives::MotorSetup& motor : bus.motors) {
    const auto* mit = std::get_if<drives::MitRanges>(&motor.drive);
    if (mit == nullptr) {
      add_canopen(motor, ids);
      continue;
    }
    ids.push_back({.id = static_cast<std::uint32_t>(motor.node), .who = motor.joint + "'s commands"});
    ids.push_back({.id = mit->reply_id, .who = motor.joint + "'s replies", .shared = true});
  }
  if (bus.imu) {
    for (const std::uint32_t id : {kImuQuaternion, kImuRateOfTurn, kImuAcceleration})
      ids.push_back({.id = id, .who = "the IMU"});
  }
  if (bus.has_canopen()) {
    ids.push_back({.id = canopen::kNetworkManagement, .who = "CANopen's node commands"});
    ids.push_back({.id = canopen::kSync, .who = "CANopen's SYNC"});
    ids.push_back({.id = canopen::kHeartbeat + canopen::kHostNode, .who = "this computer's heartbeat"});
  }
  return ids;
}

void check_ids(const drives::DriveSetup& setup) {
  for (const drives::BusSetup& bus : setup.buses) {
    if (bus.first_slave != 0) continue;
    std::map<std::uint32_t, SentId> senders;
    for (const SentId& sent : sent_ids(bus)) {
      const auto [other, alone] = senders.emplace(sent.id, sent);
      if (alone || (sent.shared && other->second.shared)) continue;
      throw std::invalid_argument(
          fmt::format("{}: {} and {} have the identifier 0x{:X}; expected one sender: another `node`, or `reply_id`",
                      bus.name, other->second.who, sent.who, sent.id));
    }
  }
}

}  // namespace pmg::can
