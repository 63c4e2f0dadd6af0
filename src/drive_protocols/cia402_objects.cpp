#include "drive_protocols/cia402_objects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace pmg::drives {

namespace {

constexpr std::uint32_t kProfile = 402;
constexpr std::uint32_t kQuickStopOnSilence = 3;  // 0x6007: quick stop command
constexpr std::uint32_t kRampThenOff = 2;         // 0x605A: down the quick stop ramp, then switch on disabled
constexpr double kSameUnit = 1e-3;                // relative: digits of robot.yaml

[[noreturn]] void differ(const ObjectId& id, const std::string& what, const std::string& says,
                         const std::string& expected) {
  throw std::runtime_error(
      fmt::format("object {} ({}) is {}; expected {} as in robot.yaml", to_string(id), what, says, expected));
}

std::uint32_t must_read(ObjectDictionary& dictionary, const ObjectId& id, const char* what) {
  if (const auto value = dictionary.read(id)) return *value;
  throw std::runtime_error(fmt::format("has no object {} ({}); expected a drive that has it", to_string(id), what));
}

/// Sign extension of an object's value.
std::int32_t as_signed(std::uint32_t value, int bytes) noexcept {
  if (bytes == 1) return static_cast<std::int8_t>(value);
  return bytes == 2 ? static_cast<std::int16_t>(value) : static_cast<std::int32_t>(value);
}

void must_write(ObjectDictionary& dictionary, const ObjectId& id, std::uint32_t value, const char* what) {
  if (!dictionary.write(id, value))
    throw std::runtime_error(fmt::format("has no object {} ({}); expected a drive that has it", to_string(id), what));
  const auto read = dictionary.read(id);
  if (read && *read != value) {
    throw std::runtime_error(
        fmt::format("object {} ({}) stays at {} after {} was written; expected a drive that takes it", to_string(id),
                    what, *read, value));
  }
}

/// Size of one count in an SI unit code of CiA 303-2, for turns a minute and turns a second; 0: another unit.
double velocity_unit_rad_s(std::uint32_t code) {
  constexpr std::uint32_t kTurn = 0xB4, kMinute = 0x47, kSecond = 0x03;
  if ((code >> 16U & 0xFFU) != kTurn) return 0.0;
  const std::uint32_t per = code >> 8U & 0xFFU;
  if (per != kMinute && per != kSecond) return 0.0;
  const double scale = std::pow(10.0, static_cast<std::int8_t>(code >> 24U));
  return scale * 2.0 * std::numbers::pi / (per == kMinute ? 60.0 : 1.0);
}

void check_velocity_unit(ObjectDictionary& dictionary, const Cia402Settings& settings) {
  const auto code = dictionary.read(object::kVelocityUnit);
  const double unit = code ? velocity_unit_rad_s(*code) : 0.0;
  if (unit == 0.0 || std::abs(unit / settings.velocity_unit_rad_s - 1.0) <= kSameUnit) return;
  differ(object::kVelocityUnit, "velocity unit", fmt::format("{:.6g} rad/s", unit),
         fmt::format("velocity_unit_rad_s {:.6g}", settings.velocity_unit_rad_s));
}

}  // namespace

std::string to_string(const ObjectId& id) {
  return id.subindex == 0 ? fmt::format("0x{:04X}", id.index) : fmt::format("0x{:04X}:{}", id.index, id.subindex);
}

