#include "runtime/operator_gate.hpp"

#include <algorithm>
#include <utility>

#include "pmg_msgs/arms_t.hpp"
#include "pmg_msgs/command_t.hpp"
#include "pmg_msgs/mode_t.hpp"
#include "recording/tick_messages.hpp"

namespace pmg::runtime {

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
                           const seal::ControllerSeal& seal, DatagramOrder& order)
    : inbox_(inbox), robot_(std::move(robot)), clock_(clock), seal_(seal), order_(order) {}

template <typename Message>
void OperatorGate::let_through(const Message& message, Stream stream, MessageKind kind) {
  using Place = DatagramOrder::Place;
  const Place place = order_.take(message.source, stream, message.sequence, message.stamp_ns, message.received_ns);
  const bool repeatable = stream == Stream::kRequest;
  if (place == Place::kOld || (place == Place::kRepeated && !repeatable)) {
    ++counts_.out_of_order;  // before it costs its operator anything
  } else if (place == Place::kNoRoom || !rates_.admit(message.source, kind, message.received_ns) ||
             !inbox_.put(message)) {
    ++counts_.flooded;
  }
}

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
    let_through(recording::drive_message(sealed->message, now_ns), Stream::kCommand, MessageKind::kCommand);
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
    let_through(recording::arms_message(sealed->message, now_ns), Stream::kArms, MessageKind::kArms);
  }
}

void OperatorGate::take_mode(io::Bytes bytes) {
  auto sealed = seal::decode_sealed<pmg_msgs::mode_t, pmg_msgs::seal_t>(bytes);
  const bool whole = sealed.has_value();
  if (!whole)
    sealed = seal::decode_front<pmg_msgs::mode_t, pmg_msgs::seal_t>(bytes);  // a stop stops, whatever follows it
  if (!sealed || !presentable(sealed->message.source)) {
    ++counts_.malformed;
    return;
  }
  const pmg_msgs::mode_t& message = sealed->message;
  control::ModeRequest request = recording::mode_request(message, clock_.now_ns());
  if (!whole && !request.stops()) {
    ++counts_.malformed;
    return;
  }
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
    take_stop(request, sealed->message_bytes);
  } else if (counts_.good(judgement)) {
    request.digest = seal::digest_of(sealed->message_bytes);
    request.heard_ns = sealed->seal->heard_ns;
    let_through(request, Stream::kRequest, MessageKind::kRequest);
  } else if (judgement == seal::ControllerSeal::Judgement::kNoKey && rates_.admit_stranger(request.received_ns)) {
    refusals_.push_back({.source = request.source,
                         .sequence = request.sequence,
                         .verdict = control::Verdict::kNoKey,
                         .digest = seal::digest_of(sealed->message_bytes)});
  }
}

void OperatorGate::take_stop(control::ModeRequest request, io::Bytes message) {
  using Place = DatagramOrder::Place;
  if (request.sealed) {
    const Place place =
        order_.take(request.source, Stream::kRequest, request.sequence, request.stamp_ns, request.received_ns);
    request.sealed = place == Place::kNew || place == Place::kRepeated;  // what was recorded is anybody's
  }
  const bool admitted = request.sealed ? rates_.admit(request.source, MessageKind::kStop, request.received_ns)
                                       : rates_.admit_stranger(request.received_ns);
  // A stop beyond its source's rate stops all the same; it only isn't acknowledged one by one.
  if (!admitted) {
    inbox_.stop();
  } else {
    request.digest = seal::digest_of(message);
  }
  const bool taken = admitted && inbox_.put(request);
  if (!taken) ++counts_.flooded;
}

}  // namespace pmg::runtime
