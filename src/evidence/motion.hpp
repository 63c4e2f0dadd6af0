// What a recording alone says of a joint's motion, sample by sample: no simulation is asked.
#pragma once

#include <cstddef>
#include <vector>

#include "bench/bench.hpp"

namespace pmg::evidence {

/// Columns as long as the recording.
struct Motion {
  std::vector<double> dq_rad_s, ddq_rad_s2;  ///< of a local parabola; NaN at the ends
  /// What the drive's law makes of the recorded error, in the drive's unit times supply (Nm of a position PD, volts of
  /// a servo), or the recorded torque; 0 while switched off. NaN where dq is needed and missing.
  std::vector<double> drive;
  std::vector<bool> at_limit;        ///< the drive gives all it has
  std::vector<double> gravity_Nm;    ///< torque that holds the load there
  std::vector<double> since_step_s;  ///< since the command last jumped; NaN before the first jump
  std::vector<std::size_t> steps;    ///< samples at which the command has just jumped
};

/// window_s: the parabola is fitted to the samples within half of it on either side, to two on either side at least.
Motion motion(const bench::Bench& bench, const bench::BenchRun& run, double window_s = 0.05);

/// Samples whose command is farther from the one before than from anything that the neighbouring samples' commands do.
std::vector<std::size_t> command_steps(const bench::Recording& recording);

}  // namespace pmg::evidence
