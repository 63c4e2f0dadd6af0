// One joint's drive and transmission: (command, joint state) => (torque).
#pragma once

#include "actuator/actuator_input.hpp"
#include "actuator/angle_sensor.hpp"
#include "actuator/command_path.hpp"
#include "actuator/control_law.hpp"
#include "actuator/gear_friction.hpp"
#include "actuator/motor_torque.hpp"
#include "actuator/residual_action.hpp"
#include "actuator/shaft.hpp"
#include "actuator/warmth.hpp"
#include "model/actuator_parameters.hpp"

namespace pmg::sim {

using actuator::ActuatorInput;

/// Torque at the joint as a line in the joint's speed. The integrator takes the slope implicitly, as MuJoCo's
/// `implicit` does with an actuator's velocity bias:
///   dq' = dq + h torque / (I - h slope).
struct ActuatorTorque {
  double torque_Nm = 0.0;           ///< at the given speed
  double slope_Nm_s_per_rad = 0.0;  ///< d torque / d dq, never positive
};

/// No heap, no I/O; one object per joint. The joint's integrator is semi-implicit Euler with the same step.
class ActuatorModel {
 public:
  static constexpr int kDelaySteps = actuator::DelayLine<double>::kSteps;  ///< the longest delay, in steps

  /// Throws std::invalid_argument if a delay is longer than kDelaySteps or a value makes no sense.
  ActuatorModel(const model::ActuatorParameters& parameters, double step_s);

  /// At rest at q_rad. Commands before the first step count as equal to its input, but with the joint's reading as
  /// position.
  void reset(double q_rad) noexcept;

  /// At rest at q_rad under load_Nm (gravity; positive pulls q down). Dry friction carries the difference between load
  /// and drive torque, up to its limit; the load winds an elastic shaft. If friction can carry the difference, the
  /// input counts as in force for a long time; otherwise it counts as a step that comes now, as after reset().
  /// slack_rad: how far the motor is ahead within the play of a shaft that carries nothing.
  void reset_at_rest(const ActuatorInput& input, double q_rad, double load_Nm, double slack_rad = 0.0) noexcept;

  /// (input, q, dq) => (torque during the step that begins at (q, dq)).
  ActuatorTorque step(const ActuatorInput& input, double q_rad, double dq_rad_s) noexcept;

  /// Rotor inertia that adds to the joint's own; 0 with an elastic transmission, whose rotor has its own speed.
  double joint_armature_kg_m2() const;

  /// The drive's reading [rad] of a joint that has moved to q since the last step, or only for that share of it. With
  /// s = q behind the hysteresis:
  ///   quantised(s + zero_offset + eccentricity sin(order s + phase) + ellipticity sin(2 s + its phase)),
  /// as it was delay_s ago.
  double reading_rad(double q_rad, double share_of_step = 1.0) const;

  /// Inverse of reading_rad without quantum, for a joint that has stood for long in the middle of the sensor's
  /// hysteresis while its transmission carried load_Nm [rad].
  static double joint_rad(const model::ActuatorParameters& parameters, double reading_rad, double load_Nm);

  /// Torque of the drive itself at the beginning of the step, before friction and gear: a drive derives it from its
  /// current, with the torque constant that it believes in.
  double drive_torque_Nm() const { return motor_.believed_Nm(drive_Nm_ - offset_Nm_); }

  const model::ActuatorParameters& parameters() const { return parameters_; }

  /// The residual torque in the last step.
  const actuator::ResidualAction& residual() const { return residual_; }

 private:
  double sensed_rad(double q_rad) const noexcept;
  void wind(double q_rad, double load_Nm, double slack_rad) noexcept;
  actuator::TorqueLine drive(const ActuatorInput& input, double q_rad, double dq_rad_s, bool rests) noexcept;
  actuator::TorqueLine ripple(double motor_rad, const actuator::TorqueLine& driven) const noexcept;
  actuator::ResidualSeen seen_by_residual(const ActuatorInput& input, double drive_Nm, double motor_rad,
                                          double motor_rad_s) const noexcept;
  void rub_more() noexcept;
  actuator::TorqueLine rubbed_on_joint(actuator::TorqueLine motor, actuator::TorqueLine friction, double load_Nm,
                                       double q_rad, double dq_rad_s) noexcept;
  double friction_load_Nm(double motor_Nm, double external_Nm) const noexcept;

  model::ActuatorParameters parameters_;
  double step_s_, armature_per_step_;
  bool elastic_, load_dependent_, thermal_;
  double sensor_turns_;  // share of the motor's turn in the sensor's, beyond the joint's

  actuator::CommandPath command_;
  actuator::AngleSensor sensor_;
  actuator::ControlLaw law_;
  actuator::MotorTorque motor_;
  actuator::GearFriction motor_friction_, joint_friction_;
  actuator::Shaft shaft_;
  actuator::Warmth warmth_;
  actuator::ResidualAction residual_;
  double drive_Nm_ = 0.0, offset_Nm_ = 0.0;  // with the offset, and the offset as long as the drive is on
  // Of the drive, in this step; followed only where a residual torque acts, who alone reads them.
  double command_rad_ = 0.0, error_rad_ = 0.0, output_ = 0.0;
  double transmitted_Nm_ = 0.0;  // through the gear, in the step before
  // of the step before: with the speed that resulted, they give the torque through the gear
  ActuatorTorque given_;
  double given_at_rad_s_ = 0.0;
};

}  // namespace pmg::sim
