#include "control/command_intake.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "io/clock.hpp"

namespace pmg::control {

namespace {

constexpr std::array kDriveCounters = {&IgnoredCommands::accepted,     &IgnoredCommands::other_source,
                                       &IgnoredCommands::out_of_order, &IgnoredCommands::late,
                                       &IgnoredCommands::not_finite,   &IgnoredCommands::no_lease};
constexpr std::array kRequestCounters = {&IgnoredCommands::accepted, &IgnoredCommands::other_source,
                                         &IgnoredCommands::out_of_order, &IgnoredCommands::late};

/// When a message was received, by a clock that doesn't run backwards.
std::int64_t receipt_ns(std::int64_t received_ns, std::int64_t now_ns) noexcept {
  return std::min(std::max<std::int64_t>(received_ns, 0), now_ns);
}

bool asks_for_motion(const Command& command, const Command& before) noexcept {
  const bool moves = command[kVx] != 0.0 || command[kVy] != 0.0 || command[kOmega] != 0.0;
  return moves || command.u != before.u;
}

/// A NaN fails every comparison.
bool reachable(const ArmTarget& target) noexcept {
  if (target.wish != ArmWish::kAim) return true;
  const bool near = (target.palm.p_m.array().abs() <= CommandIntake::kFarthestPalm_m).all();
  return near && std::abs(target.palm.R.norm() - 1.0) <= CommandIntake::kUnitQuaternion;
}

}  // namespace

bool CommandIntake::uses_drivers_name(const Source& source, std::int64_t now_ns) const noexcept {
  return leased(now_ns) && source.name == last_.source.name && source != last_.source;
}

template <typename Message>
CommandIntake::DriveVerdict CommandIntake::take_number(const Message& message, std::int64_t SourceRecord::*last,
                                                       std::int64_t received_ns, std::int64_t now_ns,
                                                       SourceRecord*& record) noexcept {
  if (sources_.ended(message.source, received_ns)) return DriveVerdict::kOutOfOrder;
  record = sources_.hear(message.source, driving(now_ns), received_ns);
  if (record == nullptr || message.sequence <= record->*last) return DriveVerdict::kOutOfOrder;
  record->*last = message.sequence;
  return SourceMemory::late(*record, message.stamp_ns, received_ns) ? DriveVerdict::kLate : DriveVerdict::kAccepted;
}

CommandIntake::DriveVerdict CommandIntake::accept(const DriveMessage& message, std::int64_t now_ns) noexcept {
  const std::int64_t received_ns = receipt_ns(message.received_ns, now_ns);
  SourceRecord* record = nullptr;
  DriveVerdict verdict = take_number(message, &SourceRecord::last_command, received_ns, now_ns, record);
  if (verdict == DriveVerdict::kAccepted) verdict = check(message, now_ns);
  ++(ignored_.*kDriveCounters[static_cast<std::size_t>(verdict)]);
  if (verdict != DriveVerdict::kAccepted) return verdict;
  SourceMemory::take(*record, message.stamp_ns, received_ns);
  if (!leased(now_ns) || message.source != last_.source || asks_for_motion(message.command, last_.command)) {
    moved_ns_ = received_ns;
  }
  any_ = true;
  last_ = message;
  received_ns_ = received_ns;
  lease_end_ns_ = received_ns + io::nanoseconds(std::min(message.lease_s, kLongestLease_s));
  return verdict;
}

CommandIntake::DriveVerdict CommandIntake::check(const DriveMessage& message, std::int64_t now_ns) const noexcept {
  if (!std::ranges::all_of(message.command.u, [](double value) { return std::isfinite(value); })) {
    return DriveVerdict::kNotFinite;
  }
  if (!(message.lease_s > 0.0)) return DriveVerdict::kNoLease;
  return leased(now_ns) && message.source != last_.source ? DriveVerdict::kOtherSourceDrives : DriveVerdict::kAccepted;
}

CommandIntake::DriveVerdict CommandIntake::accept(const ArmsMessage& message, std::int64_t now_ns) noexcept {
  const std::int64_t received_ns = receipt_ns(message.received_ns, now_ns);
  SourceRecord* record = nullptr;
  DriveVerdict verdict = take_number(message, &SourceRecord::last_arms, received_ns, now_ns, record);
  if (verdict == DriveVerdict::kAccepted) verdict = check(message, now_ns);
  ++(ignored_.*kDriveCounters[static_cast<std::size_t>(verdict)]);
  if (verdict != DriveVerdict::kAccepted) {
    ++arms_refused_;
    arms_refusal_ = verdict;
    return verdict;
  }
  SourceMemory::take(*record, message.stamp_ns, received_ns);
  if (message.arm != arms_.arm) moved_ns_ = received_ns;
  arms_ = message;
  arms_end_ns_ = received_ns + io::nanoseconds(std::min(message.lease_s, kLongestArmsLease_s));
  return verdict;
}

CommandIntake::DriveVerdict CommandIntake::check(const ArmsMessage& message, std::int64_t now_ns) const noexcept {
  if (!std::ranges::all_of(message.arm, reachable)) return DriveVerdict::kNotFinite;
  if (!(message.lease_s > 0.0)) return DriveVerdict::kNoLease;
  return leased(now_ns) && message.source == last_.source ? DriveVerdict::kAccepted : DriveVerdict::kOtherSourceDrives;
}

ArmsOrder CommandIntake::arms_order(std::int64_t now_ns) const noexcept {
  if (!leased(now_ns) || arms_.source != last_.source) return ArmsOrder::kNoneCame;
  return now_ns < arms_end_ns_ ? ArmsOrder::kInForce : ArmsOrder::kLeaseOver;
}

CommandIntake::Standing CommandIntake::standing(const ModeRequest& request, std::int64_t received_ns,
                                                std::int64_t now_ns) const noexcept {
  if (!request.sealed || (request.stops() && uses_drivers_name(request.source, now_ns))) return Standing::kNobodys;
  if (sources_.ended(request.source, received_ns)) return Standing::kOverdue;
  const SourceRecord* record = sources_.find(request.source);
  if (record == nullptr || request.sequence > record->last_request) return Standing::kNew;
  const bool same_wish = request.mode == record->asked_mode && request.reset_fault == record->asked_reset;
  return request.sequence == record->last_request && same_wish ? Standing::kRepeated : Standing::kOverdue;
}

CommandIntake::Judgement CommandIntake::judge(const ModeRequest& request, std::int64_t now_ns, bool down) noexcept {
  const std::int64_t received_ns = receipt_ns(request.received_ns, now_ns);
  Judgement judgement;
  switch (standing(request, received_ns, now_ns)) {
    case Standing::kNew:
      judgement = judge_new(request, received_ns, now_ns, down);
      break;
    case Standing::kRepeated:
      judgement.verdict = sources_.hear(request.source, driving(now_ns), received_ns)->verdict;
      break;
    case Standing::kOverdue:
      judgement.verdict = Verdict::kOutOfOrder;
      break;
    case Standing::kNobodys:
      judgement.verdict = before_stop(request, received_ns) ? Verdict::kLate : Verdict::kNotYours;
      break;
  }
  if (request.stops()) judgement.verdict = Verdict::kTaken;
  // One that names no mode is told so and counted by whoever decodes messages; one of a robot that lies was heard.
  if (judgement.verdict == Verdict::kTilted) {
    ++ignored_.accepted;
  } else if (judgement.verdict != Verdict::kNoMode) {
    ++(ignored_.*kRequestCounters[static_cast<std::size_t>(judgement.verdict)]);
  }
  if (request.stops()) stop(received_ns);
  return judgement;
}

CommandIntake::Judgement CommandIntake::judge_new(const ModeRequest& request, std::int64_t received_ns,
                                                  std::int64_t now_ns, bool down) noexcept {
  SourceRecord* record = sources_.hear(request.source, driving(now_ns), received_ns);
  if (record == nullptr) return {.verdict = Verdict::kNotYours};
  const Judgement judgement = decide(request, *record, received_ns, now_ns, down);
  record->last_request = request.sequence;
  record->asked_mode = request.mode;
  record->asked_reset = request.reset_fault;
  record->verdict = judgement.verdict;
  if (!judgement.fresh) return judgement;
  SourceMemory::take(*record, request.stamp_ns, received_ns);
  if (!request.stops() && leased(now_ns) && request.source != last_.source) {  // it takes over
    last_.source = request.source;
    moved_ns_ = received_ns;
    lease_end_ns_ = received_ns + io::nanoseconds(kTakeOverLease_s);
  }
  return judgement;
}

CommandIntake::Judgement CommandIntake::decide(const ModeRequest& request, const SourceRecord& record,
                                               std::int64_t received_ns, std::int64_t now_ns,
                                               bool down) const noexcept {
  if (request.mode >= Mode::kFault) return {.verdict = Verdict::kNoMode};
  if (before_stop(request, received_ns) || SourceMemory::late(record, request.stamp_ns, received_ns)) {
    return {.verdict = Verdict::kLate};
  }
  const bool takes_over = received_ns - moved_ns_ >= kAtRest_ns;
  const bool mine = !leased(now_ns) || request.source == last_.source || takes_over;
  if (!request.stops() && !mine) return {.verdict = Verdict::kNotYours};
  if (down && upright(request.mode) && !request.reset_fault) return {.verdict = Verdict::kTilted};
  return {.fresh = true};
}

double CommandIntake::age_s(std::int64_t now_ns) const noexcept {
  if (!any_) return std::numeric_limits<double>::infinity();
  return static_cast<double>(now_ns - received_ns_) * 1e-9;
}

Source CommandIntake::driving(std::int64_t now_ns) const noexcept { return leased(now_ns) ? last_.source : Source{}; }

}  // namespace pmg::control
