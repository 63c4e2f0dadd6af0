// When a foot carries the robot: contact centre mu and duty factor r over the phase.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pmg/phase.hpp"

namespace pmg {

/// |wrap(phi - mu)| <= r / 2.
inline bool in_contact(double phase, double contact_center, double duty_factor) noexcept {
  return std::abs(wrap_half_cycle(phase - contact_center)) <= 0.5 * duty_factor;
}

/// The same as a weight in [0, 1] with cosine edges, edge_cycle wide, inside the stance: 0 on its boundaries and
/// outside, so that the other foot alone determines the base in single support, 1 from edge_cycle inwards. A swing
/// shorter than two edges is on its way to standing: there the boundaries move outwards until at r = 1 the weight is 1
/// everywhere, so that the weight is continuous in the duty factor too.
inline double contact_weight(double phase, double contact_center, double duty_factor, double edge_cycle) noexcept {
  const double distance = std::abs(wrap_half_cycle(phase - contact_center));
  const double boundary = 0.5 * duty_factor + std::max(0.0, edge_cycle - 0.5 * (1.0 - duty_factor));
  const double inside = (boundary - distance) / edge_cycle;
  if (inside >= 1.0) return 1.0;
  if (inside <= 0.0) return 0.0;
  return 0.5 * (1.0 - std::cos(std::numbers::pi * inside));
}

/// How much of the swing is taken away because the robot stands: 0 while walking, 1 at rest, moving between the two
/// over a short time so that no foot is declared loaded from one tick to the next.
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
