// When a drive samples its joint's position within a control tick, as the recording backend describes it.
#pragma once

#include <string>

namespace pmg::robot_diagnosis {

/// A drive samples the position at the beginning of each of n steps per tick T and holds its torque over the step. Its
/// mean torque over a tick is the torque at the mean of q(s), s = 0, 1/n, .. (n - 1)/n, with q the cubic through the
/// positions and speeds at both ends: mean q = q0 + a (q1 - q0) + b T (dq0 - dq1), a = mean s = (n - 1) / 2n and
/// b = mean(s - 2 s^2 + s^3) = (n^2 - 1) / 12 n^2. An acceleration that is read with a state belongs to the step before
/// it: the mean over a tick is over s = 1/n .. 1, at c = (n + 1) / 2n. For a drive faster than the bus n is infinite.
struct DriveSampling {
  double step_s = 0.0;       ///< 0: much faster than the control tick
  std::string known_from{};  ///< source of step_s, for people

  double position_share(double tick_s) const { return step_s > 0.0 ? 0.5 * (1.0 - step_s / tick_s) : 0.5; }
  double speed_share(double tick_s) const {
    const double step = step_s / tick_s;
    return (1.0 - step * step) / 12.0;
  }
  double acceleration_share(double tick_s) const { return 0.5 * (1.0 + step_s / tick_s); }
};

/// (ROBOT_INFO's backend, its options as JSON) => (drive sampling): the options' drive_sampling_s; without it, the 2 ms
/// of the simulated drive for the backend sil; else unknown and assumed to be much faster than the tick.
DriveSampling drive_sampling(const std::string& backend, const std::string& options);

std::string drive_sampling_text(const DriveSampling& sampling);

}  // namespace pmg::robot_diagnosis
