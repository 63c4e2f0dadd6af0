#include "operator/climb.hpp"

#include <fmt/format.h>

#include <utility>

#include "operator/hoist_wish.hpp"
#include "operator/words.hpp"

namespace pmg::ops {

namespace {

constexpr double kHoistAnswer_s = 0.5;

}  // namespace

std::optional<pmg_msgs::hoist_state_t> carrying_hoist(const OperatorSource& source, const std::string& robot) {
  const HeardRobot* heard = source.heard(robot);
  const auto hoist = heard != nullptr ? heard->hoist.speaking(source.clock().now_ns()) : std::nullopt;
  return hoist && hoist->state != pmg_msgs::hoist_state_t::FREE ? hoist : std::nullopt;
}

Climb::Climb(OperatorSource& source, std::string robot, Goal to, double timeout_s)
    : source_(source), robot_(std::move(robot)), to_(to), timeout_s_(timeout_s) {
  enter(Part::kLooking);
}

double Climb::in_part_s() const { return static_cast<double>(source_.clock().now_ns() - part_since_ns_) * 1e-9; }

void Climb::enter(Part part) {
  part_ = part;
  part_since_ns_ = source_.clock().now_ns();
  wish_.reset();
  if (part == Part::kStanding) wish_.emplace(source_, robot_, Goal::kStand, timeout_s_);
  if (part == Part::kLast) wish_.emplace(source_, robot_, to_, timeout_s_);
}

Progress Climb::step() {
  if (part_ == Part::kLooking) {
    const HeardRobot* heard = source_.heard(robot_);
    const std::int64_t now_ns = source_.clock().now_ns();
    const std::int64_t since_ns = heard != nullptr ? heard->first_heard_ns : part_since_ns_;
    if (carrying_hoist(source_, robot_)) {
      enter(Part::kStanding);
    } else if ((heard != nullptr && heard->hoist.state) || now_ns - since_ns >= kLook_ns) {
      enter(Part::kLast);
    } else {
      return Progress::kPending;
    }
  }
  switch (part_) {
    case Part::kStanding:
    case Part::kLast:
      return follow_wish();
    case Part::kSetDown:
      return wait_for_ground();
    default:
      return Progress::kFailed;
  }
}

Progress Climb::follow_wish() {
  const Progress progress = wish_->step();
  text_ = wish_->answers().front().text;
  if (progress == Progress::kFailed) return fail(text_);
  if (progress == Progress::kPending || part_ == Part::kLast) return progress;
  enter(Part::kSetDown);
  return Progress::kPending;
}

Progress Climb::wait_for_ground() {
  const std::int8_t mode = *source_.heard(robot_)->mode();
  if (!is_upright(mode)) return fail(fmt::format("ended by another request or a fault: mode is {}", mode_name(mode)));
  const auto hoist = carrying_hoist(source_, robot_);
  if (!hoist) {
    if (to_ == Goal::kStand) return Progress::kReached;
    enter(Part::kLast);
    return Progress::kPending;
  }
  text_ = std::string("the hoist ") + hoist_words(hoist->state);
  // After standing up the robot no longer stays on the hoist; the hoist's next state says so.
  if (hoist->stays_up && in_part_s() > kHoistAnswer_s) return fail(text_ + " until it is set down");
  return in_part_s() < kSlowSimulation * timeout_s_ ? Progress::kPending : fail(text_ + " and doesn't end");
}

Progress Climb::fail(const std::string& text) {
  text_ = text;
  enter(Part::kFailed);
  return Progress::kFailed;
}

}  // namespace pmg::ops
