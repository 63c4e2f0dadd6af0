// A joint with one form of an effect, as the parameters' table has its examples.
#pragma once

#include <map>
#include <string>

#include "calib/unknown.hpp"
#include "effects/catalogue.hpp"

namespace pmg::test {

inline double example(const std::string& parameter) {
  const std::map<std::string, double> of_recordings = {{calib::kInertia, 1.8},      {calib::kGravity, 1.0},
                                                       {calib::kMoreInertia, 0.02}, {calib::kMoreGravity, 0.5},
                                                       {calib::kZeroSlip, -0.1},    {calib::kZeroSlipAt, 0.0}};
  const auto found = of_recordings.find(parameter);
  return found != of_recordings.end() ? found->second : model::actuator_parameter(parameter).example;
}

/// The joint beside which the effect shows best.
inline calib::JointModel without_effect(const effects::Effect& effect) {
  calib::JointModel joint;
  joint.actuator.transmission.armature_kg_m2 = 0.01;
  joint.actuator.friction.coulomb_Nm = 0.03;
  joint.actuator.friction.viscous_Nm_s_per_rad = 0.05;
  for (const effects::FixedValue& value : effect.demonstration.both) calib::set(joint, value.parameter, value.value);
  return joint;
}

/// After the last recording: a zero has slipped.
inline calib::JointModel with_effect(const effects::Effect& effect, const effects::Form& form) {
  calib::JointModel joint = without_effect(effect);
  for (const std::string& parameter : form.parameters) calib::set(joint, parameter, example(parameter));
  for (const effects::FixedValue& value : form.fixed) calib::set(joint, value.parameter, value.value);
  for (const effects::FixedValue& value : effect.demonstration.both) calib::set(joint, value.parameter, value.value);
  return calib::after_the_slip(joint);
}

}  // namespace pmg::test
