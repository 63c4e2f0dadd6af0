// Parameters of one joint's drive and transmission. Each group is one kind of effect and neutral by default.
#pragma once

#include <array>
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
  /// torque = torque_scale torque_per_unit (output supply - back_emf dq) + offset.
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
    double offset_Nm = 0.0;          ///< torque that the drive gives too much while it is on: its current sensor's zero
    double saturation_per_Nm = 0.0;  ///< iron saturates: torque T becomes T / (1 + saturation |T|)
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
    double angle_scale = 1.0;      ///< reading over true angle, speeds too: counts a turn, ratio of the gear before it
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
    /// Of a belt's stiffness, the share that gives way: torque = stiffness ((1 - share) twist + share bend), where the
    /// bend follows the twist and levels off, bend' = twist' - |twist'| bend / hysteresis (Bouc, Wen). Needs a
    /// stiffness.
    double hysteretic_share = 0.0;
    double hysteresis_rad = 0.02;    ///< the bend at which it levels off
    double backlash_rad = 0.0;       ///< free play from end to end; needs a stiffness
    double friction_on_joint = 0.0;  ///< share of friction that acts on the joint's side of an elastic transmission
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
  ///   (amplitude + torque_share drive's torque) sin(order q + phase) + second sin(2 order q + second_phase) + offset
  ///   - spring q.
  struct Ripple {
    double amplitude_Nm = 0.0;
    double torque_share = 0.0;  ///< the torque constant differs with the angle: ripple in proportion to the current
    double order = 1.0;
    double phase_rad = 0.0;
    double second_Nm = 0.0;  ///< amplitude of the second harmonic, at twice the order
    double second_phase_rad = 0.0;
    double offset_Nm = 0.0;
    double spring_Nm_per_rad = 0.0;  ///< a spring between joint and frame; its preload is the offset
    bool operator==(const Ripple&) const = default;
  } ripple;

  /// What no other group explains, as the diagnosis measured it; acts on the motor as ripple and friction do.
  ResidualTorque residual_torque;

  bool operator==(const ActuatorParameters&) const = default;
};

/// What a parameter measures: its unit, and how a bench's size scales its search.
enum class Quantity {
  kFactor,  ///< any number without a unit that is none of the others
  kOrder,   ///< periods of a wave over a turn
  kDelay,
  kPeriod,  ///< of a sample and hold
  kLag,
  kTimeConstant,
  kAngle,
  kPhase,    ///< of a wave over a turn
  kQuantum,  ///< of a sensor
  kPlace,    ///< of a recording among all: 0 to 1
  kSpeed,
  kAcceleration,
  kTorque,
  kDamping,
  kQuadraticDamping,
  kStiffness,   ///< of what transmits torque
  kSpringRate,  ///< of what pulls the joint to one place
  kHardening,
  kTorquePerOutput,
  kInertia,
  kPower,
  kPerTorque,
  kPerHeat,  ///< of a winding: torque^2 times time
  kPerEnergy,
  kPerKelvin,
  kOutput,
  kOutputRate,
  kBackEmf,
};

/// "Nm s/rad" of a turning joint; empty for a number without a unit.
std::string_view unit(Quantity quantity);

/// How much larger a range of search is on a linear axis, which moves kilograms by hundreds of newtons.
double factor_on_linear_axis(Quantity quantity);

/// True if it doubles where all torques and inertias do.
bool follows_torque(Quantity quantity);

enum class Allowed { kAny, kNotNegative, kPositive, kShare, kWithinOne };

/// One number of ActuatorParameters: its name in motor.yaml, the range of its search in a fit, and what it may be.
struct ActuatorParameter {
  std::string_view name;  ///< "friction.coulomb_Nm": group and key
  Quantity quantity;
  double lower, upper;  ///< of a search; a file may exceed them
  Allowed allowed;
  double example;  ///< shows on a joint of some Nm: what pictures and comparisons of simulations take
  double& (*in)(ActuatorParameters&);
  bool may_be_negative() const { return allowed == Allowed::kAny || allowed == Allowed::kWithinOne; }
  std::string_view group() const { return name.substr(0, name.find('.')); }
  std::string_view key() const { return name.substr(name.find('.') + 1); }
  double value(const ActuatorParameters& parameters) const {
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast): one accessor reads and writes; here it reads
    return in(const_cast<ActuatorParameters&>(parameters));
  }
};

