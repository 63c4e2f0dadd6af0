// Watches the distance between the policy's targets and the reference. A policy that balances stays near it.
#pragma once

#include <array>
#include <cstdint>

#include "faults/fault.hpp"
#include "pmg/types.hpp"

namespace pmg::faults {

/// Two signs of a policy that fails: it holds a joint far from the reference, or it throws joints to and fro.
struct ActionMonitorOptions {
  /// Largest |q_des - q_ref| of a joint. 40 degrees: an assumption, far more than balance takes. A policy's file may
  /// give another value.
  double bound_rad = 0.7;
  /// So many ticks in a row beyond the bound are a fault: 0.2 s. A policy that catches the robot after a push stays
  /// beyond the bound for a while; damping at that moment drops a robot that would have recovered. Z1 survives, of 96
  /// pushes of 50 N s, 28 % with 3 ticks, 38 % with 5, 76 % with 10, 97 % with 20 or more; of 48 pushes of 35 N s 77 %,
  /// 88 %, 100 %, 100 %.
  int persist_ticks = 20;
  /// So many ticks with a reversal among the last window_ticks are a fault. A joint reverses when it is beyond the
  /// bound on one side and was beyond it on the other side at most reversal_ticks before. Actions that are five times
  /// too large reverse several times a second without staying beyond for 0.2 s. Pushes that Z1 survives, up to 50 N s,
  /// cause none.
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

  /// (q_des, q_ref) => (fault, or code kNone) [rad]. Call it for every result of the policy.
  Fault watch(const JointVector& q_des, const JointVector& q_ref) noexcept;

 private:
  /// A joint's last excursion beyond the bound.
  struct Excursion {
    bool above = false;
    std::int64_t tick = 0;  ///< 0: never yet
  };
  bool reverses(const JointVector& q_des, const JointVector& q_ref) noexcept;

  ActionMonitorOptions options_;
  std::uint64_t window_;  ///< a mask: one bit for each tick of the window
  std::int64_t tick_ = 0;
  int held_ticks_ = 0;
  std::uint64_t reversed_ = 0;  ///< a bit a tick, the newest lowest
  std::array<Excursion, kMaxJoints> excursions_{};
};

}  // namespace pmg::faults
