#include "drive_protocols/canopen_drive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "drive_protocols/canopen.hpp"

namespace pmg::drives {

namespace {

constexpr int kStartCycles = 50;  // between two requests to start a silent node: 0.1 s

class CanopenNode final : public Protocol {
 public:
  CanopenNode(const Cia402Settings& settings, int node, const MotorLimits& limits) noexcept
      : node_(node), axis_(settings, limits) {}

  AskedBy asked_by() const noexcept override { return AskedBy::kSync; }

  /// A node that is silent is started anew now and then: it may have left the state "operational".
  void order(const Order& order, Outbox& out) noexcept override {
    order_ = order;
    off_ = false;
    if (!order.silent || order.stiff || ++since_start_ < kStartCycles) return;
    since_start_ = 0;
    out.put(canopen::node_command(canopen::NodeCommand::kStart, node_));
  }
  void off(Outbox& /*out*/) noexcept override { off_ = true; }
  void follow_up(const MotorReading& measured, Freshness freshness, Outbox& out) noexcept override {
    out.put(canopen::targets_frame(
        node_, off_ ? Cia402Targets{} : axis_.command(order_.command, order_.stiff, measured, freshness)));
  }

  Heard hear(const Message& message) noexcept override {
    using What = Heard::What;
    const auto node = static_cast<std::uint32_t>(node_);
    if (message.extended || message.fd || (message.id & canopen::kNodeBits) != node) return {};
    switch (message.id - node) {
      case canopen::kTransmit1:
        if (!canopen::take_transmit1(message, inputs_)) return {};
        half_ = true;
        return {.what = What::kNoted};
      case canopen::kTransmit2:
        if (!canopen::take_transmit2(message, inputs_)) return {};
        if (!half_) return {.what = What::kPart};
        half_ = false;
        if (inputs_.error_code == 0) inputs_.error_code = emergency_;
        return {.what = What::kReading, .reading = axis_.hear(inputs_)};
      case canopen::kEmergency:
        if (message.length != 8) return {};
        emergency_ = static_cast<std::uint16_t>(message.data[0] | message.data[1] << 8U);
        return {.what = What::kNoted};
      case canopen::kHeartbeat:
        if (message.length != 1) return {};
        return {.what = message.data[0] == canopen::kBootUp ? What::kBootUp : What::kNoted};
      default:
        return {};
    }
  }

  bool tells_whether_it_follows() const noexcept override { return true; }
  bool refuses_gains() const noexcept override { return axis_.refused(); }
  std::uint16_t emergency() const noexcept override { return emergency_; }

 private:
  int node_;
  Cia402Axis axis_;
  Cia402Inputs inputs_{};
  Order order_{};
  bool off_ = false;
  bool half_ = false;  // TPDO1 came, its TPDO2 not yet
  std::uint16_t emergency_ = 0;
  int since_start_ = 0;  // cycles
};

/// SYNC asks all of its nodes; this computer's heartbeat keeps them on.
class CanopenNetwork final : public Network {
 public:
  std::span<const NetworkMessage> messages() const noexcept override {
    static constexpr std::array<NetworkMessage, 3> kMessages = {
        {{.id = canopen::kNetworkManagement, .who = "CANopen's node commands", .bytes = 2},
         {.id = canopen::kSync, .who = "CANopen's SYNC", .bytes = 0, .in_cycle = true},
         {.id = canopen::kHeartbeat + canopen::kHostNode,
          .who = "this computer's heartbeat",
          .bytes = 1,
          .in_cycle = true}}};
    return kMessages;
  }
  Message sync() const noexcept override { return canopen::sync(); }
  void sign_of_life(int cycles, Outbox& out) noexcept override {
    since_ += cycles;
    if (since_ < canopen::kHeartbeatCycles) return;
    since_ = 0;
    out.put(canopen::heartbeat());
  }

