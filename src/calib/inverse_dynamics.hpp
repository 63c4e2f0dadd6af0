// A joint's inertia and friction from its recorded drive output, and what negative ones mean.
#pragma once

#include <string>
#include <vector>

namespace pmg::calib {

/// torque_per_unit drive - load = armature ddq + viscous dq + coulomb(sign dq): the classic identification of rigid
/// drives (A. Janot, P.-O. Vandanjon, M. Gautier, "A Generic Instrumental Variable Approach for Industrial Robot
/// Identification", IEEE TCST 2014, with plain least squares). It needs no simulation, so the drive's timing cannot
/// bias it, but the drive's output must have been recorded. evidence::inverse_dynamics estimates it.
struct InverseDynamics {
  struct Estimate {
    double value = 0.0, deviation = 0.0;  ///< one standard deviation
  };
  Estimate armature_kg_m2;
  Estimate viscous_Nm_s_per_rad;
  Estimate coulomb_Nm;  ///< the mean of both directions
  Estimate offset_Nm;   ///< forward torque, as ActuatorParameters::Ripple's: half of backward minus forward friction
  double residual_Nm = 0.0;  ///< root mean square over windows of 0.2 s
  double unresolved = 0.0;   ///< rms of the drive about cubics through five samples, over its standard deviation
  double sample_rate_hz = 0.0;
  std::size_t windows = 0;

  double coulomb_forward_Nm() const { return coulomb_Nm.value - offset_Nm.value; }
  double coulomb_backward_Nm() const { return coulomb_Nm.value + offset_Nm.value; }
};

/// A negative inertia or friction.
struct ImpossibleEstimate {
  std::string what;          ///< "viscous friction"
  bool significant = false;  ///< below zero by more than two standard deviations
};

/// All negative estimates of inertia and friction.
std::vector<ImpossibleEstimate> impossible_estimates(const InverseDynamics& found);

/// True if no estimate is negative beyond its uncertainty. Numbers of a joint that can't be are shown to nobody.
bool possible(const InverseDynamics& found);

/// A sentence or two on the likely reason of negative estimates; empty if there are none.
std::string meaning_of_negative(const InverseDynamics& found);

}  // namespace pmg::calib
