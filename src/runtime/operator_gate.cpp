#include "runtime/operator_gate.hpp"

#include <algorithm>
#include <utility>

#include "pmg_msgs/command_t.hpp"
#include "pmg_msgs/mode_t.hpp"
#include "runtime/tick_messages.hpp"

namespace pmg::runtime {

bool presentable(const std::string& name) {
  return !name.empty() && name.size() < control::Source{}.name.size() &&
         std::ranges::all_of(name, [](char c) { return c >= ' ' && c <= '~'; });
}

OperatorGate::OperatorGate(control::OperatorInbox& inbox, std::string robot, const io::Clock& clock)
    : inbox_(inbox), robot_(std::move(robot)), clock_(clock) {}

void OperatorGate::take_command(io::Bytes bytes) {
  const auto message = io::decode_message<pmg_msgs::command_t>(bytes);
  if (!message || !presentable(message->source)) {
    ++counts_.malformed;
  } else if (message->version != pmg_msgs::command_t::VERSION) {
    ++counts_.other_version;
  } else if (message->robot != robot_) {
    ++counts_.other_robot;
  } else {
    const control::DriveMessage drive = drive_message(*message, clock_.now_ns());
    const bool taken =
        rates_.admit(drive.source, control::MessageKind::kCommand, drive.received_ns) && inbox_.put(drive);
    if (!taken) ++counts_.flooded;
  }
}

void OperatorGate::take_mode(io::Bytes bytes) {
  const auto message = io::decode_message<pmg_msgs::mode_t>(bytes);
  if (!message || !presentable(message->source)) {
    ++counts_.malformed;
    return;
  }
  if (message->version != pmg_msgs::mode_t::VERSION) {
    ++counts_.other_version;
    return;
  }
  control::ModeRequest request = mode_request(*message, clock_.now_ns());
  if (message->mode < pmg_msgs::mode_t::PASSIVE || message->mode > pmg_msgs::mode_t::WALK) {
    request.mode = control::Mode::kFault;  // answered with NO_MODE
  }
  const bool for_every_robot = message->robot.empty() && request.stops();
  if (message->robot != robot_ && !for_every_robot) {
    ++counts_.other_robot;
    return;
  }
  const control::MessageKind kind = request.stops() ? control::MessageKind::kStop : control::MessageKind::kRequest;
  const bool admitted = rates_.admit(request.source, kind, request.received_ns);
  // A stop beyond its source's rate stops all the same; it only isn't acknowledged one by one.
  if (!admitted && request.stops()) inbox_.stop();
  const bool taken = admitted && inbox_.put(request);
  if (!taken) ++counts_.flooded;
}

}  // namespace pmg::runtime
