// Watches what the policy does to the reference: a residual policy that balances stays near it.
#pragma once

#include "pmg/types.hpp"
#include "runtime/fault.hpp"

namespace pmg::runtime {

struct ActionMonitorOptions {
  /// Largest |q_des - q_ref| of a joint. 40 degrees: assumption, far more than balance takes; a policy may know better.
  double bound_rad = 0.7;
  int persist_ticks = 3;
};

class ActionMonitor {
 public:
  /// Throws std::invalid_argument if the bound isn't positive.
  explicit ActionMonitor(const ActionMonitorOptions& options);

  void reset() noexcept { held_ticks_ = 0; }

  /// One call for every result of the policy [rad]. The fault, or code kNone.
  Fault watch(const JointVector& q_des, const JointVector& q_ref) noexcept;

 private:
  ActionMonitorOptions options_;
  int held_ticks_ = 0;
};

}  // namespace pmg::runtime
