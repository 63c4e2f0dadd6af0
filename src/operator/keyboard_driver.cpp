#include "operator/keyboard_driver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "operator/words.hpp"

namespace pmg::ops {

namespace {

using Modes = pmg_msgs::mode_t;

constexpr const char* kRises = "Enter makes it stand up";

}  // namespace

KeyboardDriver::KeyboardDriver(OperatorSource& source, std::string robot, KeyReport report)
    : source_(source), robot_(std::move(robot)), report_(report), keys_(report) {}

void KeyboardDriver::press(Key key, bool fast) {
  if (letting_go_ && key != Key::kDamp) return;
  keys_.press(key, fast, now_ns());
  switch (key) {
    case Key::kDamp:
      reset_.reset();
      stop_.emplace(source_, robot_, Goal::kStop, kTimeout_s);
      hold_back(std::string("stopped: ") + kRises);
      return;
    case Key::kStand:
      if (stop_) return;  // the stop must be answered before anything else
      keys_.rest();
      keys_.upright();
      held_back_ = false;
      reset_.reset();
      climb(Goal::kStand);
      return;
    case Key::kReset:
      if (stop_) return;
      hold_back("asks for a reset");
      reset_.emplace(source_, robot_, Goal::kReset, kTimeout_s);
      return;
    case Key::kLift:
    case Key::kSetDown:
      keys_.rest();
      hoist_.emplace(source_, robot_, key == Key::kLift, kTimeout_s);
      return;
    default:
      return;
  }
}

void KeyboardDriver::let_go() {
  if (letting_go_) return;
  letting_go_ = true;
  letting_go_since_ns_ = now_ns();
  keys_.rest();
  if (doing_ == Doing::kClimbing || doing_ == Doing::kIdle) {
    gone_ = !stop_;
    if (doing_ == Doing::kClimbing) idle("");
  }
}

void KeyboardDriver::step() {
  asked_ = keys_.command(now_ns());
  watch_mode();
  follow_errands();
  follow_keys();
  if (doing_ == Doing::kClimbing) {
    send_if_due();  // the command must arrive before the request for Walk
    follow_climb();
  }
  if (doing_ != Doing::kIdle && doing_ != Doing::kClimbing) follow_drive();
  send_if_due();
  const bool ended = doing_ == Doing::kIdle && !stop_;
  if (letting_go_ && (ended || now_ns() - letting_go_since_ns_ > kLetGo_ns)) {
    if (doing_ != Doing::kIdle) idle("");
    gone_ = true;
  }
}

void KeyboardDriver::enter(Doing doing) {
  doing_ = doing;
  doing_since_ns_ = now_ns();
  if (doing != Doing::kIdle) send_at_ns_ = std::min(send_at_ns_, now_ns());
  if (doing != Doing::kClimbing) climb_.reset();
  if (doing != Doing::kDescending) descent_.reset();
}

void KeyboardDriver::climb(Goal to) {
  seen_presses_ = keys_.presses();
  enter(Doing::kClimbing);
  climb_.emplace(source_, robot_, to, kTimeout_s);
}

void KeyboardDriver::idle(const std::string& text) {
  const bool drove = doing_ != Doing::kIdle;
  enter(Doing::kIdle);
  if (drove) source_.send_command(robot_, Command{}, kLastLease_s);  // so that the next source need not wait
  seen_presses_ = keys_.presses();
  text_ = text;
}

void KeyboardDriver::hold_back(const std::string& text) {
  keys_.rest();
  keys_.upright();
  held_back_ = true;
  idle(text);
}

void KeyboardDriver::watch_mode() {
  const HeardRobot* heard = source_.heard(robot_);
  if (heard == nullptr || !heard->status) return;
  const std::int8_t before = mode_.value_or(Modes::PASSIVE);
  const bool first = !mode_, restarted = mode_ && session_ != heard->status->session;
  mode_ = heard->mode();
  session_ = heard->status->session;
  const bool fell = is_upright(before) && !is_upright(*mode_);
  const bool low = *mode_ == Modes::DAMPING || *mode_ == Modes::FAULT;
  if (held_back_ || is_upright(*mode_)) return;
  if (*mode_ == Modes::FAULT) {
    hold_back("fault: " + heard->status->fault + "; R resets it, then " + kRises);
  } else if (restarted) {
    hold_back(std::string("its controller was started anew: ") + kRises);
  } else if (fell || (first && low)) {
    hold_back(fmt::format("somebody stopped it, mode is {}: {}", mode_name(*mode_), kRises));
  }
}

void KeyboardDriver::follow_errands() {
  if (stop_) {
    const Progress progress = stop_->step();
    if (progress == Progress::kFailed) text_ = "THE STOP IS NOT ANSWERED: " + stop_->answers().front().text;
    if (progress != Progress::kPending) stop_.reset();
  }
  if (reset_) {
    const Progress progress = reset_->step();
    if (progress == Progress::kReached) text_ = std::string("reset: ") + kRises;
    if (progress == Progress::kFailed) text_ = reset_->answers().front().text;
    if (progress != Progress::kPending) reset_.reset();
  }
  if (hoist_) {
    const Progress progress = hoist_->step();
    if (doing_ == Doing::kIdle) text_ = hoist_->text();
    if (progress == Progress::kReached && doing_ == Doing::kIdle) text_.clear();
    if (progress != Progress::kPending) hoist_.reset();
  }
}

void KeyboardDriver::follow_keys() {
  const bool fresh = keys_.presses() != seen_presses_;
  if (!fresh || letting_go_) return;
  if (!limits_known_ && keys_.held()) return;
  if (doing_ == Doing::kDriving) {
    seen_presses_ = keys_.presses();
  } else if (held_back_ || !wants_to_move()) {
    seen_presses_ = keys_.presses();  // earlier presses have no later effect
    if (!held_back_) return;
    keys_.rest();
    keys_.upright();
  } else if (doing_ == Doing::kCalming) {
    enter(Doing::kDriving);
  } else if (doing_ != Doing::kClimbing) {
    climb(Goal::kWalk);
  }
}

void KeyboardDriver::follow_climb() {
  const Progress progress = climb_->step();
  text_ = climb_->text();
  if (progress == Progress::kFailed) return idle(text_.empty() ? "no answer" : text_);
  if (progress == Progress::kPending) return;
  seen_presses_ = keys_.presses();
  if (source_.heard(robot_)->mode() == Modes::WALK) {
    enter(Doing::kDriving);
  } else {
    idle("");
  }
}

void KeyboardDriver::follow_drive() {
  if (doing_ == Doing::kDescending) {
    const Progress progress = descent_->step();
    if (progress == Progress::kReached) return idle("");
    if (progress == Progress::kFailed) return idle(descent_->answers().front().text);
  } else if (const std::string why = trouble(); !why.empty()) {
    keys_.rest();
    return idle(why);
  }
  const bool wanted = wants_to_move() || (report_ == KeyReport::kPressOnly && !letting_go_);
  const bool rests = letting_go_ ? !moves() : !wanted;
  if (doing_ == Doing::kDriving) {
    text_ = moves() ? "" : bent() ? "velocity is zero; the posture is held" : "velocity is zero";
    if (rests) enter(Doing::kCalming);
  } else if (doing_ == Doing::kCalming) {
    text_ = "velocity goes to zero";
    if (!rests) {
      enter(Doing::kDriving);
    } else if (in_doing_ns() >= kCalm_ns) {
      enter(Doing::kDescending);
      descent_.emplace(source_, robot_, Goal::kStand, kTimeout_s);
    }
  }
}

std::string KeyboardDriver::trouble() const {
  const HeardRobot* heard = source_.heard(robot_);
  if (now_ns() - heard->status_heard_ns > kSilent_ns) return "its controller is no longer heard";
  if (in_doing_ns() < kSettle_ns) return "";
  const pmg_msgs::status_t& status = *heard->status;
  if (status.driving_source != source_.name()) {
    return status.driving_source.empty() ? "its commands are not taken: pmg_watch shows by what count"
                                         : "another source drives: " + status.driving_source;
  }
  if (status.mode != Modes::WALK) return "it came to rest by itself: commands came late. Press a key anew";
  return "";
}

bool KeyboardDriver::moves() const noexcept {
  return asked_[kVx] != 0.0 || asked_[kVy] != 0.0 || asked_[kOmega] != 0.0;
}

bool KeyboardDriver::bent() const noexcept {
  return asked_[kPitch] != 0.0 || asked_[kRoll] != 0.0 || asked_[kHeight] != 0.0;
}

void KeyboardDriver::send_if_due() {
  if (doing_ == Doing::kIdle || source_.heard(robot_) == nullptr) return;  // unheard: no command would be fresh
  Command command;
  if (doing_ == Doing::kDriving || doing_ == Doing::kCalming) command = asked_;
  if (now_ns() < send_at_ns_ && command == sent_) return;
  sent_ = command;
  send_at_ns_ = now_ns() + kPeriod_ns;
  source_.send_command(robot_, command, kLease_s);
}

std::string KeyboardDriver::text() const { return doing_ == Doing::kIdle && text_.empty() ? idle_text() : text_; }

std::string KeyboardDriver::idle_text() const {
  if (!mode_) return fmt::format("no controller of this name is heard on {}", source_.url());
  const HeardRobot* heard = source_.heard(robot_);
  if (now_ns() - heard->status_heard_ns > kSilent_ns) return "its controller is no longer heard";
  const std::string& other = heard->status->driving_source;
  if (!other.empty() && other != source_.name()) return "another source drives: " + other;
  if (held_back_) return kRises;
  return *mode_ == Modes::STAND ? "stands; a key drives it" : "a key makes it stand up and walk";
}

}  // namespace pmg::ops
