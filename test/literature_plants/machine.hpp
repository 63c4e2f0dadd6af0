// A joint on its bench in numbers, with one choice of form for every effect: what the plants of the literature are made
// of. Nothing of the project is used here.
#pragma once

#include <limits>

namespace pmg::literature {

inline constexpr double kNever = std::numeric_limits<double>::infinity();  ///< a limit that is never reached
inline constexpr double kReference_C = 25.0;
inline constexpr double kGravity_m_s2 = 9.81;

/// How a drive makes a torque of its command; bench.yaml's drive.law.
enum class Law { kPositionPd, kServo, kCascade, kTorque };

/// How dry friction sets in.
enum class DryForm {
  kSign,   ///< holds still what it can hold, then slides (Coulomb 1785)
  kTanh,   ///< level tanh(speed / smoothing): creeps (Andersson, Soderberg, Bjorklund 2007)
  kDahl,   ///< a bristle, dz/dt = v - |v| z / width, torque = level z / width (Dahl 1968)
  kLuGre,  ///< the same with a Stribeck level and bristle damping (Canudas de Wit, Olsson, Astrom, Lischinsky 1995)
};

/// Which torque load-dependent friction follows.
enum class LoadForm {
  kNone,
  kNet,          ///< half of |motor torque - external torque| (Duclusaud, Passault, Padois, Ly 2025)
  kMotor,        ///< |motor torque| (the same, its term of the motor)
  kTransmitted,  ///< |torque through the gear| (Dohring, Lee, Newman 1993; Hamon, Gautier, Garrec 2010)
  kPowerFlow,    ///< the same, with one share driving and another back-driving (Verstraten et al. 2015)
};

enum class ContactForm {
  kDamped,        ///< flanks with stiffness and damping that don't pull (Nordin, Galic, Gutman 1997)
  kHuntCrossley,  ///< damping in proportion to the penetration (Hunt, Crossley 1975)
  kSoftGap,       ///< a weak spring inside the gap: two-stage stiffness (Nordin, Gutman 2002)
};

enum class DeadBandForm {
  kJump,        ///< no output below the threshold, the whole error above it
  kSubtract,    ///< error less the threshold (Tao, Kokotovic 1994)
  kOutput,      ///< the output less a threshold: dead time of a bridge (Leggate, Kerkman 1997)
  kHysteresis,  ///< off below the threshold, on again only above twice of it (servo firmware)
};

enum class SagForm {
  kResistance,  ///< a source with a resistance
  kBattery,     ///< part of the resistance acts through a capacitor (Chen, Rincon-Mora 2006)
  kLimit,       ///< a laboratory supply that limits its current (Horowitz, Hill 2015)
};

enum class SpeedForm {
  kLine,   ///< torque falls along a line to the no-load speed (Hughes, Drury 2013)
  kPower,  ///< |torque speed| is limited: field weakening (Krishnan 2001)
  kCut,    ///< full torque up to the last tenth below the no-load speed, then none (an overspeed guard)
};

enum class LagForm {
  kFirstOrder,     ///< a low-pass
  kMovingAverage,  ///< the mean of the last so many readings (Smith 1997)
  kTracking,       ///< a second-order tracking loop, critically damped (Ellis 2002)
};

enum class QuantumForm {
  kRound,       ///< to the nearest step (Widrow, Kollar 2008)
  kFloor,       ///< truncated to the step below
  kHysteresis,  ///< a step is taken only when three quarters of one are passed: an encoder's comparator
};

enum class SensorPlay {
  kPlay,    ///< the play operator (Krasnosel'skii, Pokrovskii 1989)
  kSmooth,  ///< Bouc (1967) and Wen (1976): the play winds up exponentially
  kRelay,   ///< half a width ahead or behind, by the last direction (Preisach 1935)
};

/// Neutral by default: rigid, without friction, and the drive does what its law says.
struct Machine {
  struct Body {
    double load_inertia_kg_m2 = 0.02, load_gravity_Nm = 0.0;  ///< torque on the load is -load_gravity_Nm sin(q)
    double inertia_factor = 1.0, gravity_factor = 1.0;        ///< of the load that hangs there over the one meant
    double more_inertia_kg_m2 = 0.0, more_gravity_Nm = 0.0;   ///< of parts that nobody weighed
    double rotor_inertia_kg_m2 = 0.01;                        ///< seen at the joint
  } body;

  struct Drive {
    Law law = Law::kPositionPd;
    double loop_hz = 2000.0;
    double hold_s = 0.0;  ///< the output is computed once in so long (Astrom, Wittenmark 1997)
    double kp_factor = 1.0, kd_factor = 1.0, torque_factor = 1.0;  ///< real over named
    double saturation_per_Nm = 0.0;  ///< torque = t / (1 + saturation |t|): an iron core (Hanselman 2006)
    double limit = kNever;           ///< of the output: Nm, duty or V
    double torque_per_unit = 1.0;    ///< servo: Nm per V; cascade: Nm per V; else 1
    double back_emf = 0.0;           ///< servo: V s/rad
    DeadBandForm dead_form = DeadBandForm::kJump;
    double dead_band_rad = 0.0, dead_output = 0.0;  ///< of the error; of the output, in its unit
    SagForm sag_form = SagForm::kResistance;
    double sag_per_Nm = 0.0;       ///< share of the bus that is lost per Nm at full duty
    double sag_time_s = 0.5;       ///< of the battery's capacitor
    double sag_limit_Nm = kNever;  ///< kLimit: torque at full duty that the supply can feed
    SpeedForm speed_form = SpeedForm::kLine;
    double stall_torque_Nm = kNever, no_load_rad_s = kNever, power_W = kNever;
    double output_rate_per_s = kNever;  ///< of the output: an actuator's rate limit (Klyde, McRuer, Myers 1997)
    double integral_per_s = 0.0;     ///< output += integral kp (error), conditional anti-windup (Astrom, Hagglund 1995)
    double offset_when_on_Nm = 0.0;  ///< a current sensor's zero
    double torque_delay_s = 0.0;     ///< of commands and readings alike: the loop's computation
  } drive;

