// Watches what the policy does to the reference: a residual policy that balances stays near it.
#pragma once

#include <cstdint>

#include "pmg/types.hpp"
#include "runtime/fault.hpp"

namespace pmg::runtime {

/// A fault: some joint beyond the bound in persist_ticks of the last window_ticks.
struct ActionMonitorOptions {
  /// Largest |q_des - q_ref| of a joint. 40 degrees: assumption, far more than balance takes; a policy may know better.
  double bound_rad = 0.7;
  /// 0.2 s: a policy that catches the robot after a push stays at its clamp for a while, and damping it then drops a
  /// robot that was about to save itself. Of pushes of 35 N s, Z1 survived 19 % with 3 ticks in a row, 62 % with 5, 94
  /// % with 10 or 20; of 50 N s, 81 % with 20 (pmg_eval push).
  int persist_ticks = 20;
  /// 0.5 s, not 20 ticks in a row: a policy whose actions are five times too large throws the ankles from one clamp to
  /// the other and is within the bound half of the time (test/runtime/sabotage_test.cpp).
  int window_ticks = 50;
};

class ActionMonitor {
 public:
  static constexpr int kLongestWindow = 64;  ///< ticks; one bit each

  /// Throws std::invalid_argument unless the bound is positive and 1 <= persist_ticks <= window_ticks <=
  /// kLongestWindow.
  explicit ActionMonitor(const ActionMonitorOptions& options);

  void reset() noexcept { beyond_ = 0; }

  /// One call for every result of the policy [rad]. The fault, or code kNone.
  Fault watch(const JointVector& q_des, const JointVector& q_ref) noexcept;

 private:
  ActionMonitorOptions options_;
  std::uint64_t window_;      ///< as many ones as the window has ticks
  std::uint64_t beyond_ = 0;  ///< a bit a tick, the newest lowest
};

}  // namespace pmg::runtime
