#include "faults/action_monitor.hpp"

#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace pmg::faults {

namespace {

const ActionMonitorOptions& checked(const ActionMonitorOptions& options) {
  if (!(options.bound_rad > 0.0)) throw std::invalid_argument("ActionMonitor: bound_rad; expected more than 0");
  if (options.persist_ticks < 1 || options.reversal_ticks < 1 || options.reversals < 1 ||
      options.reversals > options.window_ticks || options.window_ticks > ActionMonitor::kLongestWindow) {
    throw std::invalid_argument("ActionMonitor: ticks and reversals; expected 1 or more, window_ticks 64 at most");
  }
  return options;
}

}  // namespace

ActionMonitor::ActionMonitor(const ActionMonitorOptions& options)
    : options_(checked(options)),
      window_(std::numeric_limits<std::uint64_t>::max() >> (kLongestWindow - options.window_ticks)) {}

void ActionMonitor::reset() noexcept {
  tick_ = 0;
  held_ticks_ = 0;
  reversed_ = 0;
  excursions_.fill({});
}

Fault ActionMonitor::watch(const JointVector& q_des, const JointVector& q_ref) noexcept {
  ++tick_;
  Eigen::Index joint = 0;
  const double farthest_rad = (q_des - q_ref).cwiseAbs().maxCoeff(&joint);
  held_ticks_ = farthest_rad > options_.bound_rad ? held_ticks_ + 1 : 0;
  const bool reversal = reverses(q_des, q_ref);
  reversed_ = (reversed_ << 1 | (reversal ? 1u : 0u)) & window_;
  const bool thrown = reversal && std::popcount(reversed_) >= options_.reversals;
  if (held_ticks_ < options_.persist_ticks && !thrown) return {};
  return {.code = FaultCode::kActionOutOfRange,
          .joint = static_cast<int>(joint),
          .value = farthest_rad,
          .limit = options_.bound_rad};
}

bool ActionMonitor::reverses(const JointVector& q_des, const JointVector& q_ref) noexcept {
  bool any = false;
  for (Eigen::Index i = 0; i < q_des.size(); ++i) {
    const double offset_rad = q_des[i] - q_ref[i];
    if (!(std::abs(offset_rad) > options_.bound_rad)) continue;
    Excursion& last = excursions_[static_cast<std::size_t>(i)];
    const bool above = offset_rad > 0.0;
    any = any || (last.tick > 0 && last.above != above && tick_ - last.tick <= options_.reversal_ticks);
    last = {.above = above, .tick = tick_};
  }
  return any;
}

}  // namespace pmg::faults
