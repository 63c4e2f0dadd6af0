// Parameters of one joint's drive and transmission. Each group is one kind of effect and neutral by default.
#pragma once

#include <limits>
#include <span>
#include <string_view>

#include "model/residual_torque.hpp"

namespace pmg::model {

constexpr double kReferenceTemperature_C = 25.0;  ///< reference of friction and torque parameters

/// Names are those of a turning joint; on a linear axis read m for rad, N for Nm, kg for kg m^2. The drive's output has
/// its own unit: torque [Nm] for a position PD, duty [-1, 1] for a voltage servo, volts for a cascade.
struct ActuatorParameters {
  /// Effects on a command before the drive compares it with its sensor, in this order.
  struct Command {
    double delay_s = 0.0;   ///< of positions, speeds, gains and feed-forward; switching off is immediate
    double update_s = 0.0;  ///< the drive takes a new command once in so long
    double rate_limit_rad_s = std::numeric_limits<double>::infinity();  ///< of the position command
    /// Of the position command: a profile that accelerates and brakes, up to the rate limit.
    double acceleration_limit_rad_s2 = std::numeric_limits<double>::infinity();
    double hold_s = 0.0;  ///< period of the drive's own loop: its output stays for so long
    bool operator==(const Command&) const = default;
  } command;

  /// output = clip(kp e + kd de + feed-forward torque / (torque_per_unit supply), +-limit);
  /// torque = torque_scale torque_per_unit (output supply - back_emf dq).
  struct Drive {
    double kp_scale = 1.0, kd_scale = 1.0;  ///< real gain over nominal gain
    double limit = std::numeric_limits<double>::infinity();
    double dead_band_rad = 0.0;        ///< position errors below it give no output
    double dead_band_subtracts = 0.0;  ///< share of the dead band by which larger errors are reduced; with 0 they jump
    double dead_band_wake_rad = 0.0;   ///< once asleep in the dead band, the drive wakes up so far beyond it
    double output_dead_band = 0.0;     ///< [unit] smaller outputs give nothing, larger ones are reduced by it
    double output_rate_limit_per_s = std::numeric_limits<double>::infinity();  ///< [unit/s]
    double torque_delay_s = 0.0;      ///< from the output to the motor's torque: commands and readings act late alike
    double torque_per_unit_Nm = 1.0;  ///< per unit of output times supply, as the drive believes it
    double torque_scale = 1.0;        ///< real torque over what the drive believes, feed-forward too
    double saturation_per_Nm = 0.0;   ///< iron saturates: torque T becomes T / (1 + saturation |T|)
    double back_emf_s_per_rad = 0.0;  ///< [output times supply per rad/s]
    /// Voltage servo: share of the supply that its source loses per Nm at full duty (output at its limit). A bridge
    /// takes duty times the motor's current from the bus.
    double supply_sag_per_Nm = 0.0;
    double supply_sag_time_s =
        0.0;  ///< a battery: part of the sag comes through a capacitance, with this time constant
    /// That part. Half: the battery of Chen and Rincon-Mora (2006), 74 mOhm at once and 97 mOhm through capacitances.
    double supply_sag_slow_share = 0.5;
    /// A supply with a current limit: the motor's torque at full duty that it feeds; at a part of the duty more.
    double supply_limit_Nm = std::numeric_limits<double>::infinity();
    double brake_when_disabled = 0.0;  ///< share of the back-EMF torque that stays when the drive is switched off
    double stall_torque_Nm = std::numeric_limits<double>::infinity();  ///< torque-speed line: torque at rest
    double no_load_rad_s = std::numeric_limits<double>::infinity();    ///< torque-speed line: speed without torque
    double most_power_W = std::numeric_limits<double>::infinity();     ///< of the motor; above it the field is weakened
    /// A guard against overspeed takes all torque along the motion away; it begins at nine tenths of this speed.
    double cut_speed_rad_s = std::numeric_limits<double>::infinity();
    bool operator==(const Drive&) const = default;
  } drive;

