#include "can/bus_motor.hpp"

#include <algorithm>

#include "can/canopen_setup.hpp"
#include "can/xsens_imu.hpp"

namespace pmg::can {

namespace {

constexpr std::uint32_t kMostMitId = 0x7F;
constexpr int kStartCycles = 50;  // between two requests to start a silent node: 0.1 s

}  // namespace

BusMotor::BusMotor(const drives::MotorSetup& setup, bool fd) noexcept
    : setup_(&setup),
      drive_([&]() -> std::variant<Mit, Canopen> {
        if (const auto* mit = std::get_if<drives::MitRanges>(&setup.drive))
          return Mit{.protocol = drives::MitProtocol(*mit), .reply_id = mit->reply_id, .fd = fd};
        return Canopen{.axis = drives::Cia402Axis(*std::get_if<drives::Cia402Settings>(&setup.drive), setup.limits)};
      }()),
      monitor_(setup.limits) {}

std::optional<Frame> BusMotor::begin(const drives::MotorCommand& wanted, bool stiff) noexcept {
  const drives::MotorCommand at_motor = setup_->transmission.to_motor(wanted);
  if (auto* canopen = std::get_if<Canopen>(&drive_)) {
    canopen->wanted = at_motor;
    canopen->stiff = stiff;
    canopen->off = false;
    monitor_.ask(false);
    const bool silent = monitor_.age_cycles() > drives::MotorMonitor::kSilentCycles;
    if (!silent || stiff || ++canopen->since_start < kStartCycles) return std::nullopt;
    canopen->since_start = 0;
    return canopen::node_command(canopen::NodeCommand::kStart, setup_->node);
  }
  Mit& mit = *std::get_if<Mit>(&drive_);
  const bool enabling = !monitor_.enabled() && !stiff;
  monitor_.ask(enabling);
  return Frame::of(static_cast<std::uint32_t>(setup_->node),
                   enabling ? drives::kMitEnable : mit.protocol.command(at_motor, setup_->limits, mit.left_Nm), mit.fd);
}

std::optional<Frame> BusMotor::begin_off() noexcept {
  monitor_.ask(false);
  if (auto* canopen = std::get_if<Canopen>(&drive_)) {
    canopen->off = true;
    return std::nullopt;
  }
  return Frame::of(static_cast<std::uint32_t>(setup_->node), drives::kMitDisable, std::get_if<Mit>(&drive_)->fd);
}

bool BusMotor::hear(const Frame& frame) noexcept {
  if (auto* canopen = std::get_if<Canopen>(&drive_)) return hear(*canopen, frame);
  const Mit& mit = *std::get_if<Mit>(&drive_);
  if (frame.extended || frame.id != mit.reply_id) return false;
  const auto reply = mit.protocol.reply(frame.bytes());
  if (!reply || reply->node != setup_->node) return false;
  monitor_.hear(reply->reading);
  return true;
}

bool BusMotor::hear(Canopen& drive, const Frame& frame) noexcept {
  const auto node = static_cast<std::uint32_t>(setup_->node);
  if (frame.extended || frame.fd || (frame.id & canopen::kNodeBits) != node) return false;
  switch (frame.id - node) {
    case canopen::kTransmit1:
      if (!canopen::take_transmit1(frame, drive.inputs)) return false;
      drive.half = true;
      return true;
    case canopen::kTransmit2:
      if (!canopen::take_transmit2(frame, drive.inputs)) return false;
      if (!drive.half) {
        monitor_.hear_stray();
        return true;
      }
      drive.half = false;
      if (drive.inputs.error_code == 0) drive.inputs.error_code = drive.emergency;
      monitor_.hear(drive.axis.hear(drive.inputs));
      return true;
    case canopen::kEmergency:
      if (frame.length != 8) return false;
      drive.emergency = static_cast<std::uint16_t>(frame.data[0] | frame.data[1] << 8U);
      return true;
    case canopen::kHeartbeat:
      if (frame.length != 1) return false;
      if (frame.data[0] == canopen::kBootUp) monitor_.restarted();
      return true;
    default:
      return false;
  }
}

drives::Freshness BusMotor::freshness() const noexcept {
  if (!monitor_.answered() || monitor_.age_cycles() > drives::MotorMonitor::kSilentCycles)
    return drives::Freshness::kNone;
  const bool fresh = monitor_.believed() && monitor_.age_cycles() <= drives::MotorMonitor::kFreshCycles;
  return fresh ? drives::Freshness::kFresh : drives::Freshness::kLate;
}

std::optional<Frame> BusMotor::targets() noexcept {
  auto* canopen = std::get_if<Canopen>(&drive_);
  if (canopen == nullptr) return std::nullopt;
  if (canopen->off) return canopen::targets_frame(setup_->node, {});
  const drives::Cia402Targets targets =
      canopen->axis.command(canopen->wanted, canopen->stiff, monitor_.reading(), freshness());
  monitor_.refuse_gains(canopen->axis.refused());
  return canopen::targets_frame(setup_->node, targets);
}

void BusMotor::interrupt() noexcept {
  if (std::holds_alternative<Mit>(drive_)) monitor_.interrupt();
}

double BusMotor::torque_step_Nm() const noexcept {
  if (const auto* mit = std::get_if<Mit>(&drive_)) return mit->protocol.torque().step();
  return 1e-3 * std::get_if<Canopen>(&drive_)->axis.settings().rated_torque_Nm;
}

std::uint16_t BusMotor::emergency() const noexcept {
  const auto* canopen = std::get_if<Canopen>(&drive_);
  return canopen == nullptr ? std::uint16_t{0} : canopen->emergency;
}

std::optional<int> sender(const Frame& frame) noexcept {
  if (frame.extended) return std::nullopt;
  if (frame.id <= kMostMitId) return frame.length == 8 ? std::optional<int>(frame.data[0]) : std::nullopt;
  const std::uint32_t node = frame.id & canopen::kNodeBits, function = frame.id - node;
  const bool known = function == canopen::kTransmit1 || function == canopen::kTransmit2 ||
                     function == canopen::kEmergency || function == canopen::kHeartbeat;
  return known && node != 0 ? std::optional<int>(static_cast<int>(node)) : std::nullopt;
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

std::size_t network_frames(int cycle, std::span<Frame, 2> frames) noexcept {
  frames[0] = canopen::sync();
  if (cycle % kHeartbeatCycles != 0) return 1;
  frames[1] = canopen::heartbeat();
  return 2;
}

}  // namespace pmg::can
