// A CiA 402 drive on CANopen: objects, network states, PDOs on SYNC, the profile's state machine, the consumer of this
// computer's heartbeat as watchdog.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "can/drive_emulator.hpp"
#include "can/object_store.hpp"
#include "drive_protocols/canopen_drive.hpp"

namespace pmg::test {

class Cia402Emulator final : public DriveEmulator {
 public:
  static constexpr int kQuickStopTicks = 25;  // 50 ms down the ramp

  explicit Cia402Emulator(const drives::MotorSetup& setup)
      : DriveEmulator(setup), settings_(*drives::as_cia402(setup.drive)) {
    power_up();
  }

  /// As after power came: everything as delivered, boot-up not yet sent.
  void power_up() {
    network_state_ = kPreOperational;
    state_ = 0x40;
    booted_ = false;
    heartbeat_ms_ = -1;
    objects = ObjectStore();
    objects.add(0x1000, 0, 0x00020192, 4, false);
    objects.add(0x1018, 1, 0x1234, 4, false);
    objects.add(0x1018, 2, 0x5678, 4, false);
    objects.add(0x1016, 1, 0, 4);
    objects.add(0x1029, 1, 0, 1);
    for (int i = 0; i < 4; ++i) {
      const std::uint32_t own = static_cast<std::uint32_t>(setup().node), step = 0x100U * static_cast<std::uint32_t>(i);
      objects.add(0x1400 + i, 1, 0x200 + step + own, 4);
      objects.add(0x1400 + i, 2, 255, 1);
      objects.add(0x1800 + i, 1, 0x180 + step + own, 4);
      objects.add(0x1800 + i, 2, 255, 1);
      for (int k = 0; k < 5; ++k) {
        objects.add(0x1600 + i, k, k == 0 ? 1 : 0x60400010, k == 0 ? 1 : 4);
        objects.add(0x1A00 + i, k, k == 0 ? 1 : 0x60410010, k == 0 ? 1 : 4);
      }
    }
    objects.add(0x6007, 0, 0, 2);
    objects.add(0x603F, 0, 0, 2, false);
    objects.add(0x6040, 0, 0, 2);
    objects.add(0x6041, 0, 0, 2, false);
    objects.add(0x605A, 0, 2, 2);
    objects.add(0x6060, 0, 0, 1);
    objects.add(0x6061, 0, 0, 1, false);
    objects.add(0x6064, 0, 0, 4, false);
    objects.add(0x606C, 0, 0, 4, false);
    objects.add(0x6071, 0, 0, 2);
    objects.add(0x6072, 0, 1000, 2);
    objects.add(0x6076, 0, static_cast<std::uint32_t>(std::lround(1e3 * settings_.rated_torque_Nm)), 4, false);
    objects.add(0x6077, 0, 0, 2, false);
    objects.add(0x607A, 0, 0, 4);
    objects.add(0x608F, 1, static_cast<std::uint32_t>(std::lround(settings_.counts_per_turn)), 4);
    objects.add(0x608F, 2, 1, 4);
    objects.add(0x60C2, 1, 1, 1);
    objects.add(0x60C2, 2, 0xFD, 1);
    objects.add(0x6502, 0, 1U << 7U | 1U << 9U, 4, false);
    if (settings_.temperature_index != 0)
      objects.add(settings_.temperature_index, settings_.temperature_subindex, 0, 2, false);
  }
  void drop() noexcept { state_ = kDisabled; }  ///< switched off from outside
  void leave_operational() noexcept { network_state_ = kPreOperational; }

  int hear(const drives::Message& frame, Replies& replies) noexcept override {
    if (silent || frame.extended || frame.fd) return 0;
    const auto own = static_cast<std::uint32_t>(setup().node), shown = static_cast<std::uint32_t>(node);
    std::size_t count = 0;
    if (!booted_) {
      booted_ = true;
      replies[count++] = drives::Message::of(0x700 + shown, std::array<std::uint8_t, 1>{0});
    }
    refresh();
    if (frame.id == 0x000 && frame.length == 2 && (frame.data[1] == 0 || frame.data[1] == own)) {
      if (frame.data[0] == 0x01) network_state_ = kOperational;
      if (frame.data[0] == 0x80) network_state_ = kPreOperational;
    } else if (frame.id == 0x600 + own && frame.length == 8) {
      for (int copy = twice ? 2 : 1; copy > 0; --copy)
        replies[count++] = drives::Message::of(0x580 + shown, serve_objects(frame));
    } else if (frame.id == (objects.value(0x1016, 1) >> 16U & 0x7FU) + 0x700 && frame.length == 1) {
      heartbeat_ms_ = 0;
    } else if (network_state_ == kOperational && frame.id == objects.value(0x1400, 1)) {
      take(frame.bytes());
    } else if (network_state_ == kOperational && frame.id == 0x080 && frame.length == 0) {
      ++heard;
      for (const int pdo : {0, 1}) {
        const std::uint32_t identifier = objects.value(0x1800 + pdo, 1), type = objects.value(0x1800 + pdo, 2);
        if ((identifier & 0x80000000U) != 0 || type < 1 || type > 240) continue;
        for (int copy = twice ? 2 : 1; copy > 0; --copy)
          replies[count++] = pdo_frame(0x1A00 + pdo, (identifier & ~0x7FU) + shown);
      }
    }
    if (emergency_ != told_ && network_state_ == kOperational && count < replies.size()) {
      told_ = emergency_;
      replies[count++] =
          drives::Message::of(0x080 + shown, std::array<std::uint8_t, 8>{static_cast<std::uint8_t>(told_ & 0xFFU),
                                                                         static_cast<std::uint8_t>(told_ >> 8U), 1});
    }
    return static_cast<int>(count);
  }

