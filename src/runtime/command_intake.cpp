#include "runtime/command_intake.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::runtime {

CommandIntake::DriveVerdict CommandIntake::accept(const DriveMessage& message, std::int64_t now_ns) noexcept {
  const bool same_source = any_ && message.source == last_.source;
  if (leased(now_ns) && !same_source) return DriveVerdict::kOtherSourceDrives;
  if (same_source && message.sequence <= last_.sequence) return DriveVerdict::kOutOfOrder;
  if (!std::ranges::all_of(message.command.u, [](double value) { return std::isfinite(value); })) {
    return DriveVerdict::kNotFinite;
  }
  if (!(message.lease_s > 0.0)) return DriveVerdict::kNoLease;
  any_ = true;
  last_ = message;
  received_ns_ = now_ns;
  lease_end_ns_ = now_ns + static_cast<std::int64_t>(std::min(message.lease_s, kLongestLease_s) * 1e9);
  return DriveVerdict::kAccepted;
}

Verdict CommandIntake::judge(const ModeRequest& request, std::int64_t now_ns) noexcept {
  if (request.mode == Mode::kFault) return Verdict::kNoMode;
  if (request.stops() || !leased(now_ns) || request.source == last_.source) return Verdict::kTaken;
  return Verdict::kNotYours;
}

double CommandIntake::age_s(std::int64_t now_ns) const noexcept {
  if (!any_) return std::numeric_limits<double>::infinity();
  return static_cast<double>(now_ns - received_ns_) * 1e-9;
}

Source CommandIntake::driving(std::int64_t now_ns) const noexcept { return leased(now_ns) ? last_.source : Source{}; }

}  // namespace pmg::runtime
