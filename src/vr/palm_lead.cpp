#include "vr/palm_lead.hpp"

#include <algorithm>

namespace pmg::vr {

using Arms = pmg_msgs::arms_t;

void PalmLead::hold(std::int64_t now_ns) noexcept {
  if (start_) ended_ns_ = now_ns;
  start_.reset();
  pulled_ = false;
  if (wish_.wish == Arms::AIM) wish_.wish = Arms::HOLD;
}

bool PalmLead::jumped(const Pose& relative, std::int64_t now_ns) const noexcept {
  if (!before_) return false;
  const double dt_s = static_cast<double>(now_ns - before_ns_) * 1e-9;
  return (relative.p_m - before_->p_m).norm() > kJump_m + kFastest_m_s * dt_s ||
         relative.R.angularDistance(before_->R) > kTwist_rad + kFastest_rad_s * dt_s;
}

void PalmLead::take(const HandNews& hand, const std::optional<Pose>& relative, bool may_lead,
                    const std::optional<Palm>& palm, double scale, std::int64_t now_ns) noexcept {
  const bool pressed = presses_ >= 0 && hand.lead_presses > presses_;
  const bool handed_back = hand_backs_ >= 0 && hand.hand_backs > hand_backs_;
  presses_ = std::max(presses_, hand.lead_presses);
  hand_backs_ = std::max(hand_backs_, hand.hand_backs);
  const bool jump = relative && jumped(*relative, now_ns);
  before_ = relative;
  before_ns_ = now_ns;
  if (!may_lead || !relative || !hand.leads || jump) {
    hold(now_ns);
  } else if (pressed && !start_) {
    pulled_ = true;
  }
  if (handed_back && may_lead) {
    hold(now_ns);
    wish_.wish = Arms::HAND_BACK;
  }
  if (pulled_ && !start_ && palm && palm->heard_ns >= ended_ns_ + (ended_ns_ > 0 ? kSettle_ns : 0)) {
    start_ = Start{.hand = *relative, .palm = palm->pose};
    pulled_ = false;
  }
  if (!start_) return;
  const Eigen::Vector3d moved_m = relative->p_m - start_->hand.p_m;
  if (!(moved_m.norm() <= kFarthest_m)) return hold(now_ns);
  wish_ = {.wish = Arms::AIM,
           .p_m = start_->palm.p_m + scale * moved_m,
           .R = (relative->R * start_->hand.R.conjugate() * start_->palm.R).normalized()};
}

}  // namespace pmg::vr
