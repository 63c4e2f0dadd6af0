// Smooths the palm poses that an operator sends: no jump, no endless creeping.
#pragma once

#include "arms/palm.hpp"

namespace pmg::arms {

struct PoseFilterOptions {
  double time_constant_s = 0.05;  ///< of a first-order low-pass: headsets' poses come at 60 to 90 Hz, and tremble
  double speed_m_s = 1.0;         ///< bound on the filtered palm's speed
  double turn_rad_s = 4.0;        ///< and on its rate of turn
};

/// p += min(1 - exp(-dt / tau), speed dt / |p* - p|) (p* - p), likewise for the rotation vector to R*. Arrives exactly.
class PoseFilter {
 public:
  PoseFilter(const PoseFilterOptions& options, double dt_s);

  void start(const PalmPose& pose) noexcept { pose_ = pose; }
  const PalmPose& step(const PalmPose& wanted) noexcept;  ///< one tick towards it
  const PalmPose& pose() const noexcept { return pose_; }

 private:
  double share_, step_m_, step_rad_;
  PalmPose pose_;
};

}  // namespace pmg::arms
