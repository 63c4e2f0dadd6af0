// The reference of a sit-down whose motion generator has failed: from the last finite reference down to the squat.
#pragma once

#include "pmg/reference.hpp"
#include "pmg/types.hpp"

namespace pmg::control {

class FallbackReference {
 public:
  explicit FallbackReference(double duration_s) : duration_s_(duration_s) {}

  /// (last finite reference, command u' that the policy observed with it, squat [rad], height channel there [m]).
  void start(const Reference& last, const Command& observed, const JointVector& squat_rad, double height_m) noexcept;
  /// The reference dt_s later, with t = elapsed / duration and s = t^2 (3 - 2 t):
  /// q = q_last + s (q_squat - q_last) [rad], dq = ds/dt (q_squat - q_last) [rad/s]. The gait's gain and both commands
  /// shrink with 1 - s, and the height channel goes to the squat's. The phase stands still, and both feet are in
  /// contact.
  const Reference& advance(double dt_s) noexcept;
  const Command& observed() const noexcept { return observed_; }  ///< u' with that reference

  bool active() const noexcept { return active_; }
  void stop() noexcept { active_ = false; }

 private:
  double duration_s_, elapsed_s_ = 0.0, height_m_ = 0.0;
  bool active_ = false;
  Reference last_, reference_;
  Command last_observed_, observed_;
  JointVector way_rad_;
};

}  // namespace pmg::control
