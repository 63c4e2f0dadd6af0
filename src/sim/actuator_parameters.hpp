// What one joint's drive and transmission do, as numbers: each group is one kind of effect and neutral by default.
#pragma once

#include <limits>
#include <span>
#include <string_view>

namespace pmg::sim {

constexpr double kReferenceTemperature_C = 25.0;  ///< at which friction and torque are as their parameters say

/// Names are those of a turning joint; on a linear axis read m for rad, N for Nm, kg for kg m^2. The drive's output has
/// the drive's own unit: torque [Nm] of a position PD, duty [-1, 1] of a voltage servo, volts of a cascade.
struct ActuatorParameters {
  /// What happens to a command before the drive compares it with its sensor.
  struct Command {
    double delay_s = 0.0;  ///< of positions, speeds, gains and feed-forward; switching off is immediate
    double rate_limit_rad_s = std::numeric_limits<double>::infinity();  ///< of the position command
    double hold_s = 0.0;                                                ///< period of the drive's own loop
    bool operator==(const Command&) const = default;
  } command;

  /// output = clip(kp e + kd de + feed-forward, +-limit); torque = torque_per_unit (output supply - back_emf dq).
  struct Drive {
    double kp_scale = 1.0, kd_scale = 1.0;  ///< what a gain really is over what it is called
    double limit = std::numeric_limits<double>::infinity();
    double dead_band_rad = 0.0;       ///< position errors below it give no output
    double torque_per_unit_Nm = 1.0;  ///< per unit of output times supply
    double back_emf_s_per_rad = 0.0;  ///< [output times supply per rad/s]
    /// Of a voltage servo: share of the supply lost to its source per Nm at full duty (output at its limit). A bridge
    /// takes duty times the motor's current from the bus.
    double supply_sag_per_Nm = 0.0;
    double brake_when_disabled = 0.0;  ///< share of the back-EMF torque that stays when the drive is switched off
    double stall_torque_Nm = std::numeric_limits<double>::infinity();  ///< torque-speed line: at rest
    double no_load_rad_s = std::numeric_limits<double>::infinity();    ///< and where none is left
    bool operator==(const Drive&) const = default;
  } drive;

  /// What the drive believes of its joint.
  struct Sensor {
    double zero_offset_rad = 0.0;   ///< reading minus truth
    double hysteresis_rad = 0.0;    ///< play between joint and sensor, from end to end: the reading waits at a reversal
    double eccentricity_rad = 0.0;  ///< of the sensor's disc or magnet: reads eccentricity sin(q + phase) too much
    double eccentricity_phase_rad = 0.0;
    double quantum_rad = 0.0;
    double lag_s = 0.0;           ///< of the position, first order
    double velocity_lag_s = 0.0;  ///< of the velocity beyond that of the position, first order
    bool operator==(const Sensor&) const = default;
  } sensor;

  /// Between motor and joint. Without stiffness the transmission is rigid.
  struct Transmission {
    double armature_kg_m2 = 0.0;  ///< rotor inertia seen at the joint
    double stiffness_Nm_per_rad = std::numeric_limits<double>::infinity();
    double damping_Nm_s_per_rad = 0.0;  ///< of the shaft; needs a stiffness
    double backlash_rad = 0.0;          ///< free play from end to end; needs a stiffness
    bool operator==(const Transmission&) const = default;
  } transmission;

  /// Torque against motion: viscous_Nm_s_per_rad |dq| plus a dry part, which is a bristle that bends by presliding_rad
  /// and then slides (Dahl's model with a corner), so that a joint at rest stays at rest:
  /// coulomb + stribeck exp(-(dq/stribeck_rad_s)^2) + (load_driving or load_backdriving) |torque through the gear|.
  /// stribeck_Nm is negative where friction grows with speed and levels off, as in greased gears.
  struct Friction {
    double viscous_Nm_s_per_rad = 0.0;
    double coulomb_Nm = 0.0;
    double stribeck_Nm = 0.0;
    double stribeck_rad_s = 0.1;
    double load_driving = 0.0;      ///< the motor moves the load
    double load_backdriving = 0.0;  ///< the load moves the motor
    double asymmetry = 0.0;         ///< dry friction is (1 + asymmetry) forwards, (1 - asymmetry) backwards
    double presliding_rad = 1e-3;
    bool operator==(const Friction&) const = default;
  } friction;

  /// What warming up does. Friction, as at 25 degC, times exp(share of it): it follows the temperature (lubricants thin
  /// exponentially) and, where none is known, the heat that the drive has put into its winding since the start, the
  /// integral of torque^2 less what has cooled away. Torque per unit of output times 1 + torque_per_K (T - 25 degC), as
  /// data sheets give it for magnets and copper.
  struct Thermal {
    double friction_per_K = 0.0;  ///< negative: a warm gear turns easily
    double torque_per_K = 0.0;
    double friction_per_Nm2_s = 0.0;
    double cooling_s = std::numeric_limits<double>::infinity();  ///< time constant of that heat
    bool operator==(const Thermal&) const = default;
  } thermal;

  /// Torque that depends on the joint's angle: amplitude sin(order q + phase), and a constant one.
  struct Ripple {
    double amplitude_Nm = 0.0;
    double order = 1.0;
    double phase_rad = 0.0;
    double offset_Nm = 0.0;
    bool operator==(const Ripple&) const = default;
  } ripple;

  bool operator==(const ActuatorParameters&) const = default;
};

/// One number of ActuatorParameters: its place in motor.yaml, and the range in which a fit may look for it.
struct ActuatorParameter {
  std::string_view name;  ///< "friction.coulomb_Nm": group and key
  std::string_view unit;
  double lower, upper;  ///< of a search; a file may say more
  bool may_be_negative;
  double& (*in)(ActuatorParameters&);
  std::string_view group() const { return name.substr(0, name.find('.')); }
  std::string_view key() const { return name.substr(name.find('.') + 1); }
  double value(const ActuatorParameters& parameters) const { return in(const_cast<ActuatorParameters&>(parameters)); }
};

/// Every number there is, in the order of motor.yaml. A further effect is a group above and its rows here.
std::span<const ActuatorParameter> actuator_parameters();

/// Throws std::invalid_argument that lists the names when there is no such parameter.
const ActuatorParameter& actuator_parameter(std::string_view name);

}  // namespace pmg::sim
