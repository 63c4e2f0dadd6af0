#include "runtime/operator_gate.hpp"

#include <algorithm>
#include <utility>

#include "control/source_memory.hpp"
#include "pmg_msgs/arms_t.hpp"
#include "pmg_msgs/command_t.hpp"
#include "pmg_msgs/mode_t.hpp"
#include "recording/tick_messages.hpp"

namespace pmg::runtime {

// A source's messages are fresh for a second: whoever is forgotten earlier could be played back.
static_assert(seal::ControllerSeal::kFresh_ns <= 2 * control::SourceRates::kSilent_ns);
static_assert(control::SourceMemory::kSources > 2 * control::SourceRates::kSources);

bool presentable(const std::string& name) {
  return !name.empty() && name.size() < control::Source{}.name.size() &&
         std::ranges::all_of(name, [](char c) { return c >= ' ' && c <= '~'; });
}

namespace {

bool is_wish(std::int8_t wish) noexcept {
  return wish >= pmg_msgs::arms_t::HOLD && wish <= pmg_msgs::arms_t::HAND_BACK;
}

}  // namespace

OperatorGate::OperatorGate(control::OperatorInbox& inbox, std::string robot, const io::Clock& clock,
                           const seal::ControllerSeal& seal)
    : inbox_(inbox), robot_(std::move(robot)), clock_(clock), seal_(seal) {}

void OperatorGate::take_command(io::Bytes bytes) {
  const auto sealed = seal::decode_sealed<pmg_msgs::command_t, pmg_msgs::seal_t>(bytes);
  const std::int64_t now_ns = clock_.now_ns();
  if (!sealed || !presentable(sealed->message.source)) {
    ++counts_.malformed;
  } else if (sealed->message.version != pmg_msgs::command_t::VERSION) {
    ++counts_.other_version;
  } else if (sealed->message.robot != robot_) {
    ++counts_.other_robot;
  } else if (counts_.good(
                 seal_.judge("COMMAND", sealed->message.source, sealed->message_bytes, sealed->seal, now_ns))) {
    const control::DriveMessage drive = recording::drive_message(sealed->message, now_ns);
    const bool taken =
        rates_.admit(drive.source, control::MessageKind::kCommand, drive.received_ns) && inbox_.put(drive);
    if (!taken) ++counts_.flooded;
  }
}

void OperatorGate::take_arms(io::Bytes bytes) {
  const auto sealed = seal::decode_sealed<pmg_msgs::arms_t, pmg_msgs::seal_t>(bytes);
  const std::int64_t now_ns = clock_.now_ns();
  if (!sealed || !presentable(sealed->message.source) || !is_wish(sealed->message.left) ||
      !is_wish(sealed->message.right)) {
    ++counts_.malformed;
  } else if (sealed->message.version != pmg_msgs::arms_t::VERSION) {
    ++counts_.other_version;
  } else if (sealed->message.robot != robot_) {
    ++counts_.other_robot;
  } else if (counts_.good(seal_.judge("ARMS", sealed->message.source, sealed->message_bytes, sealed->seal, now_ns))) {
    const control::ArmsMessage arms = recording::arms_message(sealed->message, now_ns);
    const bool taken = rates_.admit(arms.source, control::MessageKind::kArms, arms.received_ns) && inbox_.put(arms);
    if (!taken) ++counts_.flooded;
  }
}

void OperatorGate::take_mode(io::Bytes bytes) {
  const auto sealed = seal::decode_sealed<pmg_msgs::mode_t, pmg_msgs::seal_t>(bytes);
  if (!sealed || !presentable(sealed->message.source)) {
    ++counts_.malformed;
    return;
  }
  const pmg_msgs::mode_t& message = sealed->message;
  control::ModeRequest request = recording::mode_request(message, clock_.now_ns());
  if (message.mode < pmg_msgs::mode_t::PASSIVE || message.mode > pmg_msgs::mode_t::WALK) {
    request.mode = control::Mode::kFault;  // answered with NO_MODE
  }
  const bool our_version = message.version == pmg_msgs::mode_t::VERSION;
  if (!our_version && !request.stops()) {
    ++counts_.other_version;
    return;
  }
  const bool for_every_robot = message.robot.empty() && request.stops();
  if (message.robot != robot_ && !for_every_robot) {
    ++counts_.other_robot;
    return;
  }
  const auto judgement = seal_.judge("MODE", message.source, sealed->message_bytes, sealed->seal, request.received_ns);
  request.sealed = our_version && judgement == seal::ControllerSeal::Judgement::kGood;
  if (request.stops()) {
    take_stop(request);
  } else if (counts_.good(judgement)) {
    const bool taken =
        rates_.admit(request.source, control::MessageKind::kRequest, request.received_ns) && inbox_.put(request);
    if (!taken) ++counts_.flooded;
  }
}

void OperatorGate::take_stop(const control::ModeRequest& request) {
  const bool admitted = request.sealed ? rates_.admit(request.source, control::MessageKind::kStop, request.received_ns)
                                       : rates_.admit_stranger(request.received_ns);
  // A stop beyond its source's rate stops all the same; it only isn't acknowledged one by one.
  if (!admitted) inbox_.stop();
  const bool taken = admitted && inbox_.put(request);
  if (!taken) ++counts_.flooded;
}

}  // namespace pmg::runtime
