#include "runtime/action_monitor.hpp"

#include <stdexcept>

namespace pmg::runtime {

ActionMonitor::ActionMonitor(const ActionMonitorOptions& options) : options_(options) {
  if (!(options.bound_rad > 0.0)) throw std::invalid_argument("ActionMonitor: bound_rad; expected more than 0");
}

Fault ActionMonitor::watch(const JointVector& q_des, const JointVector& q_ref) noexcept {
  Eigen::Index joint = 0;
  const double farthest_rad = (q_des - q_ref).cwiseAbs().maxCoeff(&joint);
  held_ticks_ = farthest_rad > options_.bound_rad ? held_ticks_ + 1 : 0;
  if (held_ticks_ < options_.persist_ticks) return {};
  return {.code = FaultCode::kActionOutOfRange,
          .joint = static_cast<int>(joint),
          .value = farthest_rad,
          .limit = options_.bound_rad};
}

}  // namespace pmg::runtime
