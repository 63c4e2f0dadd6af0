#include "can/bus_motor.hpp"

#include <algorithm>

#include "can/canopen_setup.hpp"
#include "can/xsens_imu.hpp"

namespace pmg::can {

namespace {

constexpr int kStartCycles = 50;  // between two requests to start a silent node: 0.1 s

bool known(const drives::BusSetup& bus, int node) noexcept {
  return std::ranges::find(bus.motors, node, &drives::MotorSetup::node) != bus.motors.end();
}

}  // namespace

int fresh_cycles(const drives::BusSetup& bus) noexcept {
  return bus.bridge_slave != 0 ? drives::MotorMonitor::kFreshOverBridge : drives::MotorMonitor::kFreshCycles;
}

BusMotor::BusMotor(const drives::MotorSetup& setup, const drives::BusSetup& bus,
                   drives::MotorMonitor& monitor) noexcept
    : setup_(&setup),
      drive_([&]() -> std::variant<Mit, Canopen> {
        if (const auto* mit = std::get_if<drives::MitRanges>(&setup.drive))
          return Mit{.protocol = drives::MitProtocol(*mit), .reply_id = mit->reply_id, .fd = bus.data_bitrate != 0};
        return Canopen{.axis = drives::Cia402Axis(*std::get_if<drives::Cia402Settings>(&setup.drive), setup.limits)};
      }()),
      monitor_(&monitor) {}

std::optional<Frame> BusMotor::ask(const drives::MotorCommand& wanted, const Cycle& cycle) noexcept {
  const drives::MotorCommand at_motor = setup_->transmission.to_motor(wanted);
  if (auto* canopen = std::get_if<Canopen>(&drive_)) {
    canopen->wanted = at_motor;
    canopen->stiff = cycle.stiff;
    canopen->off = false;
    asked_ = cycle.synced;
    if (asked_) monitor_->ask(false);
    if (!monitor_->silent() || cycle.stiff || ++canopen->since_start < kStartCycles) return std::nullopt;
    canopen->since_start = 0;
    return canopen::node_command(canopen::NodeCommand::kStart, setup_->node);
  }
  Mit& mit = *std::get_if<Mit>(&drive_);
  asked_ = cycle.urgent || !monitor_->pauses();
  if (!asked_) return std::nullopt;
  const bool enabling = !monitor_->enabled() && !cycle.stiff;
  monitor_->ask(enabling);
  return Frame::of(static_cast<std::uint32_t>(setup_->node),
                   enabling ? drives::kMitEnable : mit.protocol.command(at_motor, setup_->limits, mit.left_Nm), mit.fd);
}

std::optional<Frame> BusMotor::ask_off(bool synced) noexcept {
  if (auto* canopen = std::get_if<Canopen>(&drive_)) {
    canopen->off = true;
    asked_ = synced;
    if (asked_) monitor_->ask(false);
    return std::nullopt;
  }
  asked_ = true;
  monitor_->ask(false);
  return Frame::of(static_cast<std::uint32_t>(setup_->node), drives::kMitDisable, std::get_if<Mit>(&drive_)->fd);
}

void BusMotor::not_asked() noexcept {
  if (asked_) monitor_->take_back();
  asked_ = false;
}

bool BusMotor::hear(const Frame& frame) noexcept {
  const Heard heard = overhear(frame);
  switch (heard.what) {
    case Heard::What::kForeign:
      return false;
    case Heard::What::kReading:
      monitor_->hear(heard.reading);
      return true;
    case Heard::What::kPart:
      monitor_->hear_stray();
      return true;
    case Heard::What::kBootUp:
      monitor_->restarted();
      return true;
    case Heard::What::kNoted:
      return true;
  }
  return true;
}

BusMotor::Heard BusMotor::overhear(const Frame& frame) noexcept {
  if (auto* canopen = std::get_if<Canopen>(&drive_)) return overhear(*canopen, frame);
  const Mit& mit = *std::get_if<Mit>(&drive_);
  if (frame.extended || frame.id != mit.reply_id) return {};
  const auto reply = mit.protocol.reply(frame.bytes());
  if (!reply || reply->node != setup_->node) return {};
  return {.what = Heard::What::kReading, .reading = reply->reading};
}

BusMotor::Heard BusMotor::overhear(Canopen& drive, const Frame& frame) const noexcept {
  using What = Heard::What;
  const auto node = static_cast<std::uint32_t>(setup_->node);
  if (frame.extended || frame.fd || (frame.id & canopen::kNodeBits) != node) return {};
  switch (frame.id - node) {
    case canopen::kTransmit1:
      if (!canopen::take_transmit1(frame, drive.inputs)) return {};
      drive.half = true;
      return {.what = What::kNoted};
    case canopen::kTransmit2:
      if (!canopen::take_transmit2(frame, drive.inputs)) return {};
      if (!drive.half) return {.what = What::kPart};
      drive.half = false;
      if (drive.inputs.error_code == 0) drive.inputs.error_code = drive.emergency;
      return {.what = What::kReading, .reading = drive.axis.hear(drive.inputs)};
    case canopen::kEmergency:
      if (frame.length != 8) return {};
      drive.emergency = static_cast<std::uint16_t>(frame.data[0] | frame.data[1] << 8U);
      return {.what = What::kNoted};
    case canopen::kHeartbeat:
      if (frame.length != 1) return {};
      return {.what = frame.data[0] == canopen::kBootUp ? What::kBootUp : What::kNoted};
    default:
      return {};
  }
}

drives::Freshness BusMotor::freshness() const noexcept {
  if (!monitor_->answered() || monitor_->silent()) return drives::Freshness::kNone;
  const bool fresh = monitor_->believed() && monitor_->fresh();
  return fresh ? drives::Freshness::kFresh : drives::Freshness::kLate;
}

std::optional<Frame> BusMotor::targets() noexcept {
  auto* canopen = std::get_if<Canopen>(&drive_);
  if (canopen == nullptr) return std::nullopt;
  if (canopen->off) return canopen::targets_frame(setup_->node, {});
  const drives::Cia402Targets targets =
      canopen->axis.command(canopen->wanted, canopen->stiff, monitor_->reading(), freshness());
  monitor_->refuse_gains(canopen->axis.refused());
  return canopen::targets_frame(setup_->node, targets);
}

void BusMotor::interrupt() noexcept {
  if (std::holds_alternative<Mit>(drive_)) monitor_->interrupt();
}

double BusMotor::torque_step_Nm() const noexcept {
  if (const auto* mit = std::get_if<Mit>(&drive_)) return mit->protocol.torque().step();
  return 1e-3 * std::get_if<Canopen>(&drive_)->axis.settings().rated_torque_Nm;
}

std::uint16_t BusMotor::emergency() const noexcept {
  const auto* canopen = std::get_if<Canopen>(&drive_);
  return canopen == nullptr ? std::uint16_t{0} : canopen->emergency;
}

std::optional<int> mit_stranger(const drives::BusSetup& bus, const Frame& frame) noexcept {
  if (frame.extended || frame.length != 8 || known(bus, frame.data[0])) return std::nullopt;
  const bool reply = std::ranges::any_of(bus.motors, [&](const drives::MotorSetup& motor) {
    const auto* mit = std::get_if<drives::MitRanges>(&motor.drive);
    return mit != nullptr && mit->reply_id == frame.id;
  });
  return reply ? std::optional<int>(frame.data[0]) : std::nullopt;
}

std::optional<int> stranger(const drives::BusSetup& bus, const Frame& frame) noexcept {
  if (const auto node = mit_stranger(bus, frame)) return node;
  const int node = static_cast<int>(frame.id & canopen::kNodeBits);
  const std::uint32_t function = frame.id & ~canopen::kNodeBits;
  const bool cyclic = function == canopen::kTransmit1 || function == canopen::kTransmit2 ||
                      function == canopen::kEmergency || function == canopen::kHeartbeat;
  if (frame.extended || !cyclic || node == 0 || known(bus, node)) return std::nullopt;
  return node;
}

std::vector<std::uint32_t> awaited_ids(const drives::BusSetup& bus) {
  std::vector<std::uint32_t> ids;
  for (const drives::MotorSetup& motor : bus.motors) {
    const auto node = static_cast<std::uint32_t>(motor.node);
    if (const auto* mit = std::get_if<drives::MitRanges>(&motor.drive)) {
      if (std::ranges::find(ids, mit->reply_id) == ids.end()) ids.push_back(mit->reply_id);
    } else {
      for (const std::uint32_t function :
           {canopen::kTransmit1, canopen::kTransmit2, canopen::kEmergency, canopen::kHeartbeat, canopen::kSdoAnswer})
        ids.push_back(function + node);
    }
  }
  if (bus.imu) ids.insert(ids.end(), {kImuQuaternion, kImuRateOfTurn, kImuAcceleration});
  return ids;
}

}  // namespace pmg::can
