#include "vr/vr_command.hpp"

#include <algorithm>
#include <utility>

#include "arms_operator/arms_text.hpp"

namespace pmg::vr {

namespace {

constexpr std::array kPosture = {kPitch, kRoll, kHeight};
constexpr std::array kSides = {kLeft, kRight};

}  // namespace

void VrCommand::begin(std::int64_t now_ns) {
  end(now_ns);
  present_ = true;
  transit_ = {};
  seen_ = {};
  centre_.reset();
  head_.reset();
  scale_ = 1.0;
  leads_ = {};
  wishes_ = {};  // what the last one led stays
}

void VrCommand::end(std::int64_t now_ns) {
  lose("", now_ns);
  hold_.down = hold_.pressed = false;
  present_ = false;
}

void VrCommand::lose(const char* why, std::int64_t now_ns) {
  steady_ = false;
  asks_ = {};
  hold_.lost = true;
  loss_told_ = false;
  note_ = why;
  now_ns_ = now_ns;
  hold_palms();
}

void VrCommand::hold_palms() {
  for (const Foot side : kSides) {
    leads_[side].hold(now_ns_);
    wishes_[side] = leads_[side].wish();
  }
}

void VrCommand::take(const VrNews& news, std::int64_t now_ns) {
  if (!present_ || news.number <= seen_.number) return;
  seen_.number = news.number;
  const bool late = transit_.take(news.stamp_ns, now_ns) > ops::Device::kLate_ns;
  const bool pressed = seen_.presses >= 0 && news.presses > seen_.presses;
  seen_.presses = std::max(seen_.presses, news.presses);
  now_ns_ = now_ns;
  if (late) return take_late(news);
  const bool recentre = take_buttons(news);
  hold_.down = news.held;
  hold_.heard_ns = now_ns;
  take_head(news, recentre, now_ns);
  hold_.neutral = steady_ && asks_.neutral();
  hold_.pressed = (hold_.pressed || pressed) && steady_;
  take_hands(news, now_ns);
}

/// It tells of a moment that is over: only what ends something counts. Its silence ends the rest.
void VrCommand::take_late(const VrNews& news) {
  hold_.down = hold_.down && news.held;
  if (!news.shown || !news.head) return lose("the headset was lost", now_ns_);
  for (const Foot side : kSides) {
    if (news.hands[side].leads && news.hands[side].pose) continue;
    leads_[side].hold(now_ns_);
    wishes_[side] = leads_[side].wish();
  }
  note_ = "this headset's messages come late: it can't drive";
}

bool VrCommand::take_buttons(const VrNews& news) {
  const bool first = seen_.recentres < 0;
  const bool recentre = first || news.recentres > seen_.recentres;
  const bool span = !first && news.spans_shown > seen_.spans, straight = !first && news.uprights > seen_.uprights;
  seen_.recentres = std::max(seen_.recentres, news.recentres);
  seen_.spans = std::max(seen_.spans, news.spans_shown);
  seen_.uprights = std::max(seen_.uprights, news.uprights);
  if (straight && !driving_) upright();  // a squeezed grip would count it on top
  if (span) measure_span(news);
  return recentre;
}

void VrCommand::take_head(const VrNews& news, bool recentre, std::int64_t now_ns) {
  if (!news.shown) return lose("the page is behind the headset's own menu", now_ns);
  if (!news.head) return lose("the headset isn't tracked", now_ns);
  const double dt_s = static_cast<double>(now_ns - head_ns_) * 1e-9;
  const bool jumped = head_ && (news.head->p_m - head_->p_m).norm() > kHeadJump_m + kHeadFastest_m_s * dt_s;
  head_ = news.head;
  head_ns_ = now_ns;
  if (recentre || !centre_) centre_ = centre_of(*news.head);
  if (recentre) return lose("centred: squeeze a grip to drive", now_ns);
  if (jumped) return lose("the headset jumped: squeeze the grip anew", now_ns);
  const auto asks = centre_ ? head_asks(*centre_, *news.head) : std::nullopt;
  if (!asks) return lose("look straight ahead", now_ns);
  asks_ = *asks;
  steady_ = true;
  if (loss_told_) hold_.lost = false;  // a loss between two looks counts, too
  note_ = driving_ || asks_.neutral() ? "" : "go back to where you stood upright, or recentre; then squeeze a grip";
}

void VrCommand::take_hands(const VrNews& news, std::int64_t now_ns) {
  for (const Foot side : kSides) {
    const HandNews& hand = news.hands[side];
    std::optional<Pose> relative;
    if (steady_ && hand.pose)
      relative = Pose{.p_m = centre_->in_heading(Eigen::Vector3d(hand.pose->p_m - head_->p_m)),
                      .R = centre_->in_heading(hand.pose->R)};
    leads_[side].take(hand, relative, steady_ && driving_, robot_palms_[side], scale_, now_ns);
    wishes_[side] = leads_[side].wish();
    led_ = led_ || wishes_[side].wish != pmg_msgs::arms_t::HOLD;
  }
}

void VrCommand::measure_span(const VrNews& news) {
  const auto& left = news.hands[kLeft].pose;
  const auto& right = news.hands[kRight].pose;
  if (!left || !right || robot_span_m_ <= 0.0) return;
  const double span_m = (left->p_m - right->p_m).norm();
  if (span_m < kShortestSpan_m || span_m > kLongestSpan_m) return;
  hold_palms();  // another scale would make them jump
  scale_ = std::clamp(robot_span_m_ / span_m, kSmallestScale, kLargestScale);
}

void VrCommand::learn(const ops::HeardArms* arms) {
  for (const Foot side : kSides) {
    robot_palms_[side].reset();
    if (arms == nullptr) continue;
    const ops::ArmNews arm = ops::arm_news(arms->state, side);
    const Eigen::Quaterniond R(arm.orientation[0], arm.orientation[1], arm.orientation[2], arm.orientation[3]);
    const Eigen::Vector3d p_m(arm.p_m[0], arm.p_m[1], arm.p_m[2]);
    if (!p_m.allFinite() || !(std::abs(R.norm() - 1.0) < 0.01)) continue;
    robot_palms_[side] = PalmLead::Palm{.pose = {.p_m = p_m, .R = R.normalized()}, .heard_ns = arms->heard_ns};
  }
}

ops::DeviceManner VrCommand::manner() const {
  return {.name = "vr",
          .command_raises = false,
          .at_once = false,
          .raises = "Stand makes it stand up",
          .resets = "Reset resets it",
          .drives = "a squeezed grip and a step drive it",
          .starts = "Stand makes it stand up",
          .anew = "Let go of the grip, stand upright at the centre, and squeeze it anew"};
}

std::span<const ops::Hold> VrCommand::holds(std::int64_t /*now_ns*/) noexcept {
  shown_ = hold_;
  hold_.pressed = false;
  loss_told_ = true;
  return {&shown_, present_ ? 1U : 0U};
}

Command VrCommand::command(std::optional<std::int32_t> armed, std::int64_t now_ns) noexcept {
  const bool drives = present_ && armed == hold_.id;
  now_ns_ = now_ns;
  if (drives && !driving_) base_ = posture_;
  if (!drives && driving_) hold_palms();
  driving_ = drives;
  Command command;
  if (driving_ && steady_) {
    for (const Channel channel : {kVx, kVy, kOmega}) {
      const double share = asks_.share[channel];
      command[channel] = share * (share > 0.0 ? limits_.upper[channel] : -limits_.lower[channel]);
    }
    for (const Channel channel : kPosture) {
      const double share = asks_.share[channel];
      const double range = channel == kHeight ? 1.0 : share > 0.0 ? limits_.upper[channel] : -limits_.lower[channel];
      posture_[channel] = std::clamp(base_[channel] + share * range, limits_.lower[channel], limits_.upper[channel]);
    }
  }
  for (const Channel channel : kPosture) command[channel] = posture_[channel];
  return command;
}

void VrCommand::rest() noexcept {
  driving_ = false;
  hold_palms();
}

void VrCommand::upright() noexcept {
  posture_ = {};
  base_ = {};
}

}  // namespace pmg::vr
