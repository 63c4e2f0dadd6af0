#include "arms_operator/arms_board.hpp"

#include <utility>

namespace pmg::ops {

ArmsBoard::ArmsBoard(io::LcmLink& link, const io::Clock& clock, seal::OperatorSeal seal)
    : clock_(clock), seal_(std::move(seal)) {
  link.subscribe("ARMS_STATE", [this](io::Bytes message) { hear(message); });
}

const HeardArms* ArmsBoard::of(const std::string& robot) const {
  const auto found = robots_.find(robot);
  const bool known = found != robots_.end() && clock_.now_ns() - found->second.heard_ns <= kSilent_ns;
  return known ? &found->second : nullptr;
}

void ArmsBoard::hear(io::Bytes bytes) {
  const auto heard = seal::decode_sealed<pmg_msgs::arms_state_t, pmg_msgs::proof_t>(bytes);
  if (!heard || !seal_.believe("ARMS_STATE", heard->message_bytes, heard->seal, clock_.now_ns())) return;
  const std::string& robot = heard->message.robot;
  if (robots_.size() >= kMostRobots && !robots_.contains(robot)) return;
  robots_[robot] = {.state = heard->message, .heard_ns = clock_.now_ns()};
}

}  // namespace pmg::ops