  // What EtherCAT carries without frames.
  /// (SDO request) => its answer.
  std::array<std::uint8_t, 8> serve_objects(const drives::Message& request) noexcept {
    refresh();
    const std::array<std::uint8_t, 8> answer = objects.serve(request);
    objects.value(0x6061) = objects.value(0x6060);
    obey(objects.value(0x6040));
    return answer;
  }
  /// The outputs of a cycle, as mapped; then the inputs.
  void take(std::span<const std::uint8_t> outputs) noexcept {
    ++obeyed;
    unpack(0x1600, outputs);
    obey(objects.value(0x6040));
  }
  void give(std::span<std::uint8_t> inputs) noexcept {
    refresh();
    pack(0x1A00, inputs);
  }
  void lose_bus() noexcept {
    tripped_ = true;
    if (state_ == kOn && objects.value(0x6007) == 3) begin_stop();
  }

  void tick() noexcept override {
    if (state_ == kQuickStop && ++stopping_ > kQuickStopTicks) state_ = kDisabled;
    const auto timeout_ms = static_cast<int>(objects.value(0x1016, 1) & 0xFFFFU);
    if (heartbeat_ms_ < 0 || timeout_ms == 0) return;
    heartbeat_ms_ += 2;
    if (heartbeat_ms_ < patience * timeout_ms) return;
    heartbeat_ms_ = -1;
    if (objects.value(0x1029, 1) == 0) network_state_ = kPreOperational;
    lose_bus();
  }

  bool enabled() const noexcept override { return state_ == kOn; }
  bool tripped() const noexcept override { return tripped_; }

  ObjectStore objects;
  std::uint16_t fault_code = 0;  ///< shown instead of the one that belongs to `fault`

 private:
  drives::MotorCommand told() const noexcept override {
    if (state_ == kQuickStop) return {.kd_Nm_s_per_rad = kBrake_Nm_s_per_rad};
    if (state_ != kOn || fault != drives::DriveFault::kNone) return {};
    if (objects.value(0x6060) == 10)
      return {.torque_Nm = 1e-3 * settings_.rated_torque_Nm * static_cast<std::int16_t>(objects.value(0x6071))};
    if (objects.value(0x6060) != 8) return {};
    const double count_rad = 2.0 * std::numbers::pi / settings_.counts_per_turn;
    return {.q_rad = count_rad * static_cast<std::int32_t>(objects.value(0x607A)),
            .kp_Nm_per_rad = settings_.kp_Nm_per_rad,
            .kd_Nm_s_per_rad = settings_.kd_Nm_s_per_rad};
  }
  // Status words without the bits that have no part in the state, but for "quick stop" and "voltage".
  static constexpr std::uint16_t kDisabled = 0x50, kReady = 0x31, kSwitchedOn = 0x33, kOn = 0x37, kQuickStop = 0x17,
                                 kFault = 0x18;
  static constexpr int kPreOperational = 127, kOperational = 5;

  static std::uint16_t code_of(drives::DriveFault fault) noexcept {
    switch (fault) {
      case drives::DriveFault::kNone:
        return 0;
      case drives::DriveFault::kOverTemperature:
        return 0x4310;
      case drives::DriveFault::kOverCurrent:
        return 0x2310;
      case drives::DriveFault::kOverVoltage:
        return 0x3210;
      case drives::DriveFault::kUnderVoltage:
        return 0x3220;
      case drives::DriveFault::kEncoder:
        return 0x7305;
      case drives::DriveFault::kBridgeTemperature:
        return 0x4210;
      case drives::DriveFault::kStall:
        return 0x7121;
      case drives::DriveFault::kCommunication:
        return 0x8130;
      case drives::DriveFault::kFollowing:
        return 0x8611;
      default:
        return 0xFF01;
    }
  }

