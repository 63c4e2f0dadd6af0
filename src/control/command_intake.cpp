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

const SourceRecord* CommandIntake::record_of(const Source& source, std::int64_t received_ns) const noexcept {
  const SourceRecord* record = sources_.find(source);
  if (record == nullptr || source.session >= record->source.session) return record;
  return received_ns - record->heard_ns > SourceMemory::kSessionHolds_ns ? nullptr : record;
}

bool CommandIntake::uses_drivers_name(const Source& source, std::int64_t now_ns) const noexcept {
  return leased(now_ns) && source.name == last_.source.name && source != last_.source;
}

CommandIntake::DriveVerdict CommandIntake::accept(const DriveMessage& message, std::int64_t now_ns) noexcept {
  const std::int64_t received_ns = receipt_ns(message.received_ns, now_ns);
  const DriveVerdict verdict = check(message, received_ns, now_ns);
  ++(ignored_.*kDriveCounters[static_cast<std::size_t>(verdict)]);
  if (verdict != DriveVerdict::kAccepted) return verdict;
  sources_.adopt(message.source, driving(now_ns), message.stamp_ns, received_ns).last_command = message.sequence;
  if (!leased(now_ns) || message.source != last_.source || asks_for_motion(message.command, last_.command)) {
    moved_ns_ = received_ns;
  }
  any_ = true;
  last_ = message;
  received_ns_ = received_ns;
  lease_end_ns_ = received_ns + io::nanoseconds(std::min(message.lease_s, kLongestLease_s));
  return verdict;
}

CommandIntake::DriveVerdict CommandIntake::check(const DriveMessage& message, std::int64_t received_ns,
                                                 std::int64_t now_ns) noexcept {
  if (!std::ranges::all_of(message.command.u, [](double value) { return std::isfinite(value); })) {
    return DriveVerdict::kNotFinite;
  }
  if (!(message.lease_s > 0.0)) return DriveVerdict::kNoLease;
  const DriveVerdict order = check_order(message, &SourceRecord::last_command, received_ns);
  if (order != DriveVerdict::kAccepted) return order;
  return leased(now_ns) && message.source != last_.source ? DriveVerdict::kOtherSourceDrives : DriveVerdict::kAccepted;
}

template <typename Message>
CommandIntake::DriveVerdict CommandIntake::check_order(const Message& message, std::int64_t SourceRecord::*last,
                                                       std::int64_t received_ns) const noexcept {
  const SourceRecord* record = record_of(message.source, received_ns);
  if (record != nullptr && message.source.session < record->source.session) return DriveVerdict::kOutOfOrder;
  if (record != nullptr && message.source == record->source) {
    if (message.sequence <= record->*last) return DriveVerdict::kOutOfOrder;
    if (SourceMemory::late(*record, message.stamp_ns, received_ns)) return DriveVerdict::kLate;
  }
  return DriveVerdict::kAccepted;
}

CommandIntake::DriveVerdict CommandIntake::accept(const ArmsMessage& message, std::int64_t now_ns) noexcept {
  const std::int64_t received_ns = receipt_ns(message.received_ns, now_ns);
  const DriveVerdict verdict = check(message, received_ns, now_ns);
  ++(ignored_.*kDriveCounters[static_cast<std::size_t>(verdict)]);
  if (verdict != DriveVerdict::kAccepted) {
    ++arms_refused_;
    arms_refusal_ = verdict;
    return verdict;
  }
  sources_.adopt(message.source, driving(now_ns), message.stamp_ns, received_ns).last_arms = message.sequence;
  if (message.arm != arms_.arm) moved_ns_ = received_ns;
  arms_ = message;
  arms_end_ns_ = received_ns + io::nanoseconds(std::min(message.lease_s, kLongestArmsLease_s));
  return verdict;
}

CommandIntake::DriveVerdict CommandIntake::check(const ArmsMessage& message, std::int64_t received_ns,
                                                 std::int64_t now_ns) noexcept {
  if (!std::ranges::all_of(message.arm, reachable)) return DriveVerdict::kNotFinite;
  if (!(message.lease_s > 0.0)) return DriveVerdict::kNoLease;
  const DriveVerdict order = check_order(message, &SourceRecord::last_arms, received_ns);
  if (order != DriveVerdict::kAccepted) return order;
  return leased(now_ns) && message.source == last_.source ? DriveVerdict::kAccepted : DriveVerdict::kOtherSourceDrives;
}

ArmsOrder CommandIntake::arms_order(std::int64_t now_ns) const noexcept {
  if (!leased(now_ns) || arms_.source != last_.source) return ArmsOrder::kNoneCame;
  return now_ns < arms_end_ns_ ? ArmsOrder::kInForce : ArmsOrder::kLeaseOver;
}

CommandIntake::Judgement CommandIntake::judge(const ModeRequest& request, std::int64_t now_ns) noexcept {
  const std::int64_t received_ns = receipt_ns(request.received_ns, now_ns);
  const Judgement judgement = check(request, received_ns, now_ns);
  // One that names no mode is told so and counted by whoever decodes messages.
  if (judgement.verdict != Verdict::kNoMode) {
    ++(ignored_.*kRequestCounters[static_cast<std::size_t>(judgement.verdict)]);
  }
  if (request.stops() && judgement.verdict == Verdict::kTaken) stop(received_ns);
  if (judgement.fresh) {
    sources_.adopt(request.source, driving(now_ns), request.stamp_ns, received_ns).last_request = request.sequence;
    if (!request.stops() && leased(now_ns) && request.source != last_.source) {  // it takes over
      last_.source = request.source;
      moved_ns_ = received_ns;
      lease_end_ns_ = received_ns + io::nanoseconds(kTakeOverLease_s);
    }
  }
  return judgement;
}

CommandIntake::Judgement CommandIntake::check(const ModeRequest& request, std::int64_t received_ns,
                                              std::int64_t now_ns) noexcept {
  if (request.mode >= Mode::kFault) return {.verdict = Verdict::kNoMode};
  if (!request.stops() && received_ns <= stopped_ns_) return {.verdict = Verdict::kLate};
  const auto unless_stop = [&](Verdict verdict) {
    return Judgement{.verdict = request.stops() ? Verdict::kTaken : verdict};
  };
  if (!request.sealed || (request.stops() && uses_drivers_name(request.source, now_ns))) {
    return {.verdict = request.stops() ? Verdict::kTaken : Verdict::kNotYours};
  }
  const SourceRecord* record = record_of(request.source, received_ns);
  if (record != nullptr && request.source.session < record->source.session) return unless_stop(Verdict::kOutOfOrder);
  if (record != nullptr && request.source == record->source) {
    if (request.sequence == record->last_request) return {.verdict = Verdict::kTaken};
    if (request.sequence < record->last_request) return unless_stop(Verdict::kOutOfOrder);
    if (SourceMemory::late(*record, request.stamp_ns, received_ns)) return unless_stop(Verdict::kLate);
  }
  const bool takes_over = received_ns - moved_ns_ >= kAtRest_ns;
  const bool mine = !leased(now_ns) || request.source == last_.source || takes_over;
  return request.stops() || mine ? Judgement{.fresh = true} : Judgement{.verdict = Verdict::kNotYours};
}

double CommandIntake::age_s(std::int64_t now_ns) const noexcept {
  if (!any_) return std::numeric_limits<double>::infinity();
  return static_cast<double>(now_ns - received_ns_) * 1e-9;
}

Source CommandIntake::driving(std::int64_t now_ns) const noexcept { return leased(now_ns) ? last_.source : Source{}; }

}  // namespace pmg::control
