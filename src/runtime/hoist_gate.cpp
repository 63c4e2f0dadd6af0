#include "runtime/hoist_gate.hpp"

namespace pmg::runtime {

void HoistGate::take(io::Bytes bytes) {
  using pmg_msgs::hoist_t;
  const auto sealed = seal::decode_sealed<hoist_t, pmg_msgs::seal_t>(bytes);
  const hoist_t* message = sealed ? &sealed->message : nullptr;
  if (message == nullptr || !presentable(message->source) ||
      (message->request != hoist_t::LIFT && message->request != hoist_t::LOWER)) {
    ++counts_.malformed;
  } else if (message->version != hoist_t::VERSION) {
    ++counts_.other_version;
  } else if (message->robot != robot_) {
    ++counts_.other_robot;
  } else if (line_ == nullptr) {
    ++counts_.no_hoist;
  } else if (counts_.good(
                 seal_.judge("HOIST", sealed->message.source, sealed->message_bytes, sealed->seal, clock_.now_ns()))) {
    answer(*message);
  }
}

void HoistGate::answer(const pmg_msgs::hoist_t& message) {
  using Place = DatagramOrder::Place;
  const auto source = control::Source::make(message.source, message.session);
  const Place place = order_.take(source, Stream::kHoist, message.sequence, message.stamp_ns, clock_.now_ns());
  if (place == Place::kNoRoom) {
    ++counts_.flooded;
    return;
  }
  answer_ = true;
  if (place == Place::kOld) return;
  const bool ended = source.name == taken_.name && source.session < taken_.session;
  if (place == Place::kNew && !ended) {
    taken_ = source;
    line_->ask(message.request == pmg_msgs::hoist_t::LIFT);
  }
  answered_ = source;
  answered_sequence_ = message.sequence;
}

bool HoistGate::fill(pmg_msgs::hoist_state_t& message) {
  if (line_ == nullptr) return false;
  const auto state = static_cast<std::int8_t>(line_->state());
  const std::int8_t stays_up = line_->stays_up() ? 1 : 0;
  const bool news = answer_ || state != message.state || stays_up != message.stays_up;
  answer_ = false;
  message.robot = robot_;
  message.state = state;
  message.stays_up = stays_up;
  message.source = answered_.name.data();
  message.session = answered_.session;
  message.sequence = answered_sequence_;
  return news;
}

}  // namespace pmg::runtime
