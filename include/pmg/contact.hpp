// Contact of a foot over the phase, from its contact centre mu and duty factor r.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pmg/phase.hpp"

namespace pmg {

/// True in stance: |wrap(phi - mu)| <= r / 2.
inline bool in_contact(double phase, double contact_center, double duty_factor) noexcept {
  return std::abs(wrap_half_cycle(phase - contact_center)) <= 0.5 * duty_factor;
}

/// Contact weight in [0, 1], with cosine edges inside the stance:
///   w = (1 - cos(pi x)) / 2,  x = clip((b - |wrap(phi - mu)|) / edge, 0, 1),
///   b = r / 2 + max(0, edge - (1 - r) / 2), the stance boundary [cycles].
/// Because the edge lies inside the stance, in single support the other foot alone determines the base. A swing shorter
/// than two edges occurs only between walking and standing. Then the second term moves b outwards, until at r = 1 the
/// weight is 1 everywhere. So w is continuous in r too.
inline double contact_weight(double phase, double contact_center, double duty_factor, double edge_cycle) noexcept {
  const double distance = std::abs(wrap_half_cycle(phase - contact_center));
  const double boundary = 0.5 * duty_factor + std::max(0.0, edge_cycle - 0.5 * (1.0 - duty_factor));
  const double inside = (boundary - distance) / edge_cycle;
  if (inside >= 1.0) return 1.0;
  if (inside <= 0.0) return 0.0;
  return 0.5 * (1.0 - std::cos(std::numbers::pi * inside));
}

/// The share s in r = r_clips + s (1 - r_clips): 0 while walking, 1 at rest. It ramps between the two, so no foot
/// becomes loaded from one tick to the next.
class StanceRamp {
 public:
  void reset() noexcept { standing_ = 1.0; }
  void step(bool at_rest, double ramp_s, double dt_s) noexcept {
    const double change = ramp_s > 0.0 ? dt_s / ramp_s : 1.0;
    standing_ = std::clamp(standing_ + (at_rest ? change : -change), 0.0, 1.0);
  }
  double standing() const noexcept { return standing_; }

 private:
  double standing_ = 1.0;
};

}  // namespace pmg
