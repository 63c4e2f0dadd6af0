#include "control/fallback_reference.hpp"

#include <algorithm>

namespace pmg::control {

void FallbackReference::start(const Reference& last, const Command& observed, const JointVector& squat_rad,
                              double height_m) noexcept {
  last_ = reference_ = last;
  last_observed_ = observed_ = observed;
  way_rad_ = squat_rad - last.q;
  height_m_ = height_m;
  elapsed_s_ = 0.0;
  active_ = true;
  reference_.phase_rate_per_s = 0.0;
  reference_.duty_factor.fill(1.0);
  reference_.contact.fill(true);
  reference_.contact_weight.fill(1.0);
  reference_.command_rate = Command{};
}

const Reference& FallbackReference::advance(double dt_s) noexcept {
  elapsed_s_ += dt_s;
  const double t = std::min(1.0, elapsed_s_ / duration_s_);
  const double share = t * t * (3.0 - 2.0 * t);
  reference_.q = last_.q + share * way_rad_;
  reference_.dq = (6.0 * t * (1.0 - t) / duration_s_) * way_rad_;
  reference_.gain = (1.0 - share) * last_.gain;
  for (std::size_t i = 0; i < observed_.u.size(); ++i) {
    reference_.command.u[i] = (1.0 - share) * last_.command.u[i];
    observed_.u[i] = (1.0 - share) * last_observed_.u[i];
  }
  reference_.command[kHeight] += share * height_m_;
  observed_[kHeight] += share * height_m_;
  return reference_;
}

}  // namespace pmg::control