  /// Errors of the drive's measurement of its joint.
  struct Sensor {
    double zero_offset_rad = 0.0;  ///< reading minus true angle
    double hysteresis_rad = 0.0;   ///< play between joint and sensor, end to end: the reading waits at a reversal
    /// Of the sensor's disc or magnet: adds eccentricity sin(order q + phase) to the reading; a disc on the motor's
    /// shaft turns `order` times as fast as the joint.
    double eccentricity_rad = 0.0;
    double eccentricity_order = 1.0;
    double eccentricity_phase_rad = 0.0;
    double ellipticity_rad = 0.0;  ///< of the disc: adds ellipticity sin(2 q + phase)
    double ellipticity_phase_rad = 0.0;
    double quantum_rad = 0.0;
    double delay_s = 0.0;  ///< of position and speed. Recordings hold what the drive knows, so they are late too
    double lag_s = 0.0;    ///< of the position
    /// 1 to 3 first-order lags of lag_s / stages in a row. Two are a tracking loop of that delay; three have the delay
    /// and the spread of a moving average over 2 lag_s. Whole numbers only.
    double lag_stages = 1.0;
    double velocity_lag_s = 0.0;  ///< of the velocity, in addition to the position's; first order
    double hold_s = 0.0;          ///< the drive's loop sees a new reading once in so long; recordings see each
    double on_motor = 0.0;  ///< 1: the sensor turns with the motor, before an elastic transmission; 0: with the joint
    bool operator==(const Sensor&) const = default;
  } sensor;

  /// Between motor and joint. With infinite stiffness the transmission is rigid.
  struct Transmission {
    double armature_kg_m2 = 0.0;  ///< rotor inertia seen at the joint
    double stiffness_Nm_per_rad = std::numeric_limits<double>::infinity();
    double hardening_Nm_per_rad3 = 0.0;  ///< torque of the shaft grows by hardening twist^3; needs a stiffness
    double damping_Nm_s_per_rad = 0.0;   ///< of the shaft; needs a stiffness
    double backlash_rad = 0.0;           ///< free play from end to end; needs a stiffness
    double friction_on_joint = 0.0;      ///< share of friction that acts on the joint's side of an elastic transmission
    bool operator==(const Transmission&) const = default;
  } transmission;

  /// Torque against the motion: (viscous |dq| + viscous_quadratic dq^2) (1 +- viscous_asymmetry) plus a dry part,
  ///   coulomb + stribeck exp(-|dq/stribeck_rad_s|^exponent) + (load_driving or load_backdriving) |load|.
  /// The dry part is a bristle that bends by presliding_rad and then slides (Dahl's model with a corner), so a joint at
  /// rest stays at rest. stribeck_Nm is negative if friction grows with speed and levels off, as in greased gears.
  struct Friction {
    double viscous_Nm_s_per_rad = 0.0;
    double viscous_quadratic_Nm_s2_per_rad2 = 0.0;  ///< churning oil
    double viscous_asymmetry = 0.0;  ///< viscous friction times (1 + asymmetry) forwards, (1 - asymmetry) backwards
    double coulomb_Nm = 0.0;
    double stribeck_Nm = 0.0;
    double stribeck_rad_s = 0.1;
    double stribeck_exponent = 2.0;
    double stribeck_asymmetry = 0.0;  ///< the Stribeck term times (1 + asymmetry) forwards, (1 - asymmetry) backwards
    double load_driving = 0.0;        ///< the motor moves the load
    double load_backdriving = 0.0;    ///< the load moves the motor
    /// Which torque is the load: what the gear transmits T, the motor's own M, or the net torque (M - external) / 2,
    /// which is both at rest: load = T + load_by_motor (M - T) + load_net ((M - external) / 2 - T).
    double load_by_motor = 0.0, load_net = 0.0;
    double asymmetry = 0.0;  ///< dry friction times (1 + asymmetry) forwards, (1 - asymmetry) backwards
    double presliding_rad = 1e-3;
    bool operator==(const Friction&) const = default;
  } friction;

