#include "operator/robot_driver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "operator/keyboard_text.hpp"
#include "operator/nobody_answers.hpp"
#include "operator/way_up.hpp"
#include "operator/words.hpp"

namespace pmg::ops {

namespace {

using Modes = pmg_msgs::mode_t;

}  // namespace

RobotDriver::RobotDriver(OperatorSource& source, std::string robot, Device& device)
    : source_(source), robot_(std::move(robot)), device_(device), manner_(device.manner()), arms_(source) {}

void RobotDriver::stop() {
  errand_.reset();
  stop_.emplace(source_, robot_, Goal::kStop, manner_.timeout_s);
  hold_back("stopped");
}

void RobotDriver::heed() {
  const Requests requests = device_.take_requests();
  if (requests.stop) {
    stop();
  } else if (requests.other) {
    act(*requests.other);
  }
}

void RobotDriver::act(Request request) {
  if (letting_go_) return;
  if (request == Request::kLift || request == Request::kSetDown) return hoist(request == Request::kLift);
  if (stop_) return;  // the stop must be answered before anything else
  switch (request) {
    case Request::kStand:
      rest();
      device_.upright();
      return rise(Goal::kStand);
    case Request::kWalk:
      return rise(Goal::kWalk);
    case Request::kClaim:
      claim_since_ns_ = now_ns();
      return enter(Doing::kClaiming);
    case Request::kReset:
      return reset();
    default:
      return limp();
  }
}

void RobotDriver::rise(Goal to) {
  held_back_ = false;
  errand_.reset();
  climb(to);
}

void RobotDriver::reset() {
  hold_back("asks for a reset");
  errand_.emplace(source_, robot_, Goal::kReset, manner_.timeout_s);
  errand_done_ = "reset";
}

void RobotDriver::limp() {
  hold_back("asks it to go limp");
  errand_.emplace(source_, robot_, Goal::kPassive, manner_.timeout_s);
  errand_done_ = "limp";
}

void RobotDriver::hoist(bool lift) {
  rest();
  hoist_.emplace(source_, robot_, lift, manner_.timeout_s);
}

void RobotDriver::let_go() {
  if (letting_go_) return;
  letting_go_ = true;
  letting_go_since_ns_ = now_ns();
  rest();
  asked_[kVx] = asked_[kVy] = asked_[kOmega] = 0.0;
  if (doing_ == Doing::kClimbing && mode_ && is_upright(*mode_)) return descend();  // it may be asked for Walk already
  if (doing_ == Doing::kClimbing || doing_ == Doing::kClaiming) idle("");
  gone_ = doing_ == Doing::kIdle && !stop_;
}

void RobotDriver::step(const RobotNews* news) {
  hear(news);
  watch_mode();
  heed();
  follow_errands();
  follow_device();
  if (doing_ == Doing::kClimbing || doing_ == Doing::kClaiming) {
    send_if_due();  // the command must arrive before the request for Walk
    if (doing_ == Doing::kClimbing) {
      follow_climb();
    } else {
      follow_claim();
    }
  }
  if (doing_ == Doing::kDriving || doing_ == Doing::kCalming || doing_ == Doing::kDescending) follow_drive();
  send_if_due();
  const bool ended = doing_ == Doing::kIdle && !stop_;
  if (letting_go_ && (ended || now_ns() - letting_go_since_ns_ > kLetGo_ns)) {
    if (doing_ != Doing::kIdle) idle("it was let go of before it stood");
    gone_ = true;
  }
}

void RobotDriver::hear(const RobotNews* news) {
  news_ = news;
  if (news == nullptr || !news->info || limits_session_ == news->info->session) return;
  if (const auto limits = command_limits(*news->info)) {
    device_.set_limits(*limits);
    limits_session_ = news->info->session;
  }
}

void RobotDriver::enter(Doing doing) {
  if (doing_ == Doing::kDriving) note_limits(true);
  doing_ = doing;
  doing_since_ns_ = now_ns();
  if (doing != Doing::kIdle) send_at_ns_ = std::min(send_at_ns_, now_ns());
  if (doing != Doing::kClimbing) climb_.reset();
  if (doing != Doing::kDescending) descent_.reset();
  if (doing == Doing::kClimbing || doing == Doing::kClaiming) climbed_ = doing == Doing::kClimbing;
}

void RobotDriver::climb(Goal to) {
  enter(Doing::kClimbing);
  climb_.emplace(source_, robot_, to, manner_.timeout_s);
}

void RobotDriver::descend() {
  enter(Doing::kDescending);
  descent_.emplace(source_, robot_, Goal::kStand, manner_.timeout_s);
}

void RobotDriver::idle(const std::string& text, bool needs_way) {
  const bool drove = doing_ != Doing::kIdle && source_.heard(robot_) != nullptr;
  enter(Doing::kIdle);
  if (drove) source_.send_command(robot_, Command{}, kLastLease_s);  // so that the next source need not wait
  text_ = text;
  needs_way_ = needs_way;
}

void RobotDriver::rest() {
  hold_.disarm();
  device_.rest();
}

void RobotDriver::hold_back(const std::string& text) {
  rest();
  device_.upright();
  held_back_ = true;
  idle(text, true);
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
    hold_back("fault: " + heard->status->fault);
  } else if (restarted) {
    hold_back("its controller was started anew");
  } else if (fell || (first && low)) {
    hold_back(fmt::format("somebody stopped it, mode is {}", mode_name(*mode_)));
  }
}

