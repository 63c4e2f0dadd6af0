#include "operator/mode_wish.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "operator/nobody_answers.hpp"
#include "operator/words.hpp"

namespace pmg::ops {

namespace {

using Modes = pmg_msgs::mode_t;

std::int8_t requested_mode(Goal goal) {
  switch (goal) {
    case Goal::kPassive:
      return Modes::PASSIVE;
    case Goal::kStand:
      return Modes::STAND;
    case Goal::kWalk:
      return Modes::WALK;
    default:
      return Modes::DAMPING;
  }
}

bool reached(Goal goal, std::int8_t mode) {
  switch (goal) {
    case Goal::kStop:
      return mode == Modes::DAMPING || mode == Modes::PASSIVE || mode == Modes::FAULT;
    case Goal::kReset:
      return mode != Modes::FAULT;
    default:
      return mode == requested_mode(goal);
  }
}

std::string fault_words(const HeardRobot& heard) {
  return heard.status && !heard.status->fault.empty() ? heard.status->fault : "a fault is latched";
}

bool refused(const HeardRobot& heard) { return heard.ack && heard.ack->verdict == pmg_msgs::ack_t::NOT_YOURS; }

bool lease_is_over(const HeardRobot& heard, const OperatorSource& me) {
  return heard.status && heard.status->stamp_ns >= heard.ack->stamp_ns &&
         (heard.status->driving_source.empty() || me.drives(*heard.status));
}

}  // namespace

ModeWish::ModeWish(OperatorSource& source, std::string robot, Goal goal, double timeout_s)
    : source_(source),
      robot_(std::move(robot)),
      goal_(goal),
      timeout_s_(timeout_s),
      begin_ns_(source.clock().now_ns()),
      repeat_at_ns_(begin_ns_ + kRepeat_ns) {
  source_.request(robot_, requested_mode(goal), goal == Goal::kReset);
}

double ModeWish::elapsed_s() const { return static_cast<double>(source_.clock().now_ns() - begin_ns_) * 1e-9; }

std::string ModeWish::waits_for() const {
  const HeardRobot* heard = robot_.empty() ? nullptr : source_.heard(robot_);
  return heard != nullptr && refused(*heard) ? source_.silent_driver(*heard) : "";
}

bool ModeWish::final(const HeardRobot& heard) const {
  if (!refused(heard) || !heard.status || stopped_meanwhile(heard)) return true;
  if (lease_is_over(heard, source_) || !source_.silent_driver(heard).empty()) return false;
  return refused_ns_ >= 0 && source_.clock().now_ns() - refused_ns_ >= kDoubt_ns;
}

bool ModeWish::stopped_meanwhile(const HeardRobot& heard) const {
  return upright_when_refused_ && goal_ != Goal::kReset && !is_upright(heard.status->mode);
}

void ModeWish::ask_again_after_lease() {
  const HeardRobot* heard = robot_.empty() ? nullptr : source_.heard(robot_);
  if (heard == nullptr || !refused(*heard)) return;
  const std::int64_t now_ns = source_.clock().now_ns();
  if (refused_ns_ < 0) {
    refused_ns_ = now_ns;
    upright_when_refused_ = heard->status && is_upright(heard->status->mode);
  }
  if (final(*heard) || !lease_is_over(*heard, source_) || now_ns < repeat_at_ns_) return;
  repeat_at_ns_ = now_ns + kRepeat_ns;
  source_.request(robot_, requested_mode(goal_), goal_ == Goal::kReset);
}

void ModeWish::note_times() {
  const double now_s = elapsed_s();
  for (const Answer& answer : answers()) {
    Times& times = times_[answer.robot];
    if (answer.acknowledged && !times.acknowledged_s) times.acknowledged_s = now_s;
    if (answer.progress == Progress::kReached && !times.reached_s) times.reached_s = now_s;
  }
}

Progress ModeWish::step() {
  ask_again_after_lease();
  note_times();
  const std::vector<Answer> all = answers();
  const auto every = [&](auto condition) { return std::ranges::all_of(all, condition); };
  const bool gathered = !robot_.empty() || source_.clock().now_ns() - begin_ns_ >= kGather_ns;
  const bool timed_out = elapsed_s() >= timeout_s_;
  if (gathered && !all.empty() && every([](const Answer& a) { return a.progress != Progress::kPending; })) {
    return every([](const Answer& a) { return a.progress == Progress::kReached; }) ? Progress::kReached
                                                                                   : Progress::kFailed;
  }
  if (timed_out) return Progress::kFailed;
  const bool unanswered = all.empty() || !every([](const Answer& a) { return a.acknowledged; });
  if (unanswered && source_.clock().now_ns() >= repeat_at_ns_) {
    repeat_at_ns_ = source_.clock().now_ns() + kRepeat_ns;
    source_.repeat_request();
  }
  return Progress::kPending;
}

std::vector<Answer> ModeWish::answers() const {
  if (!robot_.empty()) return {judge(robot_)};
  std::vector<Answer> all;
  for (const auto& [robot, heard] : source_.heard()) all.push_back(judge(robot));
  return all;
}

Answer ModeWish::judge(const std::string& robot) const {
  Answer answer{.robot = robot, .mode = "unknown", .text = ""};
  if (const auto times = times_.find(robot); times != times_.end()) {
    answer.acknowledged_after_s = times->second.acknowledged_s;
    answer.reached_after_s = times->second.reached_s;
  }
  const HeardRobot* heard = source_.heard(robot);
  if (heard == nullptr) {
    answer.text = nobody_answers(source_);
    return answer;
  }
  answer.mode = mode_name(*heard->mode());
  if (!heard->ack) {
    answer.text = heard->lacks_key() ? kNoKey : "not acknowledged";
    return answer;
  }
  answer.acknowledged = true;
  if (heard->ack->verdict == pmg_msgs::ack_t::TAKEN) return judge_taken(answer, *heard);
  answer.text = verdict_words(heard->ack->verdict);
  if (heard->ack->verdict == pmg_msgs::ack_t::NOT_YOURS && heard->status) {
    answer.text += fmt::format(": {} (only a stop is taken from others)", heard->status->driving_source);
  }
  if (final(*heard)) answer.progress = Progress::kFailed;
  return answer;
}

Answer ModeWish::judge_taken(Answer answer, const HeardRobot& heard) const {
  const std::int8_t mode = *heard.mode();
  if (reached(goal_, mode)) {
    answer.progress = Progress::kReached;
    if (mode == Modes::FAULT) answer.text = fault_words(heard);
  } else if (mode == Modes::FAULT) {
    answer.progress = Progress::kFailed;
    answer.text = fault_words(heard) + (goal_ == Goal::kReset ? "; its cause is still there" : "; ask for a reset");
  } else if (goal_ == Goal::kPassive && mode == Modes::DAMPING) {
    answer.progress = Progress::kFailed;
    answer.text = "brakes; a robot that stood goes limp only when told twice";
  } else {
    answer.text = fmt::format("on its way to {}", mode_name(requested_mode(goal_)));
    if (heard.status && heard.status->hanging) answer.text = kHangs;
  }
  return answer;
}

}  // namespace pmg::ops
