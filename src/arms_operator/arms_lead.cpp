#include "arms_operator/arms_lead.hpp"

#include <fmt/format.h>

#include <utility>

#include "arms_operator/arms_text.hpp"

namespace pmg::ops {

ArmsLead::ArmsLead(const io::Clock& clock, const ArmsBoard& board, std::string robot, const PerFoot<PalmGoal>& goals)
    : clock_(clock), board_(board), robot_(std::move(robot)), goals_(goals) {}

bool ArmsLead::take_goals() {
  const HeardArms* heard = board_.of(robot_);
  if (heard == nullptr) return false;
  wishes_.emplace();
  for (const Foot side : {kLeft, kRight}) {
    const double* R = arm_news(heard->state, side).orientation;
    const PalmGoal& goal = goals_[side];
    (*wishes_)[side] = {.wish = goal.wish,
                        .p_m = goal.p_m,
                        .R = goal.R.value_or(Eigen::Quaterniond(R[0], R[1], R[2], R[3]).normalized())};
  }
  return true;
}

void ArmsLead::step() {
  const std::int64_t now_ns = clock_.now_ns();
  if (!begin_ns_) begin_ns_ = now_ns;
  if (!wishes_ && !take_goals() && now_ns - *begin_ns_ > kHear_ns)
    trouble_ = "it says nothing of arms: the robot has none that can be led";
}

bool ArmsLead::reached() const {
  const HeardArms* heard = board_.of(robot_);
  if (heard == nullptr || !wishes_) return false;
  for (const Foot side : {kLeft, kRight}) {
    const ArmNews arm = arm_news(heard->state, side);
    if (goals_[side].wish == pmg_msgs::arms_t::AIM && !arm.reached) return false;
    const bool back = arm.activity == pmg_msgs::arms_state_t::REFERENCE;
    if (goals_[side].wish == pmg_msgs::arms_t::HAND_BACK && !back) return false;
  }
  return true;
}

std::string ArmsLead::text() const {
  const HeardArms* heard = board_.of(robot_);
  if (heard == nullptr) return "nothing is heard of its arms";
  std::string text;
  for (const Foot side : {kLeft, kRight}) {
    if (goals_[side].wish == pmg_msgs::arms_t::HOLD) continue;
    text += fmt::format("{}{} arm: {}", text.empty() ? "" : "; ", side == kLeft ? "left" : "right",
                        arm_text(arm_news(heard->state, side)));
  }
  return text;
}

}  // namespace pmg::ops