void RobotDriver::follow_errands() {
  if (stop_) {
    const Progress progress = stop_->step();
    if (progress == Progress::kFailed) {
      text_ = "THE STOP IS NOT ANSWERED: " + stop_->answers().front().text;
      needs_way_ = false;
    }
    if (progress != Progress::kPending) stop_.reset();
  }
  if (errand_ && silent()) {
    errand_.reset();  // nor must one for limp drives
    text_ = silence_words();
    needs_way_ = false;
  }
  if (errand_) {
    const Progress progress = errand_->step();
    if (progress != Progress::kPending) {
      text_ = progress == Progress::kReached ? errand_done_ : errand_->answers().front().text;
      needs_way_ = listened();
      errand_.reset();
    }
  }
  if (hoist_) {
    const Progress progress = hoist_->step();
    if (doing_ == Doing::kIdle) text_ = hoist_->text();
    if (progress == Progress::kReached && doing_ == Doing::kIdle) text_.clear();
    needs_way_ = progress == Progress::kFailed;
    if (progress != Progress::kPending) hoist_.reset();
  }
}

void RobotDriver::follow_device() {
  if (letting_go_) return;
  const bool armed_before = hold_.armed().has_value();
  hold_.step(device_.holds(now_ns()), now_ns());
  if (armed_before && !hold_.armed()) device_.rest();
  asked_ = device_.command(hold_.armed(), now_ns());
  if (!hold_.armed()) asked_[kVx] = asked_[kVy] = asked_[kOmega] = 0.0;
  const bool begins = wants_to_move() && (!wanted_before_ || hold_.pressed());
  wanted_before_ = wants_to_move();
  if (held_back_ && (begins || hold_.pressed())) {
    rest();  // what is pressed before the robot is raised has no later effect
    device_.upright();
    asked_ = Command{};
    wanted_before_ = false;
  }
  const bool free = doing_ == Doing::kIdle || doing_ == Doing::kDescending;
  if (held_back_ || !begins || !free) return;
  if (mode_ && !silent() && (manner_.command_raises || is_upright(*mode_))) return climb(Goal::kWalk);
  rest();
  device_.upright();
}

void RobotDriver::follow_climb() {
  // A request that an absent controller would find when it is back, seconds later, must not move it.
  if (silent()) {
    rest();
    return idle(silence_words());
  }
  const Progress progress = climb_->step();
  text_ = climb_->text();
  if (progress == Progress::kFailed) return idle(text_.empty() ? "no answer" : text_, listened());
  if (progress == Progress::kPending) return;
  if (source_.heard(robot_)->mode() == Modes::WALK) {
    enter(Doing::kDriving);
  } else {
    idle("");
  }
}

void RobotDriver::follow_claim() {
  const HeardRobot* heard = source_.heard(robot_);
  if (heard != nullptr && heard->status && source_.drives(*heard->status)) return enter(Doing::kDriving);
  if (!waits_for().empty() && static_cast<double>(now_ns() - claim_since_ns_) * 1e-9 < manner_.timeout_s) {
    doing_since_ns_ = now_ns();  // after the end of that lease the controller has kSettle_ns to show this source
    return;
  }
  if (const std::string why = trouble(); !why.empty()) idle(why);
}

void RobotDriver::follow_drive() {
  if (doing_ == Doing::kDescending) {
    if (silent()) return idle(silence_words());
    const Progress progress = descent_->step();
    if (progress == Progress::kReached) return idle("");
    if (progress == Progress::kFailed) return idle(descent_->answers().front().text);
    return;
  }
  if (const std::string why = trouble(); !why.empty()) {
    rest();
    return idle(why);
  }
  const bool rests = letting_go_ ? !moves() : !wants_to_move() && !hold_.armed();
  if (doing_ == Doing::kDriving) {
    note_limits(false);
    text_ = moves() ? "" : bent() ? "velocity is zero; the posture is held" : "velocity is zero";
    if (rests) enter(Doing::kCalming);
    return;
  }
  text_ = "velocity goes to zero";
  if (!rests) {
    enter(Doing::kDriving);
  } else if (in_doing_ns() >= kCalm_ns) {
    if (climbed_) return descend();
    idle("");
  }
}

void RobotDriver::note_limits(bool last) {
  if (!taken_ || news_ == nullptr) return;
  const std::string text = taken_->step(*news_, now_ns(), last);
  if (!text.empty()) limited_ = text;
}

