#include "drive_protocols/mit_protocol.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::drives {

namespace {

constexpr double kTemperatureOffset_degC = 40.0;  // a byte covers -40 to 215 degC

constexpr std::uint8_t byte(std::uint32_t bits) noexcept { return static_cast<std::uint8_t>(bits & 0xFFU); }

constexpr DriveFault fault(std::uint8_t code) noexcept {
  return code < static_cast<std::uint8_t>(DriveFault::kOther) ? DriveFault{code} : DriveFault::kOther;
}

}  // namespace

MitProtocol::MitProtocol(const MitRanges& ranges, MitSpecials specials) noexcept
    : position_(-ranges.position_rad, ranges.position_rad, 16),
      velocity_(-ranges.velocity_rad_s, ranges.velocity_rad_s, 12),
      kp_(0.0, ranges.kp_Nm_per_rad, 12),
      kd_(0.0, ranges.kd_Nm_s_per_rad, 12),
      torque_(-ranges.torque_Nm, ranges.torque_Nm, 12),
      specials_(specials) {}

MitFrame MitProtocol::command(const MotorCommand& asked, const MotorLimits& limits) const noexcept {
  const MotorCommand command = finite(asked) ? asked : MotorCommand{};
  const std::uint32_t q = position_.code(command.q_rad, limits.q_lower_rad, limits.q_upper_rad);
  const std::uint32_t dq = velocity_.code(command.dq_rad_s, -limits.dq_rad_s, limits.dq_rad_s);
  const std::uint32_t kp = kp_.code(command.kp_Nm_per_rad, 0.0, kp_.value(kp_.most_code()));
  std::uint32_t kd = kd_.code(command.kd_Nm_s_per_rad, 0.0, kd_.value(kd_.most_code()));
  std::uint32_t torque = torque_.code(command.torque_Nm, -limits.torque_Nm, limits.torque_Nm);
  // Seven bytes of ones and FC, FD or FE in the last would switch the drive. The torque's code below all of them is
  // within the limits because codes above it are. Where six bytes are enough, the gain yields by 0.4 %.
  if (q == 0xFFFFU && dq == 0xFFFU && kp == 0xFFFU) {
    if (specials_.six_bytes && kd >= 0xFF0U) kd = 0xFEFU;
    if (kd == 0xFFFU && torque >= (0xF00U | specials_.lowest)) torque = 0xF00U | (specials_.lowest - 1U);
  }
  return {byte(q >> 8U),
          byte(q),
          byte(dq >> 4U),
          byte(dq << 4U | kp >> 8U),
          byte(kp),
          byte(kd >> 4U),
          byte(kd << 4U | torque >> 8U),
          byte(torque)};
}

MitFrame MitProtocol::command(const MotorCommand& asked, const MotorLimits& limits, double& left_Nm) const noexcept {
  MotorCommand exact = finite(asked) ? asked : MotorCommand{};
  const MotorCommand coded = this->command(command(exact, limits)).value_or(exact);
  const auto rounding = [](double code, double value, double step) {
    return std::abs(code - value) <= step ? code - value : 0.0;  // more: a limit
  };
  exact.torque_Nm += left_Nm - coded.kp_Nm_per_rad * rounding(coded.q_rad, exact.q_rad, position_.step()) -
                     coded.kd_Nm_s_per_rad * rounding(coded.dq_rad_s, exact.dq_rad_s, velocity_.step());
  const MitFrame frame = command(exact, limits);
  const double half_Nm = 0.5 * torque_.step();
  left_Nm = std::clamp(exact.torque_Nm - this->command(frame).value_or(exact).torque_Nm, -half_Nm, half_Nm);
  return frame;
}

bool MitProtocol::special(const MitFrame& frame) const noexcept {
  const auto ones = [&frame](std::ptrdiff_t bytes) {
    return std::all_of(frame.begin(), frame.begin() + bytes, [](std::uint8_t one) { return one == 0xFF; });
  };
  return (specials_.six_bytes && ones(6)) || (ones(7) && frame[7] >= specials_.lowest && frame[7] <= 0xFE);
}

std::optional<MotorCommand> MitProtocol::command(const MitFrame& frame) const noexcept {
  if (special(frame)) return std::nullopt;
  return MotorCommand{.q_rad = position_.value(frame[0] << 8U | frame[1]),
                      .dq_rad_s = velocity_.value(frame[2] << 4U | frame[3] >> 4U),
                      .kp_Nm_per_rad = kp_.value((frame[3] & 0xFU) << 8U | frame[4]),
                      .kd_Nm_s_per_rad = kd_.value(frame[5] << 4U | frame[6] >> 4U),
                      .torque_Nm = torque_.value((frame[6] & 0xFU) << 8U | frame[7])};
}

std::optional<MitReply> MitProtocol::reply(std::span<const std::uint8_t> bytes) const noexcept {
  if (bytes.size() != 8) return std::nullopt;
  return MitReply{.node = bytes[0],
                  .reading = {.q_rad = position_.value(bytes[1] << 8U | bytes[2]),
                              .dq_rad_s = velocity_.value(bytes[3] << 4U | bytes[4] >> 4U),
                              .torque_Nm = torque_.value((bytes[4] & 0xFU) << 8U | bytes[5]),
                              .temperature_degC = bytes[6] - kTemperatureOffset_degC,
                              .fault = fault(bytes[7])}};
}

MitFrame MitProtocol::reply(const MitReply& reply) const noexcept {
  const MotorReading& reading = reply.reading;
  const auto whole = [](const FixedPoint& field, double value) {
    return field.code(value, field.value(0), field.value(field.most_code()));
  };
  const std::uint32_t q = whole(position_, reading.q_rad), dq = whole(velocity_, reading.dq_rad_s),
                      torque = whole(torque_, reading.torque_Nm);
  const FixedPoint temperature(-kTemperatureOffset_degC, 255.0 - kTemperatureOffset_degC, 8);
  return {reply.node,
          byte(q >> 8U),
          byte(q),
          byte(dq >> 4U),
          byte(dq << 4U | torque >> 8U),
          byte(torque),
          byte(whole(temperature, reading.temperature_degC)),
          static_cast<std::uint8_t>(reading.fault)};
}

}  // namespace pmg::drives
