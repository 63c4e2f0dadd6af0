#include "operator/hoist_wish.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "operator/nobody_answers.hpp"

namespace pmg::ops {

using State = pmg_msgs::hoist_state_t;

const char* hoist_words(std::int8_t state) noexcept {
  switch (state) {
    case State::FREE:
      return "let go of the robot";
    case State::CATCHING:
      return "catches the robot";
    case State::LIFTING:
      return "lifts the robot";
    case State::HOLDING:
      return "holds the robot";
    case State::LOWERING:
      return "sets the robot down";
    case State::LETTING_GO:
      return "lets go of the robot";
    default:
      return "does something unknown";
  }
}

HoistWish::HoistWish(OperatorSource& source, std::string robot, bool lift, double timeout_s)
    : source_(source),
      robot_(std::move(robot)),
      lift_(lift),
      timeout_s_(timeout_s),
      begin_ns_(source.clock().now_ns()),
      repeat_at_ns_(begin_ns_ + ModeWish::kRepeat_ns) {
  source_.request_hoist(robot_, lift_);
}

double HoistWish::elapsed_s() const { return static_cast<double>(source_.clock().now_ns() - begin_ns_) * 1e-9; }

Progress HoistWish::step() {
  const Progress progress = judge();
  if (progress != Progress::kPending) return progress;
  if (elapsed_s() >= timeout_s_) return Progress::kFailed;
  const HeardRobot* heard = source_.heard(robot_);
  const bool waits = heard == nullptr || !heard->hoist.state || !source_.hoist_answer(*heard->hoist.state);
  if (waits && source_.clock().now_ns() >= repeat_at_ns_) {
    repeat_at_ns_ = source_.clock().now_ns() + ModeWish::kRepeat_ns;
    source_.repeat_hoist();
  }
  return Progress::kPending;
}

Progress HoistWish::judge() {
  const HeardRobot* heard = source_.heard(robot_);
  if (heard == nullptr || !heard->status) {
    text_ = nobody_answers(source_);
    return Progress::kPending;
  }
  const std::int64_t silent_ns = source_.clock().now_ns() - std::max(heard->hoist.heard_ns, begin_ns_);
  if (!heard->hoist.state || silent_ns > HeardHoist::kSilent_ns) {
    text_ = "it has no hoist that could be worked: only a simulated robot has, and not with --gantry";
    return silent_ns > HeardHoist::kSilent_ns ? Progress::kFailed : Progress::kPending;
  }
  const State& hoist = *heard->hoist.state;
  text_ = std::string("the hoist ") + hoist_words(hoist.state);
  if (!source_.hoist_answer(hoist)) return Progress::kPending;
  if (hoist.stays_up != (lift_ ? 1 : 0)) {
    text_ += "; somebody else asked for the opposite";
    return Progress::kFailed;
  }
  if (hoist.state == (lift_ ? State::HOLDING : State::FREE)) return Progress::kReached;
  const std::int8_t mode = *heard->mode();
  const bool stands = mode == pmg_msgs::mode_t::STAND || mode == pmg_msgs::mode_t::WALK;
  if (!lift_ && !stands) {
    text_ += ", and sets it down when it stands";
    if (hoist.state == State::HOLDING) return Progress::kFailed;
  }
  return Progress::kPending;
}

}  // namespace pmg::ops
