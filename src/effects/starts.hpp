// What the start values of effects are made of.
#pragma once

#include <initializer_list>
#include <vector>

#include "effects/catalogue.hpp"
#include "effects/unknowns.hpp"

namespace pmg::effects {

/// The joint without the effect, and the sizes of its runs.
struct NominalJoint {
  const model::ActuatorParameters& actuator;
  const BenchScale& scale;
  double torque = scale.torque_Nm, peak = scale.torque_peak_Nm, speed = scale.speed_rad_s;
  bool servo = scale.law == bench::DriveLaw::kServoVoltage;
  bool closes_loop = scale.law != bench::DriveLaw::kTorque;  ///< the drive has a position loop of its own
};

/// (form of an effect, model to extend, scale) => (its start values).
Starts starts(const Form& form, const calib::JointModel& current, const BenchScale& scale);

/// Starts of one parameter: factor times each share.
template <typename... Share>
Starts each(double factor, Share... shares) {
  return {std::vector<double>{factor * shares}...};
}

/// Starts of a parameter that can't be negative: its value in the model, plus factor times each share.
Starts each_from(double present, double factor, std::initializer_list<double> shares);

/// Starts of two parameters: each of the first with each of the second.
Starts pairs(std::initializer_list<double> first, double first_factor, std::initializer_list<double> second,
             double second_factor);

/// The same starts with one more value, of the last parameter.
Starts followed_by(double last, Starts values);

/// The starts, or none.
Starts only_if(bool possible, Starts values);

/// Stiffness and damping of shafts that bend by 0.005 to 0.06 rad under the peak torque, their ringing damped by a
/// tenth.
Starts shafts(const NominalJoint& joint);

/// Stiffness, damping and hardening: a hardening spring begins softer and carries half of the peak torque by its cube.
Starts hardening_shafts(const NominalJoint& joint);

/// Play, stiffness and damping of shafts that bend by so much.
Starts plays(const NominalJoint& joint, std::initializer_list<double> bends_rad);

/// Amplitude, order and phase of waves over the joint's angle, their orders so many periods over the range apart.
Starts waves(const NominalJoint& joint, double amplitude, double periods, double highest_order);

/// Only voltage drives, which have back-EMF, feel the bus; the others regulate their current. A recorded bus voltage is
/// an input that already contains the sag.
bool feels_bus(const NominalJoint& joint);

}  // namespace pmg::effects
