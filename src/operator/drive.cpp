#include "operator/drive.hpp"

#include <fmt/format.h>

#include <utility>

#include "operator/words.hpp"

namespace pmg::ops {

namespace {

/// A controller that has been silent for this time is gone.
constexpr std::int64_t kSilent_ns = 500'000'000;

}  // namespace

Drive::Drive(OperatorSource& source, std::string robot, const Command& command, const DriveOptions& options)
    : source_(source),
      robot_(std::move(robot)),
      command_(command),
      options_(options),
      begin_ns_(source.clock().now_ns()) {
  enter(options.climb ? Phase::kClimbing : Phase::kClaiming);
}

void Drive::enter(Phase phase) {
  phase_ = phase;
  phase_since_ns_ = send_at_ns_ = source_.clock().now_ns();
  send_if_due();  // the command must arrive before the request for Walk
  if (phase == Phase::kClimbing) climb_.emplace(source_, robot_, Goal::kWalk, options_.timeout_s);
  if (phase == Phase::kDescending) wish_.emplace(source_, robot_, Goal::kStand, options_.timeout_s);
}

void Drive::end_early() noexcept { end_early_ = true; }

double Drive::driven_s() const {
  if (phase_ != Phase::kDriving) return driven_s_;
  return static_cast<double>(source_.clock().now_ns() - phase_since_ns_) * 1e-9;
}

Progress Drive::step() {
  if (phase_ == Phase::kEnded) {
    if (!text_.empty()) return Progress::kFailed;
    return source_.clock().now_ns() - phase_since_ns_ < kRelease_ns ? Progress::kPending : Progress::kReached;
  }
  send_if_due();
  const std::int64_t in_phase_ns = source_.clock().now_ns() - phase_since_ns_;
  switch (phase_) {
    case Phase::kClimbing:
      if (end_early_) {
        enter(Phase::kDescending);
        return Progress::kPending;
      }
      return follow_climb();
    case Phase::kClaiming:
      return claim();
    case Phase::kDriving:
      if (const std::string trouble_text = trouble(); !trouble_text.empty()) return fail(trouble_text);
      if (end_early_ || driven_s() >= options_.duration_s) {
        driven_s_ = driven_s();
        enter(Phase::kCalming);
      }
      return Progress::kPending;
    case Phase::kCalming:
      if (in_phase_ns >= kCalm_ns) enter(options_.climb ? Phase::kDescending : Phase::kEnded);
      return Progress::kPending;
    default:
      return follow_wish();
  }
}

Progress Drive::follow_climb() {
  const Progress progress = climb_->step();
  if (progress == Progress::kPending) return progress;
  if (progress == Progress::kFailed) return fail(climb_->text());
  enter(Phase::kDriving);
  return Progress::kPending;
}

std::string Drive::waits_for() const {
  if (phase_ == Phase::kClimbing) return climb_->waits_for();
  const HeardRobot* heard = phase_ == Phase::kClaiming ? source_.heard(robot_) : nullptr;
  return heard == nullptr ? "" : heard->silent_driver(source_.name());
}

Progress Drive::claim() {
  if (end_early_) {
    enter(Phase::kEnded);
    return Progress::kPending;
  }
  const HeardRobot* heard = source_.heard(robot_);
  if (heard != nullptr && heard->status && heard->status->driving_source == source_.name()) {
    enter(Phase::kDriving);
    return Progress::kPending;
  }
  const std::int64_t now_ns = source_.clock().now_ns();
  if (!waits_for().empty() && static_cast<double>(now_ns - begin_ns_) * 1e-9 < options_.timeout_s) {
    phase_since_ns_ =
        now_ns;  // after the end of the lease the controller has kSettle_ns to show this source as driving
    return Progress::kPending;
  }
  const std::string trouble_text = trouble();
  return trouble_text.empty() ? Progress::kPending : fail(trouble_text);
}

Progress Drive::follow_wish() {
  const Progress progress = wish_->step();
  if (progress == Progress::kPending) return progress;
  if (progress == Progress::kFailed) return fail(wish_->answers().front().text);
  enter(Phase::kEnded);
  return Progress::kPending;
}

Progress Drive::fail(const std::string& text) {
  driven_s_ = driven_s();
  text_ = text;
  enter(Phase::kEnded);
  return Progress::kFailed;
}

std::string Drive::trouble() const {
  const std::int64_t now_ns = source_.clock().now_ns();
  if (now_ns - phase_since_ns_ < kSettle_ns) return "";
  const HeardRobot* heard = source_.heard(robot_);
  if (heard == nullptr || !heard->status) return fmt::format("no controller of this name answers on {}", source_.url());
  if (now_ns - heard->status_heard_ns > kSilent_ns) return "the controller is no longer heard";
  const pmg_msgs::status_t& status = *heard->status;
  if (status.mode == pmg_msgs::mode_t::FAULT) return "fault: " + status.fault;
  if (status.driving_source != source_.name()) {
    if (status.driving_source.empty() && heard->lacks_key()) return kNoKey;
    return status.driving_source.empty() ? "its commands are not taken: pmg_watch shows by what count"
                                         : "another source drives: " + status.driving_source;
  }
  if (status.mode != pmg_msgs::mode_t::WALK) {
    if (status.hanging) return kHangs;
    if (status.footing_unknown) return kFootingUnknown;
    const char* mode = mode_name(status.mode);
    return options_.climb ? fmt::format("walk was ended by another request: mode is {}", mode)
                          : fmt::format("mode is {}: commands move a robot in walk only", mode);
  }
  return "";
}

void Drive::send_if_due() {
  if (phase_ == Phase::kEnded) {
    source_.send_command(robot_, Command{}, kLastLease_s);  // lets go
    return;
  }
  // Before the controller is heard no command would be fresh. The first one goes out as soon as one can be.
  if (source_.heard(robot_) == nullptr || source_.clock().now_ns() < send_at_ns_) return;
  send_at_ns_ += kPeriod_ns;
  if (send_at_ns_ < source_.clock().now_ns()) send_at_ns_ = source_.clock().now_ns();  // after a pause: no burst
  source_.send_command(robot_, phase_ == Phase::kDriving ? command_ : Command{}, kLease_s);
}

}  // namespace pmg::ops
