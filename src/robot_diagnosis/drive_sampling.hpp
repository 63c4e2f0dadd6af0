// When a drive takes its joint's position within a control tick, by the description of the backend that recorded.
#pragma once

#include <string>

namespace pmg::robot_diagnosis {

/// A drive that takes the position at the beginning of each of n steps holds its torque over the step. Over a tick its
/// torque is that at the mean of q at s = 0, 1/n, .. (n - 1)/n of the tick, q the cubic through the positions and
/// speeds of both ends: mean q = q0 + a (q1 - q0) + b T (dq0 - dq1) with a = mean s = (n - 1) / 2n and b = mean(s - 2
/// s^2 + s^3) = (n^2 - 1) / 12 n^2. An acceleration read with a state belongs to the step before it: the mean over a
/// tick is that of s = 1/n .. 1, at c = (n + 1) / 2n. A drive faster than the bus: n to infinity.
struct DriveSampling {
  double step_s = 0.0;       ///< 0: much faster than the control tick
  std::string known_from{};  ///< what says so, for people

  double position_share(double tick_s) const { return step_s > 0.0 ? 0.5 * (1.0 - step_s / tick_s) : 0.5; }
  double speed_share(double tick_s) const {
    const double step = step_s / tick_s;
    return (1.0 - step * step) / 12.0;
  }
  double acceleration_share(double tick_s) const { return 0.5 * (1.0 + step_s / tick_s); }
};

/// (ROBOT_INFO's backend, its options as JSON) => (drive sampling): options' drive_sampling_s; in logs without it the
/// simulated drive's 2 ms where the backend is sil; else unknown, assumed to be much faster than the tick.
DriveSampling drive_sampling(const std::string& backend, const std::string& options);

std::string drive_sampling_text(const DriveSampling& sampling);

}  // namespace pmg::robot_diagnosis
