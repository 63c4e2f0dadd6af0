// One joint's drive and transmission: (command, joint state) => (torque).
#pragma once

#include <array>

#include "model/actuator_parameters.hpp"

namespace pmg::sim {

/// The drive's command and supply. Units as in ActuatorParameters.
struct ActuatorInput {
  double q_rad = 0.0, dq_rad_s = 0.0;
  double kp = 0.0, kd = 0.0;     ///< [unit of output per rad, per rad/s]
  double feed_forward_Nm = 0.0;  ///< torque under every drive law; the drive converts it to its own output
  double supply = 1.0;           ///< bus voltage of a voltage servo
  bool enabled = true;
  double temperature_C = model::kReferenceTemperature_C;  ///< of gear and winding
};

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
  static constexpr int kDelaySteps = 512;  ///< the longest delay, in steps: 64 ms of the finest, 0.125 ms

  /// Throws std::invalid_argument if the delay is longer than kDelaySteps or a value makes no sense.
  ActuatorModel(const model::ActuatorParameters& parameters, double step_s);

  /// At rest at q_rad. Commands before the first step count as equal to its input, but with the joint's reading as
  /// position.
  void reset(double q_rad) noexcept;

  /// At rest at q_rad under load_Nm (gravity; positive pulls q down). Dry friction carries the difference between load
  /// and drive torque, up to its limit; the load winds an elastic shaft. If friction can carry the difference, the
  /// input counts as in force for a long time; otherwise it counts as a step that comes now, as after reset().
  void reset_at_rest(const ActuatorInput& input, double q_rad, double load_Nm) noexcept;

  /// (input, q, dq) => (torque during the step that begins at (q, dq)).
  ActuatorTorque step(const ActuatorInput& input, double q_rad, double dq_rad_s) noexcept;

  /// Rotor inertia that adds to the joint's own; 0 with an elastic transmission, whose rotor has its own speed.
  double joint_armature_kg_m2() const;

  /// The drive's reading [rad] of a joint that has moved to q since the last step, with s = q behind the hysteresis:
  ///   quantised(s + zero_offset + eccentricity sin(s + phase)).
  double reading_rad(double q_rad) const;

  /// Inverse of reading_rad without quantum, for a joint in the middle of the sensor's hysteresis [rad].
  static double joint_rad(const model::ActuatorParameters::Sensor& sensor, double reading_rad);

  /// Torque of the drive itself at the beginning of the step, before friction and gear: a drive derives it from its
  /// current.
  double drive_torque_Nm() const { return drive_Nm_; }

  const model::ActuatorParameters& parameters() const { return parameters_; }

 private:
  struct Line {  // torque as a line in the motor's speed, see ActuatorTorque
    double torque_Nm, slope;
  };
  /// The drive's command after its delay.
  struct Told {
    double q_rad, dq_rad_s, kp, kd, feed_forward_Nm;
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
  ActuatorTorque elastic(const Line& motor, double q_rad, double dq_rad_s) noexcept;

  model::ActuatorParameters parameters_;
  double step_s_;
  bool elastic_, lagging_, velocity_lagging_, delaying_, rate_limited_, torque_speed_, load_dependent_, thermal_;

  std::array<Told, kDelaySteps + 2> past_{};
  int newest_ = 0;
  bool told_before_ = false;
  double command_rad_ = 0.0;  // after delay and rate limit
  double held_for_s_ = 0.0, held_output_ = 0.0;
  double lagged_rad_ = 0.0, sensed_before_rad_ = 0.0, lagged_rad_s_ = 0.0;
  double sensor_rad_ = 0.0;  // angle of the sensor's side of its play
  double heat_Nm2_s_ = 0.0, drive_Nm_ = 0.0;
  double temperature_C_ = model::kReferenceTemperature_C;
  double friction_factor_ = 1.0, torque_factor_ = 1.0;
  double bristle_rad_ = 0.0;
  double load_Nm_ = 0.0;  // through the gear, in the step before
  double rotor_rad_ = 0.0, rotor_rad_s_ = 0.0;
  // of the step before: with the speed that resulted, they give the torque through the gear
  ActuatorTorque given_;
  double given_at_rad_s_ = 0.0;
};

}  // namespace pmg::sim
