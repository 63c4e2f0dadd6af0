#include "runtime/hoist_gate.hpp"

#include "pmg_msgs/hoist_t.hpp"

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
    answer_ = true;
    if (overtaken(message->source, message->session, message->sequence)) return;
    source_ = message->source;
    session_ = message->session;
    sequence_ = message->sequence;
    line_->ask(message->request == hoist_t::LIFT);
  }
}

bool HoistGate::overtaken(const std::string& source, std::int64_t session, std::int64_t sequence) const {
  return source == source_ && (session < session_ || (session == session_ && sequence <= sequence_));
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
  message.source = source_;
  message.session = session_;
  message.sequence = sequence_;
  return news;
}

}  // namespace pmg::runtime