  struct Command {
    double delay_s = 0.0, delay_jitter = 0.0;  ///< each command is late by delay (1 +- jitter) (Nilsson 1998)
    double rate_limit_rad_s = kNever,
           acceleration_rad_s2 = kNever;     ///< of the position command; with the second: a profile
    double hold_s = 0.0;                     ///< the drive takes a new command once in so long
    double loss = 0.0, loss_period_s = 1.0;  ///< share of each period in which commands don't arrive
  } command;

  struct Sensor {
    bool before_gear = false;               ///< on the motor's side of the shaft
    double offset_rad = 0.0, scale = 1.0;   ///< shown angle: scale q + offset
    double offset_spread_rad = 0.0;         ///< another offset in each run (homing)
    double slip_rad = 0.0, slip_at = 1.0;   ///< from that share of the session on
    double drift_rad = 0.0, drift_s = 2.0;  ///< drift (1 - exp(-t / drift_s))
    double eccentricity_rad = 0.0, eccentricity_phase_rad = 0.0, eccentricity_order = 1.0, eccentricity_second = 0.0;
    QuantumForm quantum_form = QuantumForm::kRound;
    double quantum_rad = 0.0;
    SensorPlay play_form = SensorPlay::kPlay;
    double play_rad = 0.0;  ///< from end to end
    LagForm lag_form = LagForm::kFirstOrder;
    double lag_s = 0.0;                      ///< of what the drive sees
    double delay_s = 0.0;                    ///< of what the drive sees and of what is recorded
    double hold_s = 0.0;                     ///< the drive sees a new reading once in so long
    double loss = 0.0, loss_period_s = 1.0;  ///< the same of recorded readings: the one before stays
  } sensor;

  /// At the rotor, or at the load where a spring is before it.
  struct Friction {
    DryForm dry = DryForm::kSign;
    bool at_load = false;
    double coulomb_Nm = 0.0, coulomb_spread = 0.0;  ///< rms share by which runs differ (Armstrong-Helouvry 1991)
    double smoothing_rad_s = 0.05, bristle_rad = 1e-3, bristle_damping_s = 0.0;
    double viscous_Nm_s_per_rad = 0.0;
    double power_Nm = 0.0, power_exponent = 1.0;  ///< power_Nm |speed|^exponent, speed in rad/s
    double stribeck_Nm = 0.0, stribeck_rad_s = 0.1, stribeck_exponent = 2.0;
    bool stribeck_lorentz = false;  ///< 1 / (1 + (v/vs)^2) in place of exp(-|v/vs|^exponent)
    LoadForm load_form = LoadForm::kNone;
    double load_driving = 0.0, load_backdriving = 0.0;
    double asymmetry = 0.0, viscous_asymmetry = 0.0, stribeck_asymmetry = 0.0;
    double rub_Nm_per_rad = 0.0, rub_from_rad = 0.0;  ///< a cable that rubs: more dry friction beyond an angle
    double dwell_Nm = 0.0, dwell_s = 0.3;             ///< rest makes it stick harder (Rabinowicz 1958)
  } friction;

  struct Transmission {
    double stiffness_Nm_per_rad = kNever, hardening_Nm_per_rad3 = 0.0, damping_Nm_s_per_rad = 0.0;
    double backlash_rad = 0.0;
    ContactForm contact = ContactForm::kDamped;
    double gap_stiffness_Nm_per_rad = 0.0;
    double belt_share = 0.0, belt_width_rad = 0.02;  ///< share of the stiffness that is hysteretic (Bouc, Wen)
  } transmission;

  struct Ripple {
    double cogging_Nm = 0.0, cogging_order = 1.0, cogging_phase_rad = 0.0;
    double second_share = 0.0;   ///< of the amplitude, at twice the order (Zhu, Howe 2000)
    double current_share = 0.0;  ///< ripple in proportion to the drive's torque (Holtz, Springob 1996)
    double offset_Nm = 0.0, preload_Nm_per_rad = 0.0;                  ///< offset - preload q: a preloaded spring
    double latch_Nm = 0.0, latch_at_rad = 0.0, latch_width_rad = 0.1;  ///< a magnet's detent at one angle (Yonnet 1981)
  } ripple;

  /// T is the temperature, H the integral of the drive's torque squared, W what friction has dissipated, t the time.
  struct Thermal {
    double friction_per_K = 0.0, viscous_per_K = 0.0, torque_per_K = 0.0, resistance_per_K = 0.0;
    double friction_per_Nm2_s = 0.0, friction_per_J = 0.0;
    double torque_per_Nm2_s = 0.0, fade_share = 0.0, fade_s = 2.0;
    double cooling_s = kNever;  ///< of H
  } thermal;

  /// A mass on a loose screw creeps outwards while gravity and the swing pull at it by more than the screw holds.
  struct Screw {
    double most_share = 0.0;  ///< of the arm's length
    double holds_m_s2 = 9.81, creep_s = 0.1;
    double length_m = 0.2;
  } screw;
};

}  // namespace pmg::literature
