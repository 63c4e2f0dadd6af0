// A joint's motion, estimated sample by sample from a recording alone, without a simulation.
#pragma once

#include <cstddef>
#include <vector>

#include "bench/bench.hpp"
#include "evidence/signature_options.hpp"

namespace pmg::evidence {

/// One value per sample of the recording.
struct Motion {
  std::vector<double> dq_rad_s, ddq_rad_s2;  ///< derivatives of a local parabola; NaN at the ends
  /// Output of the drive's law for the recorded error, clamp(kp e + kd de/dt + output for tau_ff) * supply (Nm
  /// for a position PD, volts for a servo), or the recorded torque. 0 while switched off; NaN where the law needs dq or
  /// the torque constant and lacks it.
  std::vector<double> drive;
  std::vector<bool> at_limit;        ///< the drive's output is saturated
  std::vector<double> gravity_Nm;    ///< gravity torque of the load, G sin(q - hangs_at)
  std::vector<double> since_step_s;  ///< time since the command last jumped; NaN before the first jump
  std::vector<std::size_t> steps;    ///< first sample after each jump of the command
};

/// The parabola is fitted to the samples within window_s / 2 on either side, at least two samples on either side.
Motion motion(const bench::Bench& bench, const bench::BenchRun& run, double window_s = 0.05,
              const StepOptions& steps = {});

/// Motion::drive and at_limit again, for other commands or drives: the derivatives stay.
void compute_drive(const bench::Bench& bench, const bench::BenchRun& run, Motion& motion);

/// (recording) => (samples at which the command jumps): it moves there by more than jump_ratio times its move in the
/// samples before and after, and by more than jump_share of its range.
std::vector<std::size_t> command_steps(const bench::Recording& recording, const StepOptions& options = {});

}  // namespace pmg::evidence
