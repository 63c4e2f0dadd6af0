// From the drive's output to the motor's torque: how late and how fast the output changes, what the supply gives,
// what the motor makes of it, and the limits of torque, speed and power.
#pragma once

#include "actuator/control_law.hpp"
#include "actuator/delay_line.hpp"
#include "actuator/torque_line.hpp"
#include "model/actuator_parameters.hpp"

namespace pmg::actuator {

class MotorTorque {
 public:
  MotorTorque(const model::ActuatorParameters::Drive& parameters, double step_s);

  void reset() noexcept;

  /// Whether there must be an output from before the first step: settle() gives it.
  bool needs_past() const noexcept { return (delays_ || output_rate_limited_) && !given_before_; }

  /// As if this had been the output for a long time.
  void settle(double output) noexcept;

  /// (output, bus voltage of a voltage servo, the motor's speed, thermal factor) => torque of the motor by its speed.
  TorqueLine step(const ControlLaw::Output& output, double supply, double dq_rad_s, double torque_factor) noexcept {
    if (!plain_) return stepped(output, supply, dq_rad_s, torque_factor);
    const double per_unit_Nm = unit_Nm_ * torque_factor, scale = per_unit_Nm * supply;
    const double emf_Nm_s_per_rad = per_unit_Nm * parameters_.back_emf_s_per_rad;
    return {scale * output.value - emf_Nm_s_per_rad * dq_rad_s, -emf_Nm_s_per_rad - scale * output.speed_gain};
  }

  /// The same of a drive that is switched off.
  TorqueLine idle(double dq_rad_s, double torque_factor) noexcept;

  /// The torque that a drive derives from its current when its motor gives torque_Nm.
  double believed_Nm(double torque_Nm) const noexcept;

 private:
  TorqueLine stepped(ControlLaw::Output output, double supply, double dq_rad_s, double torque_factor) noexcept;
  ControlLaw::Output late(ControlLaw::Output output) noexcept;
  TorqueLine limited(TorqueLine motor, double duty, double full_Nm, double dq_rad_s) const noexcept;

  model::ActuatorParameters::Drive parameters_;
  double step_s_, delay_steps_;
  double unit_Nm_;  // per unit of output times supply, at the reference temperature
  bool delays_, output_rate_limited_, sags_, sags_slowly_;
  bool supply_limited_, power_limited_, speed_cut_, limits_, plain_;
  DelayLine<double> past_;
  bool given_before_ = false;
  double given_ = 0.0;
  double bus_lost_ = 0.0;  // share of the supply that its capacitance has lost
};

}  // namespace pmg::actuator
