// A joint with one form of an effect, as the parameters' table has its examples.
#pragma once

#include "calib/unknown.hpp"
#include "effects/catalogue.hpp"

namespace pmg::test {

inline double example(const std::string& parameter) {
  if (parameter == "load.inertia_scale") return 1.8;
  return parameter == "load.gravity_scale" ? 1.0 : model::actuator_parameter(parameter).example;
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

inline calib::JointModel with_effect(const effects::Effect& effect, const effects::Form& form) {
  calib::JointModel joint = without_effect(effect);
  for (const std::string& parameter : form.parameters) calib::set(joint, parameter, example(parameter));
  for (const effects::FixedValue& value : form.fixed) calib::set(joint, value.parameter, value.value);
  for (const effects::FixedValue& value : effect.demonstration.both) calib::set(joint, value.parameter, value.value);
  return joint;
}

}  // namespace pmg::test