#define PMG_ACTUATOR_PARAMETER(group, key, quantity, lower, upper, allowed, example) \
  ActuatorParameter {                                                                \
#group "." #key, quantity, lower, upper, allowed, example,                       \
        [](ActuatorParameters & p) -> double& { return p.group.key; }                \
  }

/// All numbers but those of residual_torque, in the order of motor.yaml. A further parameter is a member above and its
/// row here. The ranges cover joints from a hobby servo's to a humanoid's knee; a linear rig scales them.
inline constexpr auto kActuatorParameters = [] {
  using enum Quantity;
  using enum Allowed;
  return std::array{
      PMG_ACTUATOR_PARAMETER(command, delay_s, kDelay, 0.0, 0.06, kNotNegative, 0.0605),
      PMG_ACTUATOR_PARAMETER(command, update_s, kPeriod, 0.0, 0.2, kNotNegative, 0.033),
      PMG_ACTUATOR_PARAMETER(command, rate_limit_rad_s, kSpeed, 1.0, 30.0, kPositive, 1.5),
      PMG_ACTUATOR_PARAMETER(command, acceleration_limit_rad_s2, kAcceleration, 1.0, 1000.0, kPositive, 25.0),
      PMG_ACTUATOR_PARAMETER(command, hold_s, kPeriod, 0.0, 0.04, kNotNegative, 0.025),
      PMG_ACTUATOR_PARAMETER(drive, kp_scale, kFactor, 0.05, 20.0, kNotNegative, 0.6),
      PMG_ACTUATOR_PARAMETER(drive, kd_scale, kFactor, 0.02, 50.0, kNotNegative, 1.4),
      PMG_ACTUATOR_PARAMETER(drive, limit, kOutput, 0.05, 200.0, kNotNegative, 6.0),
      PMG_ACTUATOR_PARAMETER(drive, dead_band_rad, kAngle, 0.0, 0.1, kNotNegative, 0.08),
      PMG_ACTUATOR_PARAMETER(drive, dead_band_subtracts, kFactor, 0.0, 1.0, kShare, 0.8),
      PMG_ACTUATOR_PARAMETER(drive, dead_band_wake_rad, kAngle, 0.0, 0.1, kNotNegative, 0.04),
      PMG_ACTUATOR_PARAMETER(drive, output_dead_band, kOutput, 0.0, 20.0, kNotNegative, 0.4),
      PMG_ACTUATOR_PARAMETER(drive, output_rate_limit_per_s, kOutputRate, 0.5, 5000.0, kPositive, 150.0),
      PMG_ACTUATOR_PARAMETER(drive, torque_delay_s, kDelay, 0.0, 0.06, kNotNegative, 0.0051),
      PMG_ACTUATOR_PARAMETER(drive, torque_per_unit_Nm, kTorquePerOutput, 0.01, 5.0, kNotNegative, 1.3),
      PMG_ACTUATOR_PARAMETER(drive, torque_scale, kFactor, 0.2, 5.0, kPositive, 0.8),
      PMG_ACTUATOR_PARAMETER(drive, offset_Nm, kTorque, -5.0, 5.0, kAny, 1.0),
      PMG_ACTUATOR_PARAMETER(drive, saturation_per_Nm, kPerTorque, 0.0, 2.0, kNotNegative, 0.1),
      PMG_ACTUATOR_PARAMETER(drive, back_emf_s_per_rad, kBackEmf, 0.01, 10.0, kNotNegative, 0.3),
      PMG_ACTUATOR_PARAMETER(drive, supply_sag_per_Nm, kPerTorque, 0.0, 1.0, kNotNegative, 0.2),
      PMG_ACTUATOR_PARAMETER(drive, supply_sag_time_s, kTimeConstant, 0.0, 5.0, kNotNegative, 0.1),
      PMG_ACTUATOR_PARAMETER(drive, supply_sag_slow_share, kFactor, 0.0, 1.0, kShare, 0.7),
      PMG_ACTUATOR_PARAMETER(drive, supply_limit_Nm, kTorque, 0.05, 400.0, kPositive, 2.0),
      PMG_ACTUATOR_PARAMETER(drive, brake_when_disabled, kFactor, 0.0, 1.0, kNotNegative, 0.5),
      PMG_ACTUATOR_PARAMETER(drive, stall_torque_Nm, kTorque, 0.1, 400.0, kNotNegative, 8.0),
      PMG_ACTUATOR_PARAMETER(drive, no_load_rad_s, kSpeed, 1.0, 60.0, kPositive, 3.5),
      PMG_ACTUATOR_PARAMETER(drive, most_power_W, kPower, 0.2, 5000.0, kPositive, 2.0),
      PMG_ACTUATOR_PARAMETER(drive, cut_speed_rad_s, kSpeed, 0.5, 60.0, kPositive, 1.2),
      PMG_ACTUATOR_PARAMETER(sensor, zero_offset_rad, kAngle, -0.15, 0.15, kAny, 0.3),
      PMG_ACTUATOR_PARAMETER(sensor, angle_scale, kFactor, 0.5, 2.0, kPositive, 1.2),
      PMG_ACTUATOR_PARAMETER(sensor, hysteresis_rad, kAngle, 0.0, 0.1, kNotNegative, 0.06),
      PMG_ACTUATOR_PARAMETER(sensor, eccentricity_rad, kAngle, 0.0, 0.1, kNotNegative, 0.15),
      PMG_ACTUATOR_PARAMETER(sensor, eccentricity_order, kOrder, 1.0, 64.0, kNotNegative, 5.0),
      PMG_ACTUATOR_PARAMETER(sensor, eccentricity_phase_rad, kPhase, -3.15, 3.15, kAny, 0.7),
      PMG_ACTUATOR_PARAMETER(sensor, ellipticity_rad, kAngle, 0.0, 0.1, kNotNegative, 0.03),
      PMG_ACTUATOR_PARAMETER(sensor, ellipticity_phase_rad, kPhase, -3.15, 3.15, kAny, -0.6),
      PMG_ACTUATOR_PARAMETER(sensor, quantum_rad, kQuantum, 0.0, 0.02, kNotNegative, 0.02),
      PMG_ACTUATOR_PARAMETER(sensor, delay_s, kDelay, 0.0, 0.06, kNotNegative, 0.0067),
      PMG_ACTUATOR_PARAMETER(sensor, lag_s, kLag, 0.0, 0.03, kNotNegative, 0.012),
      PMG_ACTUATOR_PARAMETER(sensor, lag_stages, kFactor, 1.0, 3.0, kNotNegative, 2.0),
      PMG_ACTUATOR_PARAMETER(sensor, velocity_lag_s, kLag, 0.0, 0.03, kNotNegative, 0.008),
      PMG_ACTUATOR_PARAMETER(sensor, hold_s, kPeriod, 0.0, 0.1, kNotNegative, 0.009),
      PMG_ACTUATOR_PARAMETER(sensor, on_motor, kFactor, 0.0, 1.0, kShare, 1.0),
      PMG_ACTUATOR_PARAMETER(transmission, armature_kg_m2, kInertia, 1e-4, 0.5, kNotNegative, 0.03),
      PMG_ACTUATOR_PARAMETER(transmission, stiffness_Nm_per_rad, kStiffness, 5.0, 5000.0, kNotNegative, 40.0),
      PMG_ACTUATOR_PARAMETER(transmission, hardening_Nm_per_rad3, kHardening, 10.0, 1e8, kNotNegative, 4e3),
      PMG_ACTUATOR_PARAMETER(transmission, damping_Nm_s_per_rad, kDamping, 0.0, 10.0, kNotNegative, 0.1),
      PMG_ACTUATOR_PARAMETER(transmission, hysteretic_share, kFactor, 0.0, 0.95, kShare, 0.5),
      PMG_ACTUATOR_PARAMETER(transmission, hysteresis_rad, kAngle, 0.001, 0.1, kPositive, 0.02),
      PMG_ACTUATOR_PARAMETER(transmission, backlash_rad, kAngle, 0.0, 0.1, kNotNegative, 0.06),
      PMG_ACTUATOR_PARAMETER(transmission, friction_on_joint, kFactor, 0.0, 1.0, kShare, 0.7),
      PMG_ACTUATOR_PARAMETER(friction, viscous_Nm_s_per_rad, kDamping, 0.0, 5.0, kNotNegative, 0.8),
      PMG_ACTUATOR_PARAMETER(friction, viscous_quadratic_Nm_s2_per_rad2, kQuadraticDamping, 0.0, 2.0, kNotNegative,
                             0.15),
      PMG_ACTUATOR_PARAMETER(friction, viscous_asymmetry, kFactor, -0.95, 0.95, kWithinOne, 0.4),
      PMG_ACTUATOR_PARAMETER(friction, coulomb_Nm, kTorque, 0.0, 10.0, kNotNegative, 0.8),
      PMG_ACTUATOR_PARAMETER(friction, stribeck_Nm, kTorque, -5.0, 5.0, kAny, 0.4),
      PMG_ACTUATOR_PARAMETER(friction, stribeck_rad_s, kSpeed, 0.01, 5.0, kPositive, 0.3),
      PMG_ACTUATOR_PARAMETER(friction, stribeck_exponent, kFactor, 0.3, 4.0, kPositive, 0.7),
      PMG_ACTUATOR_PARAMETER(friction, stribeck_asymmetry, kFactor, -1.0, 1.0, kWithinOne, -0.5),
      PMG_ACTUATOR_PARAMETER(friction, load_driving, kFactor, 0.0, 2.0, kNotNegative, 0.4),
      PMG_ACTUATOR_PARAMETER(friction, load_backdriving, kFactor, 0.0, 0.9, kNotNegative, 0.4),
      PMG_ACTUATOR_PARAMETER(friction, load_by_motor, kFactor, 0.0, 1.0, kShare, 0.6),
      PMG_ACTUATOR_PARAMETER(friction, load_net, kFactor, 0.0, 1.0, kShare, 0.4),
      PMG_ACTUATOR_PARAMETER(friction, asymmetry, kFactor, -0.95, 0.95, kAny, 0.7),
      PMG_ACTUATOR_PARAMETER(friction, presliding_rad, kAngle, 1e-4, 0.05, kPositive, 0.003),
      PMG_ACTUATOR_PARAMETER(thermal, friction_per_K, kPerKelvin, -0.1, 0.1, kAny, 0.04),
      PMG_ACTUATOR_PARAMETER(thermal, viscous_per_K, kPerKelvin, -0.1, 0.1, kAny, -0.03),
      PMG_ACTUATOR_PARAMETER(thermal, torque_per_K, kPerKelvin, -0.05, 0.05, kAny, -0.004),
      PMG_ACTUATOR_PARAMETER(thermal, resistance_per_K, kPerKelvin, 0.0, 0.02, kNotNegative, 0.0039),
      PMG_ACTUATOR_PARAMETER(thermal, friction_per_Nm2_s, kPerHeat, -0.2, 0.2, kAny, 0.3),
      PMG_ACTUATOR_PARAMETER(thermal, friction_per_J, kPerEnergy, -5.0, 5.0, kAny, -0.4),
      PMG_ACTUATOR_PARAMETER(thermal, torque_per_Nm2_s, kPerHeat, -0.5, 0.0, kAny, -0.04),
      PMG_ACTUATOR_PARAMETER(thermal, cooling_s, kTimeConstant, 1.0, 1000.0, kPositive, 0.2),
      PMG_ACTUATOR_PARAMETER(thermal, torque_fade_share, kFactor, 0.0, 0.9, kShare, 0.4),
      PMG_ACTUATOR_PARAMETER(thermal, torque_fade_s, kTimeConstant, 0.1, 100.0, kPositive, 0.1),
      PMG_ACTUATOR_PARAMETER(ripple, amplitude_Nm, kTorque, 0.0, 2.0, kNotNegative, 0.5),
      PMG_ACTUATOR_PARAMETER(ripple, torque_share, kFactor, 0.0, 0.9, kNotNegative, 0.3),
      PMG_ACTUATOR_PARAMETER(ripple, order, kOrder, 1.0, 64.0, kNotNegative, 12.0),
      PMG_ACTUATOR_PARAMETER(ripple, phase_rad, kPhase, -3.15, 3.15, kAny, 0.4),
      PMG_ACTUATOR_PARAMETER(ripple, second_Nm, kTorque, 0.0, 2.0, kNotNegative, 0.2),
      PMG_ACTUATOR_PARAMETER(ripple, second_phase_rad, kPhase, -3.15, 3.15, kAny, -0.5),
      PMG_ACTUATOR_PARAMETER(ripple, offset_Nm, kTorque, -5.0, 5.0, kAny, 1.0),
      PMG_ACTUATOR_PARAMETER(ripple, spring_Nm_per_rad, kSpringRate, 0.0, 2.0, kAny, 1.0),
  };
}();
#undef PMG_ACTUATOR_PARAMETER

inline std::span<const ActuatorParameter> actuator_parameters() { return kActuatorParameters; }

/// Throws std::invalid_argument that lists the names if there is no such parameter.
const ActuatorParameter& actuator_parameter(std::string_view name);

}  // namespace pmg::model
