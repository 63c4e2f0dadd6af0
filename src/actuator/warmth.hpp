// What temperature, heat and time make of friction and torque.
#pragma once

#include "actuator/gear_friction.hpp"
#include "model/actuator_parameters.hpp"

namespace pmg::actuator {

class Warmth {
 public:
  Warmth(const model::ActuatorParameters::Thermal& parameters, double step_s);

  void reset() noexcept;

  /// Sets the factors at this temperature, with the heat so far.
  void take(double temperature_C) noexcept;

  /// Heat and time go on by a step, in which the motor gave motor_Nm and friction dissipated friction_W; take()
  /// follows.
  void pass(double motor_Nm, double friction_W) noexcept;

  const GearFriction::Factors& friction() const noexcept { return friction_; }
  double torque() const noexcept { return torque_; }

 private:
  model::ActuatorParameters::Thermal parameters_;
  double step_s_;
  bool heats_;   // factors change although the temperature doesn't
  double kept_;  // of what has not yet faded, in a step
  double heat_Nm2_s_ = 0.0, work_J_ = 0.0, unfaded_ = 1.0;
  double temperature_C_ = model::kReferenceTemperature_C;
  GearFriction::Factors friction_;
  double torque_ = 1.0;
};

}  // namespace pmg::actuator
