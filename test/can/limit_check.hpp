// What fuzzers ask of every command to a drive.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "can/bus_setup.hpp"
#include "drive_protocols/canopen.hpp"
#include "drive_protocols/canopen_drive.hpp"
#include "drive_protocols/mit_drive.hpp"
#include "drive_protocols/mit_protocol.hpp"
#include "drives/message.hpp"

namespace pmg::test {

inline void require(bool promise) {
  if (!promise) std::abort();
}

/// A frame to a drive: its targets lie within its motor's limits.
inline void check_limits(const drives::Message& frame, const can::BusSetup& bus) {
  constexpr double kRounding = 1e-9;
  const auto node = static_cast<int>(frame.id & drives::canopen::kNodeBits);
  const auto motor = std::ranges::find(bus.motors, node, &drives::MotorSetup::node);
  if (frame.length != 8 || motor == bus.motors.end()) return;
  const drives::MotorLimits& limits = motor->limits;
  const auto within = [&](double q_rad) {
    require(q_rad >= limits.q_lower_rad - kRounding && q_rad <= limits.q_upper_rad + kRounding);
  };
  if (const auto* settings = drives::as_cia402(motor->drive)) {
    if (frame.id - static_cast<std::uint32_t>(node) != drives::canopen::kReceive1) return;
    std::int32_t position = 0;
    std::int16_t torque = 0;
    std::memcpy(&position, frame.data.data() + 2, sizeof position);
    std::memcpy(&torque, frame.data.data() + 6, sizeof torque);
    within(position * settings->count_rad());
    require(std::abs(1e-3 * torque * settings->rated_torque_Nm) <= limits.torque_Nm + kRounding);
    return;
  }
  drives::MitFrame bytes{};
  std::memcpy(bytes.data(), frame.data.data(), 8);
  const drives::MitDrive& type = *drives::as_mit(motor->drive);
  const auto command = type.codec().command(bytes);
  if (!command) {  // of what a dialect takes for something else, none but these
    require(bytes == drives::kMitEnable || bytes == drives::kMitDisable ||
            (type.clearing() != nullptr && bytes == *type.clearing()));
    return;
  }
  within(command->q_rad);
  require(std::abs(command->dq_rad_s) <= limits.dq_rad_s + kRounding);
  require(std::abs(command->torque_Nm) <= limits.torque_Nm + kRounding);
}

}  // namespace pmg::test
