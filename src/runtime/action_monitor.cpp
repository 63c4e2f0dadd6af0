#include "runtime/action_monitor.hpp"

#include <bit>
#include <limits>
#include <stdexcept>

namespace pmg::runtime {

namespace {

const ActionMonitorOptions& checked(const ActionMonitorOptions& options) {
  if (!(options.bound_rad > 0.0)) throw std::invalid_argument("ActionMonitor: bound_rad; expected more than 0");
  if (options.persist_ticks < 1 || options.window_ticks < options.persist_ticks ||
      options.window_ticks > ActionMonitor::kLongestWindow) {
    throw std::invalid_argument("ActionMonitor: persist_ticks, window_ticks; expected 1 to window_ticks, 64 at most");
  }
  return options;
}

}  // namespace

ActionMonitor::ActionMonitor(const ActionMonitorOptions& options)
    : options_(checked(options)),
      window_(std::numeric_limits<std::uint64_t>::max() >> (kLongestWindow - options.window_ticks)) {}

Fault ActionMonitor::watch(const JointVector& q_des, const JointVector& q_ref) noexcept {
  Eigen::Index joint = 0;
  const double farthest_rad = (q_des - q_ref).cwiseAbs().maxCoeff(&joint);
  const bool beyond = farthest_rad > options_.bound_rad;
  beyond_ = (beyond_ << 1 | (beyond ? 1u : 0u)) & window_;
  // Only in a tick that is beyond itself: what it names then is what it sees.
  if (!beyond || std::popcount(beyond_) < options_.persist_ticks) return {};
  return {.code = FaultCode::kActionOutOfRange,
          .joint = static_cast<int>(joint),
          .value = farthest_rad,
          .limit = options_.bound_rad};
}

}  // namespace pmg::runtime