std::string RobotDriver::waits_for() const {
  if (doing_ == Doing::kClimbing) return climb_->waits_for();
  const HeardRobot* heard = doing_ == Doing::kClaiming ? source_.heard(robot_) : nullptr;
  return heard == nullptr ? "" : source_.silent_driver(*heard);
}

std::string RobotDriver::trouble() const {
  if (silent()) return silence_words();
  if (in_doing_ns() < kSettle_ns) return "";
  const HeardRobot* heard = source_.heard(robot_);
  const pmg_msgs::status_t& status = *heard->status;
  if (!source_.drives(status)) {
    if (status.driving_source.empty() && heard->lacks_key()) return kNoKey;
    return status.driving_source.empty() ? "its commands are not taken: pmg_watch shows by what count"
                                         : "another source drives: " + status.driving_source;
  }
  if (status.mode == Modes::WALK) return "";
  if (status.mode == Modes::FAULT) return "fault: " + status.fault;
  if (status.hanging) return kHangs;
  if (status.footing_unknown) return kFootingUnknown;
  if (!climbed_) return fmt::format("mode is {}: commands move a robot in walk only", mode_name(status.mode));
  return "it came to rest by itself: commands came late. " + manner_.anew;
}

bool RobotDriver::silent() const {
  const HeardRobot* heard = source_.heard(robot_);
  const bool simulated = news_ != nullptr && news_->info && news_->info->backend == "sil";
  return heard == nullptr || now_ns() - heard->status_heard_ns > (simulated ? kSimulationSilent_ns : kSilent_ns);
}

std::string RobotDriver::silence_words() const {
  if (mode_) return "the controller is no longer heard";
  return nobody_answers(source_);
}

bool RobotDriver::moves() const noexcept { return asked_[kVx] != 0.0 || asked_[kVy] != 0.0 || asked_[kOmega] != 0.0; }

bool RobotDriver::bent() const noexcept {
  return asked_[kPitch] != 0.0 || asked_[kRoll] != 0.0 || asked_[kHeight] != 0.0;
}

void RobotDriver::send_if_due() {
  if (doing_ == Doing::kIdle || source_.heard(robot_) == nullptr) return;  // unheard: no command would be fresh
  Command command;
  const bool drives = doing_ == Doing::kDriving || doing_ == Doing::kCalming;
  if (drives) command = manner_.holds_heading ? heading_.held(asked_, news_, now_ns()) : asked_;
  const bool due = now_ns() >= send_at_ns_;
  if (!due && (!manner_.at_once || command == sent_)) return;
  if (doing_ == Doing::kDriving && (!taken_ || command != sent_)) {
    taken_.emplace(command);
    limited_.clear();
  }
  sent_ = command;
  // On a grid of times, so that a fixed rate is kept; after a pause the grid begins anew and nothing is made up for.
  const bool paused = now_ns() - send_at_ns_ >= kPeriod_ns;
  send_at_ns_ = (due && !paused ? send_at_ns_ : now_ns()) + kPeriod_ns;
  source_.send_command(robot_, command, kLease_s);
  const PerFoot<PalmWish>* palms = device_.palms();
  if (doing_ == Doing::kDriving && hold_.armed() && palms != nullptr) arms_.send(robot_, *palms, kArmsLease_s);
}

std::string RobotDriver::text() const { return doing_ == Doing::kIdle && text_.empty() ? idle_text() : whole_text(); }

bool RobotDriver::listened() const {
  const HeardRobot* heard = source_.heard(robot_);
  if (heard == nullptr || !heard->ack) return false;
  return heard->ack->verdict == pmg_msgs::ack_t::TAKEN || heard->ack->verdict == pmg_msgs::ack_t::TILTED;
}

std::string RobotDriver::whole_text() const {
  if (doing_ != Doing::kIdle || text_.empty() || !needs_way_ || errand_ || hoist_ || silent()) return text_;
  const std::string way = this->way();
  return way.empty() ? text_ : text_ + ": " + way;
}

std::string RobotDriver::way() const {
  const HeardRobot* heard = source_.heard(robot_);
  if (heard == nullptr || !heard->status) return "";
  const std::string way = way_up(posture(*heard, news_, now_ns()), manner_);
  return way.empty() && held_back_ ? manner_.raises : way;
}

std::string RobotDriver::idle_text() const {
  if (silent()) return silence_words();
  const pmg_msgs::status_t& status = *source_.heard(robot_)->status;
  if (!status.driving_source.empty() && !source_.drives(status)) {
    return "another source drives: " + status.driving_source;
  }
  const Posture now = posture(*source_.heard(robot_), news_, now_ns());
  const std::vector<Step> steps = steps_up(now);
  if (held_back_ && steps.empty()) return manner_.raises;
  if (steps.empty()) return "stands; " + manner_.drives;
  const bool one = steps.size() == 1 && steps.front() == Step::kStand;
  return one && !held_back_ ? manner_.starts : way_up(now, manner_);
}

}  // namespace pmg::ops