  /// Effects of temperature T, heat H, friction's work W and time t since the start. Dry friction is multiplied by
  ///   exp(friction_per_K (T - 25 degC) + friction_per_Nm2_s H + friction_per_J W),
  /// because lubricants thin exponentially, viscous friction by exp(viscous_per_K (T - 25 degC)) besides. H is the heat
  /// that the drive's torque has put into its winding since the start, dH/dt = torque^2 - H / cooling_s; it serves
  /// where no temperature is known. Torque per unit of output is multiplied by
  ///   (1 + torque_per_K (T - 25 degC)) / (1 + resistance_per_K (T - 25 degC))
  ///   (1 + torque_per_Nm2_s H) (1 - torque_fade_share (1 - exp(-t / torque_fade_s))),
  /// the first two as data sheets give them for magnets and copper.
  struct Thermal {
    double friction_per_K = 0.0;  ///< negative: a warm gear turns more easily
    double viscous_per_K = 0.0;
    double torque_per_K = 0.0;
    double resistance_per_K =
        0.0;  ///< of a voltage servo's winding; a drive that regulates its current doesn't feel it
    double friction_per_Nm2_s = 0.0;
    double friction_per_J = 0.0;
    double torque_per_Nm2_s = 0.0;                               ///< negative: a warm winding pulls less
    double cooling_s = std::numeric_limits<double>::infinity();  ///< time constant of H
    double torque_fade_share = 0.0;
    double torque_fade_s = std::numeric_limits<double>::infinity();
    bool operator==(const Thermal&) const = default;
  } thermal;

  /// Torque that depends on the angle, plus a constant:
  ///   (amplitude + torque_share drive's torque) sin(order q + phase) + offset.
  struct Ripple {
    double amplitude_Nm = 0.0;
    double torque_share = 0.0;  ///< the torque constant differs with the angle: ripple in proportion to the current
    double order = 1.0;
    double phase_rad = 0.0;
    double offset_Nm = 0.0;
    bool operator==(const Ripple&) const = default;
  } ripple;

  /// What no other group explains, as the diagnosis measured it; acts on the motor as ripple and friction do.
  ResidualTorque residual_torque;

  bool operator==(const ActuatorParameters&) const = default;
};

/// What a number measures. It decides the unit, and how a fit scales the number to a joint.
enum class Quantity {
  kNumber,              ///< a factor, a share, an exponent, a switch
  kTime,                ///< [s]
  kDelay,               ///< [s] commands are held, so that it acts by whole steps of a simulation
  kPeriod,              ///< [s] of a sample and hold; rollouts are not smooth in it
  kAngle,               ///< [rad]
  kQuantum,             ///< [rad] of readings; rollouts are not smooth in it
  kPhase,               ///< [rad] of a wave over the joint's angle
  kOrder,               ///< of such a wave: periods a turn
  kSpeed,               ///< [rad/s]
  kAcceleration,        ///< [rad/s^2]
  kInertia,             ///< [kg m^2]
  kTorque,              ///< [Nm]
  kStiffness,           ///< [Nm/rad]
  kHardening,           ///< [Nm/rad^3]
  kDamping,             ///< [Nm s/rad]
  kQuadraticDamping,    ///< [Nm s^2/rad^2]
  kPower,               ///< [W]
  kOutput,              ///< of a drive, in its own unit
  kOutputRate,          ///< [unit/s]
  kOutputOfSpeed,       ///< [unit s/rad]
  kTorqueOfOutput,      ///< [Nm/unit]
  kShareOfTorque,       ///< [1/Nm]
  kShareOfTemperature,  ///< [1/K]
  kShareOfHeat,         ///< [1/(Nm^2 s)] of a winding
  kShareOfWork,         ///< [1/J]
};

std::string_view unit(Quantity quantity);

/// One number of ActuatorParameters: its name in motor.yaml, and the range of its search in a fit.
struct ActuatorParameter {
  std::string_view name;  ///< "friction.coulomb_Nm": group and key
  Quantity quantity;
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

/// All numbers but those of residual_torque, in the order of motor.yaml. A further effect is a group above and its rows
/// here.
std::span<const ActuatorParameter> actuator_parameters();

/// Throws std::invalid_argument that lists the names if there is no such parameter.
const ActuatorParameter& actuator_parameter(std::string_view name);

}  // namespace pmg::model
