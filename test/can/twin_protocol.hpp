// A protocol unlike those of this project: two messages a request and two an answer, switched on over three cycles by
// keys in their order, numbers as floats. It exists for tests alone.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "can/link.hpp"
#include "drives/drive_type.hpp"

namespace pmg::test {

struct Twin {
  static constexpr std::uint32_t kFirst = 0x100, kSecond = 0x200, kStage = 0x300, kMotion = 0x400;
  static constexpr std::uint8_t kKey = 'K', kGains = 'G', kOff = 'O', kKeys = 3;

  static drives::Message two_floats(std::uint32_t id, double a, double b) noexcept {
    const std::array<float, 2> values = {static_cast<float>(a), static_cast<float>(b)};
    std::array<std::uint8_t, 8> bytes{};
    std::memcpy(bytes.data(), values.data(), 8);
    return drives::Message::of(id, bytes);
  }
  static std::array<double, 2> floats(const drives::Message& message) noexcept {
    std::array<float, 2> values{};
    std::memcpy(values.data(), message.data.data(), 8);
    return {static_cast<double>(values[0]), static_cast<double>(values[1])};
  }
  static drives::Message first(int node, std::uint8_t what, double kp, double kd) noexcept {
    const auto tenths = [](double gain) { return static_cast<std::uint16_t>(std::clamp(10.0 * gain, 0.0, 65535.0)); };
    const std::uint16_t p = tenths(kp), d = tenths(kd);
    return drives::Message::of(
        kFirst + static_cast<std::uint32_t>(node),
        std::array<std::uint8_t, 5>{what, static_cast<std::uint8_t>(p >> 8U), static_cast<std::uint8_t>(p),
                                    static_cast<std::uint8_t>(d >> 8U), static_cast<std::uint8_t>(d)});
  }
};

class TwinProtocol final : public drives::Protocol {
 public:
  TwinProtocol(int node, const drives::MotorLimits& limits) noexcept : node_(node), limits_(limits) {}

  void order(const Order& order, drives::Outbox& out) noexcept override {
    const drives::MotorCommand command = drives::finite(order.command) ? order.command : drives::MotorCommand{};
    if (order.enabling && stage_ < Twin::kKeys) {
      out.put(drives::Message::of(id(Twin::kFirst), std::array<std::uint8_t, 2>{Twin::kKey, std::uint8_t(stage_ + 1)}));
      out.put(Twin::two_floats(id(Twin::kSecond), 0.0, 0.0));
      return;
    }
    out.put(Twin::first(node_, Twin::kGains, command.kp_Nm_per_rad, command.kd_Nm_s_per_rad));
    out.put(Twin::two_floats(id(Twin::kSecond), std::clamp(command.q_rad, limits_.q_lower_rad, limits_.q_upper_rad),
                             std::clamp(command.torque_Nm, -limits_.torque_Nm, limits_.torque_Nm)));
  }
  void off(drives::Outbox& out) noexcept override {
    out.put(Twin::first(node_, Twin::kOff, 0.0, 0.0));
    out.put(Twin::two_floats(id(Twin::kSecond), 0.0, 0.0));
  }
  drives::Heard hear(const drives::Message& message) noexcept override {
    using What = drives::Heard::What;
    if (message.extended) return {};
    if (message.id == id(Twin::kStage) && message.length == 3) {
      stage_ = message.data[0];
      fault_ = message.data[1];
      temperature_ = message.data[2];
      half_ = true;
      return {.what = What::kNoted};
    }
    if (message.id != id(Twin::kMotion) || message.length != 8) return {};
    if (!half_) return {.what = What::kPart};
    half_ = false;
    const auto [q, dq] = Twin::floats(message);
    return {.what = What::kReading,
            .reading = {.q_rad = q,
                        .dq_rad_s = dq,
                        .temperature_degC = static_cast<double>(temperature_),
                        .fault = fault_ == 0 ? drives::DriveFault::kNone : drives::DriveFault::kOverCurrent,
                        .follows = stage_ == Twin::kKeys ? drives::Follows::kYes : drives::Follows::kNo}};
  }
  bool tells_whether_it_follows() const noexcept override { return true; }