 private:
  int since_ = canopen::kHeartbeatCycles;  // cycles
};

}  // namespace

std::unique_ptr<Network> CanopenDrive::network() const { return std::make_unique<CanopenNetwork>(); }

std::unique_ptr<Protocol> CanopenDrive::protocol(int node, const MotorLimits& limits, bool /*fd*/) const {
  return std::make_unique<CanopenNode>(settings_, node, limits);
}

void CanopenDrive::check_covers(const DriveNeeds& needs, const std::string& joint, const std::string& drive,
                                const files::ConfigReader& reader) const {
  constexpr double kMost16 = std::numeric_limits<std::int16_t>::max(),
                   kMost32 = std::numeric_limits<std::int32_t>::max();
  const double range_rad = std::max(std::abs(needs.limits.q_lower_rad), std::abs(needs.limits.q_upper_rad));
  check_cover({"torque_Nm", "effort", needs.limits.torque_Nm, settings_.largest_torque_Nm}, joint, drive, reader);
  check_cover({"torque (32.767 times rated_torque_Nm)", "effort", needs.limits.torque_Nm,
               1e-3 * kMost16 * settings_.rated_torque_Nm},
              joint, drive, reader);
  check_cover({"position in 32 bits", "range", range_rad, kMost32 * settings_.count_rad()}, joint, drive, reader);
  if (settings_.mode == Cia402Mode::kTorque) return;
  const auto same = [](double a, double b) { return std::abs(a - b) <= Cia402Axis::kSameGains * b; };
  if (same(needs.gains.kp_Nm_per_rad, settings_.kp_Nm_per_rad) &&
      same(needs.gains.kd_Nm_s_per_rad, settings_.kd_Nm_s_per_rad))
    return;
  reader.fail("bus",
              fmt::format("the drive '{}' closes its position loop with kp {:g} and kd {:g}; {}'s gains are {:g} and "
                          "{:g} at the motor",
                          drive, settings_.kp_Nm_per_rad, settings_.kd_Nm_s_per_rad, joint, needs.gains.kp_Nm_per_rad,
                          needs.gains.kd_Nm_s_per_rad),
              "the drive's own gains, or `mode: torque`");
}

std::vector<MotorId> CanopenDrive::ids(int node) const {
  const auto number = static_cast<std::uint32_t>(node);
  std::vector<MotorId> ids;
  for (const std::uint32_t function : {canopen::kReceive1, canopen::kSdoRequest})
    ids.push_back({.id = function + number, .what = "commands"});
  for (const std::uint32_t function :
       {canopen::kEmergency, canopen::kTransmit1, canopen::kTransmit2, canopen::kSdoAnswer, canopen::kHeartbeat})
    ids.push_back({.id = function + number, .what = "answers", .answer = true});
  return ids;
}

std::optional<int> CanopenDrive::sender(const Message& message) const noexcept { return canopen::sender(message); }

Cia402Settings read_cia402(files::ConfigReader& reader) {
  constexpr double kMost32 = std::numeric_limits<std::int32_t>::max();
  Cia402Settings settings;
  const bool torque = reader.one_of("mode", {"torque", "position"}) == "torque";
  settings.mode = torque ? Cia402Mode::kTorque : Cia402Mode::kPosition;
  settings.counts_per_turn = reader.required<double>("counts_per_turn", files::in_range(1.0, kMost32));
  settings.velocity_unit_rad_s = reader.required<double>("velocity_unit_rad_s", files::positive());
  settings.rated_torque_Nm = reader.required<double>("rated_torque_Nm", files::positive());
  settings.largest_torque_Nm = reader.required<double>("torque_Nm", files::positive());
  if (!torque) {
    settings.kp_Nm_per_rad = reader.required<double>("kp_Nm_per_rad", files::positive());
    settings.kd_Nm_s_per_rad = reader.required<double>("kd_Nm_s_per_rad", files::non_negative());
  }
  settings.vendor_id =
      static_cast<std::uint32_t>(reader.optional<double>("vendor_id", 0, files::in_range(0, 0xFFFFFFFFU)));
  settings.product_code =
      static_cast<std::uint32_t>(reader.optional<double>("product_code", 0, files::in_range(0, 0xFFFFFFFFU)));
  settings.temperature_index =
      static_cast<std::uint16_t>(reader.optional<int>("temperature_index", 0, files::in_range(0x2000, 0x9FFF)));
  settings.temperature_subindex =
      static_cast<std::uint8_t>(reader.optional<int>("temperature_subindex", 0, files::in_range(0, 255)));
  settings.temperature_unit_degC = reader.optional<double>("temperature_unit_degC", 1.0, files::positive());
  return settings;
}

DriveKind cia402_drive(const Cia402Settings& settings) { return std::make_shared<CanopenDrive>(settings); }

const Cia402Settings* as_cia402(const DriveKind& kind) noexcept {
  const auto* drive = dynamic_cast<const CanopenDrive*>(kind.get());
  return drive == nullptr ? nullptr : &drive->settings();
}

}  // namespace pmg::drives
