// One joint's drive and transmission: from command and joint state to torque.
#pragma once

#include <array>

#include "sim/actuator_parameters.hpp"

namespace pmg::sim {

/// What the drive is told, and what it is fed with. Units as in ActuatorParameters.
struct ActuatorInput {
  double q_rad = 0.0, dq_rad_s = 0.0;
  double kp = 0.0, kd = 0.0;  ///< [unit of output per rad, per rad/s]
  double feed_forward = 0.0;  ///< [unit of output]
  double supply = 1.0;        ///< bus voltage of a voltage servo
  bool enabled = true;
  double temperature_C = kReferenceTemperature_C;  ///< of gear and winding
};

/// Torque at the joint as a line in the joint's speed: whoever integrates takes the slope implicitly,
/// dq' = dq + h torque / (I - h slope), as MuJoCo's `implicit` does with an actuator's velocity bias.
struct ActuatorTorque {
  double torque_Nm = 0.0;           ///< at the speed given
  double slope_Nm_s_per_rad = 0.0;  ///< d torque / d dq, never positive
};

/// No heap, no I/O; one object a joint. The joint's integrator is semi-implicit Euler with the same step.
class ActuatorModel {
 public:
  static constexpr int kDelaySteps = 128;  ///< the longest delay, in steps

  /// Throws std::invalid_argument when the delay doesn't fit or a value makes no sense.
  ActuatorModel(const ActuatorParameters& parameters, double step_s);

  /// At rest there. What was told before the first step is taken to be as its input, but commanded where the joint is.
  void reset(double q_rad) noexcept;

  /// At rest there while it holds load_Nm (of gravity: positive pulls q down): dry friction carries what the drive
  /// leaves of the load, as far as it can, and a shaft is wound by the load. Where friction can carry it, the input is
  /// taken to have been told for long; otherwise the input is taken for a step that comes now, as reset has it.
  void reset_at_rest(const ActuatorInput& input, double q_rad, double load_Nm) noexcept;

  /// The torque during the step that begins with the joint at (q, dq).
  ActuatorTorque step(const ActuatorInput& input, double q_rad, double dq_rad_s) noexcept;

  /// What the joint's own inertia grows by; a rotor behind a spring turns on its own.
  double joint_armature_kg_m2() const;

  /// What the drive reports for a joint that has come to q since the last step.
  double reading_rad(double q_rad) const;

  /// Where a joint is that rests in the middle of its sensor's hysteresis and is read so.
  static double joint_rad(const ActuatorParameters::Sensor& sensor, double reading_rad);

  /// What the drive itself gave at the beginning of the step, before friction and gear: what a drive's current tells.
  double drive_torque_Nm() const { return drive_Nm_; }

  const ActuatorParameters& parameters() const { return parameters_; }

 private:
  struct Line {  // torque in the motor's speed, as ActuatorTorque
    double torque_Nm, slope;
  };
  /// What the drive has been told, as it takes effect.
  struct Told {
    double q_rad, dq_rad_s, kp, kd, feed_forward;
  };
  Told delayed(const Told& now) noexcept;
  double limited(double q_command_rad) noexcept;
  double followed(double q_rad) const noexcept;
  double sensed(double q_rad) noexcept;
  double sensed_velocity(double dq_rad_s) noexcept;
  Line drive(const ActuatorInput& input, double q_rad, double dq_rad_s) noexcept;
  Line powered(const Told& told, double supply, double q_sensed_rad, double dq_sensed_rad_s, double dq_rad_s) noexcept;
  double sag(double full_Nm) const noexcept;
  double most_dry_friction_Nm(double dq_rad_s, double direction) const noexcept;
  Line dry_friction(double dq_rad_s) const noexcept;
  double ripple_Nm(double motor_rad) const noexcept;
  void warm(double temperature_C) noexcept;
  ActuatorTorque rigid(const Line& motor, double dq_rad_s) noexcept;
  ActuatorTorque elastic(const Line& motor, double q_rad, double dq_rad_s) noexcept;

  ActuatorParameters parameters_;
  double step_s_;
  bool elastic_, lagging_, velocity_lagging_, delaying_, rate_limited_, torque_speed_, load_dependent_, thermal_;

  std::array<Told, kDelaySteps + 2> past_{};
  int newest_ = 0;
  bool told_before_ = false;
  double command_rad_ = 0.0;  // after delay and rate limit
  double held_for_s_ = 0.0, held_output_ = 0.0;
  double lagged_rad_ = 0.0, sensed_before_rad_ = 0.0, lagged_rad_s_ = 0.0;
  double sensor_rad_ = 0.0;  // where the sensor's end of its play is
  double heat_Nm2_s_ = 0.0, drive_Nm_ = 0.0;
  double temperature_C_ = kReferenceTemperature_C;
  double friction_factor_ = 1.0, torque_factor_ = 1.0;
  double bristle_rad_ = 0.0;
  double load_Nm_ = 0.0;  // through the gear, as of the step before
  double rotor_rad_ = 0.0, rotor_rad_s_ = 0.0;
  // of the step before, to learn from the speed that came of it what the gear carried
  ActuatorTorque given_;
  double given_at_rad_s_ = 0.0;
};

}  // namespace pmg::sim