  void begin_stop() noexcept {
    state_ = kQuickStop;
    stopping_ = 0;
  }

  /// The state machine's transitions by control word: one at a time.
  void obey(std::uint32_t word) noexcept {
    const bool reset = (word & 0x80U) != 0 && (last_word_ & 0x80U) == 0;
    last_word_ = word;
    if (state_ == kFault) {
      if (reset && fault == drives::DriveFault::kNone) state_ = kDisabled, emergency_ = 0;
      return;
    }
    const std::uint32_t bits = word & 0x0FU;
    const bool voltage = (bits & 0x2U) != 0, stop = (bits & 0x4U) == 0;
    if (!voltage) {
      state_ = kDisabled;
    } else if (stop) {
      if (state_ == kOn) begin_stop();
      if (state_ == kReady || state_ == kSwitchedOn) state_ = kDisabled;
    } else if (bits == 0x6) {
      if (state_ != kQuickStop) state_ = kReady;
    } else if (bits == 0x7) {
      if (state_ == kReady || state_ == kOn) state_ = kSwitchedOn;
    } else if (bits == 0xF) {
      if (state_ == kSwitchedOn) state_ = kOn, tripped_ = false;
    }
  }

  /// What the motor does, into the objects.
  void refresh() noexcept {
    if (fault != drives::DriveFault::kNone) {
      state_ = kFault;
      emergency_ = fault_code != 0 ? fault_code : code_of(fault);
    }
    const drives::MotorReading at = shown();
    const double count_rad = 2.0 * std::numbers::pi / settings_.counts_per_turn;
    const auto bits = [](double value) { return static_cast<std::uint32_t>(static_cast<std::int32_t>(value)); };
    objects.value(0x6064) = bits(std::round(at.q_rad / count_rad));
    objects.value(0x606C) = bits(std::round(at.dq_rad_s / settings_.velocity_unit_rad_s));
    objects.value(0x6077) = bits(std::round(1e3 * at.torque_Nm / settings_.rated_torque_Nm)) & 0xFFFFU;
    objects.value(0x603F) = state_ == kFault ? emergency_ : 0;
    objects.value(0x6041) = state_ | 0x200U;
    if (settings_.temperature_index != 0)
      objects.value(settings_.temperature_index, settings_.temperature_subindex) =
          bits(std::round(at.temperature_degC / settings_.temperature_unit_degC)) & 0xFFFFU;
  }

  drives::Message pdo_frame(int map, std::uint32_t identifier) noexcept {
    drives::Message frame;
    frame.id = identifier;
    frame.length = static_cast<std::uint8_t>(pack(map, std::span(frame.data).first(8)));
    return frame;
  }
  /// The mapped objects, as far as there is room; how many bytes.
  std::size_t pack(int map, std::span<std::uint8_t> bytes) noexcept {
    std::size_t at = 0;
    for (std::uint32_t k = 1; k <= objects.value(map, 0); ++k) {
      const std::uint32_t entry = objects.value(map, static_cast<int>(k));
      const auto* object = objects.find(static_cast<int>(entry >> 16U), static_cast<int>(entry >> 8U & 0xFFU));
      for (std::uint32_t i = 0; i < (entry & 0xFFU) / 8 && at < bytes.size(); ++i)
        bytes[at++] = static_cast<std::uint8_t>(object == nullptr ? 0 : object->value >> 8U * i);
    }
    return at;
  }
  void unpack(int map, std::span<const std::uint8_t> bytes) noexcept {
    std::size_t at = 0;
    for (std::uint32_t k = 1; k <= objects.value(map, 0); ++k) {
      const std::uint32_t entry = objects.value(map, static_cast<int>(k)), size = (entry & 0xFFU) / 8;
      auto* object = objects.find(static_cast<int>(entry >> 16U), static_cast<int>(entry >> 8U & 0xFFU));
      if (at + size > bytes.size() || object == nullptr) return;
      object->value = 0;
      for (std::uint32_t i = 0; i < size; ++i) object->value |= static_cast<std::uint32_t>(bytes[at++]) << 8U * i;
    }
  }

  drives::Cia402Settings settings_;
  int network_state_ = kPreOperational, heartbeat_ms_ = -1, stopping_ = 0;
  std::uint32_t last_word_ = 0;
  std::uint16_t state_ = kDisabled, emergency_ = 0, told_ = 0;
  bool booted_ = false, tripped_ = false;
};

}  // namespace pmg::test
