#include "control/entry_ramp.hpp"

#include <algorithm>

namespace pmg::control {

void EntryRamp::start(const JointVector& measured_rad, const JointVector& wanted_rad) noexcept {
  from_ = measured_rad;
  elapsed_s_ = 0.0;
  const double farthest_rad = (wanted_rad - measured_rad).cwiseAbs().maxCoeff();
  duration_s_ = std::clamp(farthest_rad / options_.speed_rad_s, options_.shortest_s, options_.longest_s);
}

void EntryRamp::apply(double dt_s, JointVector& q_des) noexcept {
  if (done()) return;
  elapsed_s_ += dt_s;
  const double t = std::min(elapsed_s_ / duration_s_, 1.0);
  const double share = t * t * (3.0 - 2.0 * t);  // starts and ends without a jump in speed
  q_des = from_ + share * (q_des - from_);
}

}  // namespace pmg::control
