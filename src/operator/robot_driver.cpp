#include "operator/robot_driver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "operator/words.hpp"

namespace pmg::ops {

namespace {

using Modes = pmg_msgs::mode_t;

}  // namespace

RobotDriver::RobotDriver(OperatorSource& source, std::string robot, CommandInput& input, DriverManner manner)
    : source_(source), robot_(std::move(robot)), input_(input), manner_(std::move(manner)) {}

void RobotDriver::stop() {
  errand_.reset();
  stop_.emplace(source_, robot_, Goal::kStop, kTimeout_s);
  hold_back("stopped: " + manner_.raises);
}

void RobotDriver::stand() {
  if (stop_ || letting_go_) return;  // the stop must be answered before anything else
  input_.rest();
  input_.upright();
  held_back_ = false;
  errand_.reset();
  climb(Goal::kStand);
}

void RobotDriver::reset() {
  if (stop_ || letting_go_) return;
  hold_back("asks for a reset");
  errand_.emplace(source_, robot_, Goal::kReset, kTimeout_s);
  errand_done_ = "reset: " + manner_.raises;
}

void RobotDriver::limp() {
  if (stop_ || letting_go_) return;
  hold_back("asks it to go limp");
  errand_.emplace(source_, robot_, Goal::kPassive, kTimeout_s);
  errand_done_ = "limp: " + manner_.raises;
}

void RobotDriver::hoist(bool lift) {
  if (letting_go_) return;
  input_.rest();
  hoist_.emplace(source_, robot_, lift, kTimeout_s);
}

void RobotDriver::let_go() {
  if (letting_go_) return;
  letting_go_ = true;
  letting_go_since_ns_ = now_ns();
  input_.rest();
  if (doing_ == Doing::kClimbing || doing_ == Doing::kIdle) {
    gone_ = !stop_;
    if (doing_ == Doing::kClimbing) idle("");
  }
}

void RobotDriver::step() {
  asked_ = input_.command(now_ns());
  watch_mode();
  follow_errands();
  follow_input();
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

void RobotDriver::enter(Doing doing) {
  doing_ = doing;
  doing_since_ns_ = now_ns();
  if (doing != Doing::kIdle) send_at_ns_ = std::min(send_at_ns_, now_ns());
  if (doing != Doing::kClimbing) climb_.reset();
  if (doing != Doing::kDescending) descent_.reset();
}

void RobotDriver::climb(Goal to) {
  seen_presses_ = input_.presses();
  enter(Doing::kClimbing);
  climb_.emplace(source_, robot_, to, kTimeout_s);
}

void RobotDriver::idle(const std::string& text) {
  const bool drove = doing_ != Doing::kIdle;
  enter(Doing::kIdle);
  if (drove) source_.send_command(robot_, Command{}, kLastLease_s);  // so that the next source need not wait
  seen_presses_ = input_.presses();
  text_ = text;
}

void RobotDriver::hold_back(const std::string& text) {
  input_.rest();
  input_.upright();
  held_back_ = true;
  idle(text);
}

void RobotDriver::watch_mode() {
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
    hold_back("fault: " + heard->status->fault + "; " + manner_.resets + ", then " + manner_.raises);
  } else if (restarted) {
    hold_back("its controller was started anew: " + manner_.raises);
  } else if (fell || (first && low)) {
    hold_back(fmt::format("somebody stopped it, mode is {}: {}", mode_name(*mode_), manner_.raises));
  }
}

void RobotDriver::follow_errands() {
  if (stop_) {
    const Progress progress = stop_->step();
    if (progress == Progress::kFailed) text_ = "THE STOP IS NOT ANSWERED: " + stop_->answers().front().text;
    if (progress != Progress::kPending) stop_.reset();
  }
  if (errand_) {
    const Progress progress = errand_->step();
    if (progress == Progress::kReached) text_ = errand_done_;
    if (progress == Progress::kFailed) text_ = errand_->answers().front().text;
    if (progress != Progress::kPending) errand_.reset();
  }
  if (hoist_) {
    const Progress progress = hoist_->step();
    if (doing_ == Doing::kIdle) text_ = hoist_->text();
    if (progress == Progress::kReached && doing_ == Doing::kIdle) text_.clear();
    if (progress != Progress::kPending) hoist_.reset();
  }
}

void RobotDriver::follow_input() {
  const bool fresh = input_.presses() != seen_presses_;
  if (!fresh || letting_go_) return;
  if (!limits_known_ && input_.held()) return;
  if (doing_ == Doing::kDriving) {
    seen_presses_ = input_.presses();
  } else if (held_back_ || !wants_to_move()) {
    seen_presses_ = input_.presses();  // earlier presses have no later effect
    if (!held_back_) return;
    input_.rest();
    input_.upright();
  } else if (doing_ == Doing::kCalming) {
    enter(Doing::kDriving);
  } else if (doing_ == Doing::kClimbing) {
    return;
  } else if (manner_.command_raises || (mode_ && is_upright(*mode_))) {
    climb(Goal::kWalk);
  } else {
    seen_presses_ = input_.presses();
    input_.rest();
    input_.upright();
  }
}

void RobotDriver::follow_climb() {
  const Progress progress = climb_->step();
  text_ = climb_->text();
  if (progress == Progress::kFailed) return idle(text_.empty() ? "no answer" : text_);
  if (progress == Progress::kPending) return;
  seen_presses_ = input_.presses();
  if (source_.heard(robot_)->mode() == Modes::WALK) {
    enter(Doing::kDriving);
  } else {
    idle("");
  }
}

void RobotDriver::follow_drive() {
  if (doing_ == Doing::kDescending) {
    const Progress progress = descent_->step();
    if (progress == Progress::kReached) return idle("");
    if (progress == Progress::kFailed) return idle(descent_->answers().front().text);
  } else if (const std::string why = trouble(); !why.empty()) {
    input_.rest();
    return idle(why);
  }
  const bool wanted = wants_to_move() || (input_.stays() && !letting_go_);
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

std::string RobotDriver::trouble() const {
  if (silent()) return "its controller is no longer heard";
  if (in_doing_ns() < kSettle_ns) return "";
  const HeardRobot* heard = source_.heard(robot_);
  const pmg_msgs::status_t& status = *heard->status;
  if (status.driving_source != source_.name()) {
    return status.driving_source.empty() ? "its commands are not taken: pmg_watch shows by what count"
                                         : "another source drives: " + status.driving_source;
  }
  if (status.mode != Modes::WALK) return "it came to rest by itself: commands came late. " + manner_.anew;
  return "";
}

bool RobotDriver::silent() const {
  const HeardRobot* heard = source_.heard(robot_);
  return heard == nullptr || now_ns() - heard->status_heard_ns > kSilent_ns;
}

bool RobotDriver::moves() const noexcept { return asked_[kVx] != 0.0 || asked_[kVy] != 0.0 || asked_[kOmega] != 0.0; }

bool RobotDriver::bent() const noexcept {
  return asked_[kPitch] != 0.0 || asked_[kRoll] != 0.0 || asked_[kHeight] != 0.0;
}

void RobotDriver::send_if_due() {
  if (doing_ == Doing::kIdle || source_.heard(robot_) == nullptr) return;  // unheard: no command would be fresh
  Command command;
  if (doing_ == Doing::kDriving || doing_ == Doing::kCalming) command = asked_;
  const bool due = now_ns() >= send_at_ns_;
  if (!due && (!manner_.at_once || command == sent_)) return;
  sent_ = command;
  // On a grid of times, so that a fixed rate is kept; after a pause the grid begins anew and nothing is made up for.
  const bool paused = now_ns() - send_at_ns_ >= kPeriod_ns;
  send_at_ns_ = (due && !paused ? send_at_ns_ : now_ns()) + kPeriod_ns;
  source_.send_command(robot_, command, kLease_s);
}

std::string RobotDriver::text() const { return doing_ == Doing::kIdle && text_.empty() ? idle_text() : text_; }

std::string RobotDriver::idle_text() const {
  if (!mode_) return fmt::format("no controller of this name is heard on {}", source_.url());
  if (silent()) return "its controller is no longer heard";
  const std::string& other = source_.heard(robot_)->status->driving_source;
  if (!other.empty() && other != source_.name()) return "another source drives: " + other;
  if (held_back_) return manner_.raises;
  return is_upright(*mode_) ? "stands; " + manner_.drives : manner_.starts;
}

}  // namespace pmg::ops