 private:
  std::uint32_t id(std::uint32_t base) const noexcept { return base + static_cast<std::uint32_t>(node_); }

  int node_;
  drives::MotorLimits limits_;
  std::uint8_t stage_ = 0, fault_ = 0, temperature_ = 0;
  bool half_ = false;
};

class TwinDrives final : public drives::DriveType {
 public:
  explicit TwinDrives(double most_torque_Nm) : most_torque_Nm_(most_torque_Nm) {}
  std::unique_ptr<drives::Protocol> protocol(int node, const drives::MotorLimits& limits, bool) const override {
    return std::make_unique<TwinProtocol>(node, limits);
  }
  void check_covers(const drives::DriveNeeds& needs, const std::string& joint, const std::string& drive,
                    const files::ConfigReader& reader) const override {
    drives::check_cover({"most_torque_Nm", "effort", needs.limits.torque_Nm, most_torque_Nm_}, joint, drive, reader);
  }
  std::vector<drives::MotorId> ids(int node) const override {
    const auto number = static_cast<std::uint32_t>(node);
    return {{.id = Twin::kFirst + number, .what = "commands"},
            {.id = Twin::kSecond + number, .what = "commands"},
            {.id = Twin::kStage + number, .what = "answers", .answer = true},
            {.id = Twin::kMotion + number, .what = "answers", .answer = true}};
  }
  std::optional<int> sender(const drives::Message& message) const noexcept override {
    return !message.extended && message.id > Twin::kMotion && message.id < Twin::kMotion + 0x80
               ? std::optional<int>(static_cast<int>(message.id - Twin::kMotion))
               : std::nullopt;
  }
  int messages_a_cycle() const noexcept override { return 4; }
  double torque_step_Nm() const noexcept override { return 0.0; }

 private:
  double most_torque_Nm_;
};

/// The drive at the other end.
class TwinEmulator {
 public:
  TwinEmulator(can::Link& link, int node) : link_(link), node_(static_cast<std::uint32_t>(node)) {}

  void answer() noexcept {
    std::array<drives::Message, 16> frames;
    while (const std::size_t count = link_.receive(frames)) {
      for (const drives::Message& frame : std::span(frames).first(count)) hear(frame);
    }
  }

  drives::MotorReading motor;
  drives::MotorCommand command;
  int stage = 0, keys = 0, lost_halves = 0;
  bool silent = false, twice = false, faulty = false;
  std::optional<int> other_node;  ///< that it answers as

 private:
  void hear(const drives::Message& frame) noexcept {
    if (frame.id == Twin::kFirst + node_) {
      first_ = frame;
      return;
    }
    if (frame.id != Twin::kSecond + node_ || first_.length == 0 || silent) return;
    act(Twin::floats(frame));
    first_.length = 0;
    for (int k = 0; k < (twice ? 2 : 1); ++k) {
      const std::uint32_t node = other_node ? static_cast<std::uint32_t>(*other_node) : node_;
      if (lost_halves > 0) {
        --lost_halves;
      } else {
        send(drives::Message::of(
            Twin::kStage + node,
            std::array<std::uint8_t, 3>{static_cast<std::uint8_t>(stage), static_cast<std::uint8_t>(faulty), 40}));
      }
      send(Twin::two_floats(Twin::kMotion + node, motor.q_rad, motor.dq_rad_s));
    }
  }
  void act(const std::array<double, 2>& second) noexcept {
    if (first_.data[0] == Twin::kKey) {
      ++keys;
      stage = first_.data[1] == stage + 1 ? stage + 1 : 0;
    } else if (first_.data[0] == Twin::kOff) {
      stage = 0;
    } else if (stage == Twin::kKeys) {
      const auto tenths = [this](std::size_t at) { return 0.1 * (first_.data[at] << 8U | first_.data[at + 1]); };
      command = {.q_rad = second[0], .kp_Nm_per_rad = tenths(1), .kd_Nm_s_per_rad = tenths(3), .torque_Nm = second[1]};
    }
  }
  void send(const drives::Message& frame) noexcept { link_.send(std::span(&frame, 1)); }

  can::Link& link_;
  std::uint32_t node_;
  drives::Message first_{};
};

}  // namespace pmg::test
