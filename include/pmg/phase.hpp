// The gait phase phi (paper eq. 11). It freezes at rest.
#pragma once

#include <cmath>

namespace pmg {

/// x modulo one cycle, in [0, 1).
inline double wrap_cycle(double x) noexcept {
  const double fraction = x - std::floor(x);
  return fraction < 1.0 ? fraction : 0.0;  // a tiny negative x rounds up to 1
}

/// x modulo one cycle, in [-0.5, 0.5): the signed difference of two phases.
inline double wrap_half_cycle(double x) noexcept { return wrap_cycle(x + 0.5) - 0.5; }

/// phi <- (phi + dt / T) mod 1 once per tick (paper eq. 11). After some time at rest phi freezes. It continues from
/// there when the rest ends.
class GaitPhase {
 public:
  void reset(double phase) noexcept {
    phase_ = phase;
    rate_per_s_ = 0.0;
    rest_s_ = 0.0;
    frozen_ = true;
  }

  /// (T, at rest, dt) => (phi, dphi/dt).
  void advance(double period_s, bool at_rest, double dt_s) noexcept {
    rest_s_ = at_rest ? rest_s_ + dt_s : 0.0;
    frozen_ = frozen_ && at_rest;
    rate_per_s_ = frozen_ ? 0.0 : 1.0 / period_s;
    phase_ = wrap_cycle(phase_ + rate_per_s_ * dt_s);
  }

  /// Call after advance(). If the rest has lasted long enough and both feet are in contact, phi freezes from the next
  /// tick on.
  void freeze_after_rest(double rest_before_freeze_s, bool both_feet_in_contact) noexcept {
    constexpr double kRounding_s = 1e-9;  // rest_s_ is a sum of many dt
    if (both_feet_in_contact && rest_s_ > 0.0 && rest_s_ >= rest_before_freeze_s - kRounding_s) frozen_ = true;
  }

  double phase() const noexcept { return phase_; }
  double rate_per_s() const noexcept { return rate_per_s_; }  ///< of the last advance()
  bool frozen() const noexcept { return frozen_; }

 private:
  double phase_ = 0.0;
  double rate_per_s_ = 0.0;
  double rest_s_ = 0.0;
  bool frozen_ = true;
};

}  // namespace pmg
