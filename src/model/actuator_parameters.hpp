// Parameters of one joint's drive and transmission. Each group is one kind of effect and neutral by default.
#pragma once

#include <limits>
#include <span>
#include <string_view>

namespace pmg::model {

constexpr double kReferenceTemperature_C = 25.0;  ///< reference of friction and torque parameters

/// Names are those of a turning joint; on a linear axis read m for rad, N for Nm, kg for kg m^2. The drive's output has
/// its own unit: torque [Nm] for a position PD, duty [-1, 1] for a voltage servo, volts for a cascade.
struct ActuatorParameters {
  /// Effects on a command before the drive compares it with its sensor.
  struct Command {
    double delay_s = 0.0;  ///< of positions, speeds, gains and feed-forward; switching off is immediate
    double rate_limit_rad_s = std::numeric_limits<double>::infinity();  ///< of the position command
    double hold_s = 0.0;                                                ///< period of the drive's own loop
    bool operator==(const Command&) const = default;
  } command;

  /// output = clip(kp e + kd de + feed-forward torque / (torque_per_unit supply), +-limit);
  /// torque = torque_per_unit (output supply - back_emf dq).
  struct Drive {
    double kp_scale = 1.0, kd_scale = 1.0;  ///< real gain over nominal gain
    double limit = std::numeric_limits<double>::infinity();
    double dead_band_rad = 0.0;       ///< position errors below it give no output
    double torque_per_unit_Nm = 1.0;  ///< per unit of output times supply
    double back_emf_s_per_rad = 0.0;  ///< [output times supply per rad/s]
    /// Voltage servo: share of the supply that its source loses per Nm at full duty (output at its limit). A bridge
    /// takes duty times the motor's current from the bus.
    double supply_sag_per_Nm = 0.0;
    double brake_when_disabled = 0.0;  ///< share of the back-EMF torque that stays when the drive is switched off
    double stall_torque_Nm = std::numeric_limits<double>::infinity();  ///< torque-speed line: torque at rest
    double no_load_rad_s = std::numeric_limits<double>::infinity();    ///< torque-speed line: speed without torque
    bool operator==(const Drive&) const = default;
  } drive;

  /// Errors of the drive's measurement of its joint.
  struct Sensor {
    double zero_offset_rad = 0.0;   ///< reading minus true angle
    double hysteresis_rad = 0.0;    ///< play between joint and sensor, end to end: the reading waits at a reversal
    double eccentricity_rad = 0.0;  ///< of the sensor's disc or magnet: adds eccentricity sin(q + phase) to the reading
    double eccentricity_phase_rad = 0.0;
    double quantum_rad = 0.0;
    double lag_s = 0.0;           ///< of the position, first order
    double velocity_lag_s = 0.0;  ///< of the velocity, in addition to the position's; first order
    bool operator==(const Sensor&) const = default;
  } sensor;

  /// Between motor and joint. With infinite stiffness the transmission is rigid.
  struct Transmission {
    double armature_kg_m2 = 0.0;  ///< rotor inertia seen at the joint
    double stiffness_Nm_per_rad = std::numeric_limits<double>::infinity();
    double damping_Nm_s_per_rad = 0.0;  ///< of the shaft; needs a stiffness
    double backlash_rad = 0.0;          ///< free play from end to end; needs a stiffness
    bool operator==(const Transmission&) const = default;
  } transmission;

  /// Torque against the motion: viscous_Nm_s_per_rad |dq| plus a dry part,
  ///   coulomb + stribeck exp(-(dq/stribeck_rad_s)^2) + (load_driving or load_backdriving) |torque through the gear|.
  /// The dry part is a bristle that bends by presliding_rad and then slides (Dahl's model with a corner), so a joint at
  /// rest stays at rest. stribeck_Nm is negative if friction grows with speed and levels off, as in greased gears.
  struct Friction {
    double viscous_Nm_s_per_rad = 0.0;
    double coulomb_Nm = 0.0;
    double stribeck_Nm = 0.0;
    double stribeck_rad_s = 0.1;
    double load_driving = 0.0;      ///< the motor moves the load
    double load_backdriving = 0.0;  ///< the load moves the motor
    double asymmetry = 0.0;         ///< dry friction times (1 + asymmetry) forwards, (1 - asymmetry) backwards
    double presliding_rad = 1e-3;
    bool operator==(const Friction&) const = default;
  } friction;

  /// Effects of temperature T and of heat H. Friction is multiplied by
  ///   exp(friction_per_K (T - 25 degC) + friction_per_Nm2_s H),
  /// because lubricants thin exponentially. H is the heat that the drive's torque has put into its winding since the
  /// start, dH/dt = torque^2 - H / cooling_s; it serves where no temperature is known. Torque per unit of output is
  /// multiplied by 1 + torque_per_K (T - 25 degC), as data sheets give it for magnets and copper.
  struct Thermal {
    double friction_per_K = 0.0;  ///< negative: a warm gear turns more easily
    double torque_per_K = 0.0;
    double friction_per_Nm2_s = 0.0;
    double cooling_s = std::numeric_limits<double>::infinity();  ///< time constant of H
    bool operator==(const Thermal&) const = default;
  } thermal;

  /// Torque that depends on the angle, plus a constant: amplitude sin(order q + phase) + offset.
  struct Ripple {
    double amplitude_Nm = 0.0;
    double order = 1.0;
    double phase_rad = 0.0;
    double offset_Nm = 0.0;
    bool operator==(const Ripple&) const = default;
  } ripple;

  bool operator==(const ActuatorParameters&) const = default;
};

/// One number of ActuatorParameters: its name in motor.yaml, and the range of its search in a fit.
struct ActuatorParameter {
  std::string_view name;  ///< "friction.coulomb_Nm": group and key
  std::string_view unit;
  double lower, upper;  ///< of a search; a file may exceed them
  bool may_be_negative;
  double& (*in)(ActuatorParameters&);
  std::string_view group() const { return name.substr(0, name.find('.')); }
  std::string_view key() const { return name.substr(name.find('.') + 1); }
  double value(const ActuatorParameters& parameters) const {
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast): one accessor reads and writes; here it reads
    return in(const_cast<ActuatorParameters&>(parameters));
  }
};

/// All parameters, in the order of motor.yaml. A further effect is a group above and its rows here.
std::span<const ActuatorParameter> actuator_parameters();

/// Throws std::invalid_argument that lists the names if there is no such parameter.
const ActuatorParameter& actuator_parameter(std::string_view name);

}  // namespace pmg::model
