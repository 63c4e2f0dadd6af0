// Watches what the policy does to the reference: a residual policy that balances stays near it.
#pragma once

#include <array>
#include <cstdint>

#include "control/fault.hpp"
#include "pmg/types.hpp"

namespace pmg::control {

/// Two ways to lose one's senses: pulling a joint away and holding on, and throwing joints to and fro.
struct ActionMonitorOptions {
  /// Largest |q_des - q_ref| of a joint. 40 degrees: assumption, far more than balance takes; a policy may know better.
  double bound_rad = 0.7;
  /// So many ticks in a row beyond the bound, 0.2 s, are a fault. A policy that catches the robot after a push needs
  /// its clamp for a while, and damping it then drops a robot that was about to save itself: of 96 pushes of 50 N s Z1
  /// survives 28 % with 3 ticks, 38 % with 5, 76 % with 10, 97 % with 20 or any more; of 48 of 35 N s 77 %, 88 %, 100
  /// %, 100 %.
  int persist_ticks = 20;
  /// So many ticks with a reversal among the last window_ticks are a fault. A joint reverses when it is beyond the
  /// bound on one side and was so on the other at most reversal_ticks before. Actions five times too large do that
  /// several times a second without staying for 0.2 s; pushes that Z1 survives, up to 50 N s, never do.
  int reversals = 2;
  int reversal_ticks = 20;
  int window_ticks = 50;
};

class ActionMonitor {
 public:
  static constexpr int kLongestWindow = 64;  ///< ticks; one bit each

  /// Throws std::invalid_argument unless the bound is positive, the numbers of ticks are 1 or more, and reversals <=
  /// window_ticks <= kLongestWindow.
  explicit ActionMonitor(const ActionMonitorOptions& options);

  void reset() noexcept;

  /// One call for every result of the policy [rad]. The fault, or code kNone.
  Fault watch(const JointVector& q_des, const JointVector& q_ref) noexcept;

 private:
  /// Where a joint was when it was beyond the bound last.
  struct Excursion {
    bool above = false;
    std::int64_t tick = 0;  ///< 0: never yet
  };
  bool reverses(const JointVector& q_des, const JointVector& q_ref) noexcept;

  ActionMonitorOptions options_;
  std::uint64_t window_;  ///< as many ones as the window has ticks
  std::int64_t tick_ = 0;
  int held_ticks_ = 0;
  std::uint64_t reversed_ = 0;  ///< a bit a tick, the newest lowest
  std::array<Excursion, kMaxJoints> excursions_{};
};

}  // namespace pmg::control
