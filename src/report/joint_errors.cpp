#include "report/joint_errors.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::report {

void JointErrors::state(double t_s, const std::vector<double>& q_rad, const std::vector<double>& torque_Nm) {
  end_tick();
  state_s_ = t_s;
  q_rad_ = q_rad;
  square_sum_.resize(q_rad.size());
  ticks_.resize(q_rad.size());
  torque_max_Nm_.resize(q_rad.size());
  for (std::size_t joint = 0; joint < torque_Nm.size(); ++joint) {
    const double most_Nm = std::abs(torque_Nm[joint]);
    if (most_Nm > torque_max_Nm_[joint]) torque_max_Nm_[joint] = most_Nm;
  }
}

void JointErrors::reference(double t_s, const std::vector<double>& q_ref_rad) {
  reference_s_ = t_s;
  q_ref_rad_ = q_ref_rad;
}

void JointErrors::status(bool holds) {
  if (!has_status_) {  // what came before it is not known to be followed
    std::ranges::fill(square_sum_, 0.0);
    std::ranges::fill(ticks_, 0);
  }
  has_status_ = true;
  holds_ = holds;
  end_tick();
}

/// A tick's messages come as STATE, REFERENCE, STATUS.
void JointErrors::end_tick() {
  if (state_s_ != reference_s_) return;
  reference_s_ = -2.0;
  if (!holds_) return;
  for (std::size_t joint = 0; joint < q_rad_.size(); ++joint) {
    const double error_rad = q_ref_rad_[joint] - q_rad_[joint];
    if (!std::isfinite(error_rad)) continue;
    square_sum_[joint] += error_rad * error_rad;
    ++ticks_[joint];
  }
}

std::vector<JointTracking> JointErrors::finish(std::size_t joints) {
  end_tick();
  std::vector<JointTracking> tracking(joints);
  for (std::size_t joint = 0; joint < std::min(joints, square_sum_.size()); ++joint) {
    tracking[joint].torque_max_Nm = torque_max_Nm_[joint];
    if (ticks_[joint] > 0)
      tracking[joint].error_rms_rad = std::sqrt(square_sum_[joint] / static_cast<double>(ticks_[joint]));
  }
  return tracking;
}

}  // namespace pmg::report