void check_drive(ObjectDictionary& dictionary, const Cia402Settings& settings) {
  const std::uint32_t type = must_read(dictionary, object::kDeviceType, "device type");
  if ((type & 0xFFFFU) != kProfile)
    differ(object::kDeviceType, "device type", fmt::format("profile {}", type & 0xFFFFU), "profile 402: `cia402`");
  const auto identity = [&](const ObjectId& id, const char* what, std::uint32_t expected) {
    if (expected == 0) return;
    const std::uint32_t value = must_read(dictionary, id, what);
    if (value != expected) differ(id, what, fmt::format("0x{:X}", value), fmt::format("0x{:X}", expected));
  };
  identity(object::kVendor, "vendor", settings.vendor_id);
  identity(object::kProduct, "product code", settings.product_code);
  const int mode = static_cast<int>(settings.mode);
  const std::uint32_t modes = must_read(dictionary, object::kSupportedModes, "supported modes");
  if ((modes >> static_cast<unsigned>(mode - 1) & 1U) == 0)
    differ(object::kSupportedModes, "supported modes", fmt::format("0x{:X}", modes),
           fmt::format("bit {} for mode {}", mode - 1, mode));
  const double rated_Nm = 1e-3 * must_read(dictionary, object::kRatedTorque, "rated torque");
  if (std::abs(rated_Nm - settings.rated_torque_Nm) > std::max(kSameUnit * settings.rated_torque_Nm, 1e-3))
    differ(object::kRatedTorque, "rated torque", fmt::format("{:g} Nm", rated_Nm),
           fmt::format("rated_torque_Nm {:g}", settings.rated_torque_Nm));
  const std::uint32_t counts = must_read(dictionary, object::kEncoderCounts, "encoder counts"),
                      turns = must_read(dictionary, object::kEncoderTurns, "encoder turns");
  const double per_turn = turns == 0 ? 0.0 : static_cast<double>(counts) / turns;
  if (std::abs(per_turn - settings.counts_per_turn) > 1e-6 * settings.counts_per_turn)
    differ(object::kEncoderCounts, "encoder counts a turn", fmt::format("{:g}", per_turn),
           fmt::format("counts_per_turn {:g}", settings.counts_per_turn));
  const auto motor_turns = dictionary.read(object::kGearMotorTurns),
             shaft_turns = dictionary.read(object::kGearShaftTurns);
  if (motor_turns && shaft_turns && *motor_turns != *shaft_turns)
    differ(object::kGearMotorTurns, "gear in the drive's units", fmt::format("{}:{}", *motor_turns, *shaft_turns),
           "1:1, with the gear in `bus.gear`,");
  check_velocity_unit(dictionary, settings);
}

void set_up_drive(ObjectDictionary& dictionary, const Cia402Settings& settings, const MotorLimits& limits) {
  if (!dictionary.write(object::kControlWord, 0)) throw std::runtime_error("has no object 0x6040 (control word)");
  must_write(dictionary, object::kMode, static_cast<std::uint32_t>(settings.mode), "mode");
  const double most = std::floor(1e3 * limits.torque_Nm / settings.rated_torque_Nm);
  must_write(dictionary, object::kMostTorque, static_cast<std::uint32_t>(std::clamp(most, 1.0, 65535.0)),
             "largest torque");
  must_write(dictionary, object::kAbortOption, kQuickStopOnSilence, "reaction to a silent bus");
  // Drives without these have one behaviour.
  if (dictionary.read(object::kQuickStopOption))
    must_write(dictionary, object::kQuickStopOption, kRampThenOff, "quick stop");
  if (dictionary.read(object::kCycleValue)) {
    must_write(dictionary, object::kCycleValue, 2, "cycle time");
    must_write(dictionary, object::kCycleExponent, 0xFD, "unit of the cycle time");  // 10^-3 s
  }
}

MotorReading read_drive(ObjectDictionary& dictionary, const Cia402Settings& settings) {
  Cia402Inputs inputs;
  const auto read = [&](const ObjectId& id, const char* what) {
    return as_signed(must_read(dictionary, id, what), id.bytes);
  };
  inputs.status_word = static_cast<std::uint16_t>(read(object::kStatusWord, "status word"));
  inputs.position = read(object::kPosition, "position");
  inputs.torque = static_cast<std::int16_t>(read(object::kTorque, "torque"));
  inputs.error_code = static_cast<std::uint16_t>(read(object::kErrorCode, "error code"));
  if (settings.temperature_index != 0) {
    inputs.temperature =
        static_cast<std::int16_t>(read({settings.temperature_index, settings.temperature_subindex, 2}, "temperature"));
  }
  return Cia402Axis(settings, {}).hear(inputs);
}

}  // namespace pmg::drives
