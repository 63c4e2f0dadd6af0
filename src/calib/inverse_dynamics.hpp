// Inverse-dynamics least squares: what inertia and friction explain the recorded drive of a moving joint.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/bench.hpp"

namespace pmg::calib {

/// torque_per_unit drive - load = armature ddq + viscous dq + coulomb(sign dq): the classic identification of rigid
/// drives (A. Janot, P.-O. Vandanjon, M. Gautier, "A Generic Instrumental Variable Approach for Industrial Robot
/// Identification", IEEE TCST 2014, with plain least squares). It needs no simulation, so nothing of a drive's timing
/// biases it, but the drive's output must have been recorded.
struct InverseDynamics {
  struct Estimate {
    double value = 0.0, deviation = 0.0;  ///< one standard deviation, as if the residual were noise
  };
  Estimate armature_kg_m2;
  Estimate viscous_Nm_s_per_rad;
  Estimate coulomb_Nm;  ///< the mean of both directions
  Estimate
      offset_Nm;  ///< that pushes forwards, as ActuatorParameters::Ripple's: half of backward minus forward friction
  double residual_Nm = 0.0;  ///< root mean square
  double unresolved = 0.0;   ///< what a window's cubic doesn't follow of the drive, over the drive's own deviation
  double sample_rate_hz = 0.0;
  std::size_t samples = 0;

  double coulomb_forward_Nm() const { return coulomb_Nm.value - offset_Nm.value; }
  double coulomb_backward_Nm() const { return coulomb_Nm.value + offset_Nm.value; }
};

/// Inertia or friction below zero, which no joint has.
struct ImpossibleEstimate {
  std::string what;          ///< "viscous friction"
  bool significant = false;  ///< beyond two standard deviations: not noise
};

/// Every number of it that is below zero.
std::vector<ImpossibleEstimate> impossible_estimates(const InverseDynamics& found);

/// What numbers below zero mean, in a sentence or two; empty where there is none.
std::string meaning_of_negative(const InverseDynamics& found);

/// Positions are differentiated by cubics over window_s to either side, which add no phase; torques are smoothed alike.
/// Nothing where no drive_V or torque is recorded, or torque_per_unit is unknown, or fewer than 100 windows move.
std::optional<InverseDynamics> inverse_dynamics(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs,
                                                double window_s = 0.004);

}  // namespace pmg::calib
