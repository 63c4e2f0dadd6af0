#include "runtime/command_intake.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::runtime {

CommandIntake::Verdict CommandIntake::accept(const DriveMessage& message, std::int64_t now_ns) noexcept {
  const bool same_source = any_ && message.source == last_.source;
  if (leased(now_ns) && !same_source) return Verdict::kOtherSourceDrives;
  if (same_source && message.sequence <= last_.sequence) return Verdict::kOutOfOrder;
  if (!std::ranges::all_of(message.command.u, [](double value) { return std::isfinite(value); })) {
    return Verdict::kNotFinite;
  }
  if (!(message.lease_s > 0.0)) return Verdict::kNoLease;
  any_ = true;
  last_ = message;
  received_ns_ = now_ns;
  lease_end_ns_ = now_ns + static_cast<std::int64_t>(std::min(message.lease_s, kLongestLease_s) * 1e9);
  return Verdict::kAccepted;
}

bool CommandIntake::may_request(const ModeRequest& request, std::int64_t now_ns) const noexcept {
  const bool stop = !request.reset_fault && (request.mode == Mode::kPassive || request.mode == Mode::kDamping);
  return stop || !leased(now_ns) || request.source == last_.source;
}

double CommandIntake::age_s(std::int64_t now_ns) const noexcept {
  if (!any_) return std::numeric_limits<double>::infinity();
  return static_cast<double>(now_ns - received_ns_) * 1e-9;
}

Source CommandIntake::driving(std::int64_t now_ns) const noexcept { return leased(now_ns) ? last_.source : Source{}; }

}  // namespace pmg::runtime
