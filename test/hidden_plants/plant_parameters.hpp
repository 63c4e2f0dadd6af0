// A joint on a bench as a machine, in numbers: what the hidden plants are made of. Nothing of the project is used here,
// so that what a diagnosis finds was not put in by the same code.
#pragma once

#include <limits>

namespace pmg::hidden {

inline constexpr double kNever = std::numeric_limits<double>::infinity();

/// Neutral by default: a rigid, frictionless joint whose drive does what its law says.
struct PlantParameters {
  /// What the machine is.
  struct Body {
    double load_inertia_kg_m2 = 0.02, load_gravity_Nm = 0.0;  ///< torque on the load is -load_gravity_Nm sin(q)
    double inertia_factor = 1.0, gravity_factor = 1.0;        ///< of the load that hangs there over the one meant
    double rotor_inertia_kg_m2 = 0.01;                        ///< seen at the joint
  } body;

  /// position PD: torque = clip(kp e - kd dq, +-limit). Servo: duty = clip(kp e, +-1),
  /// torque = torque_Nm_per_V (duty bus - back_emf_V_s_per_rad dq).
  struct Drive {
    bool servo = false;
    double kp_factor = 1.0, kd_factor = 1.0;  ///< what a gain is over what it is called
    double limit = kNever;                    ///< of the position PD's torque [Nm]
    double dead_band_rad = 0.0;               ///< smaller errors give no output
    double torque_Nm_per_V = 1.0, back_emf_V_s_per_rad = 0.0;
    double sag_per_Nm = 0.0;  ///< share of the bus lost to its source per Nm at full duty: current from it is duty
                              ///< times the motor's
    double stall_torque_Nm = kNever, no_load_rad_s = kNever;  ///< what the motor can at its voltage
  } drive;

  struct Command {
    double delay_s = 0.0, rate_limit_rad_s = kNever;
  } command;

  /// x follows q with play (a loose coupling); reading = quantised(x + offset + eccentricity sin(x + phase)). The drive
  /// sees it through a first-order filter.
  struct Sensor {
    double play_rad = 0.0;  ///< from end to end
    double offset_rad = 0.0, eccentricity_rad = 0.0, eccentricity_phase_rad = 0.0;
    double quantum_rad = 0.0, lag_s = 0.0;
  } sensor;

  /// At the rotor. Dry friction holds still what it can hold (Karnopp's switching with exact events), else it is
  /// (coulomb + stribeck exp(-(dq/stribeck_rad_s)^2) + share of the gear's torque) (1 +- asymmetry).
  struct Friction {
    double coulomb_Nm = 0.0, viscous_Nm_s_per_rad = 0.0;
    double stribeck_Nm = 0.0, stribeck_rad_s = 0.1;
    double load_driving = 0.0, load_backdriving = 0.0;
    double asymmetry = 0.0;
  } friction;

  /// Two masses with a spring between them once stiffness is finite; a backlash's flanks push and don't pull.
  struct Transmission {
    double stiffness_Nm_per_rad = kNever, damping_Nm_s_per_rad = 0.0, backlash_rad = 0.0;
  } transmission;

  struct Ripple {
    double cogging_Nm = 0.0, cogging_order = 1.0, cogging_phase_rad = 0.0;
    double offset_Nm = 0.0;  ///< a spring's preload, a tilted bench
  } ripple;

  /// Friction, dry and viscous, is exp(friction_per_K (T - 25)) of what it is at 25 degrees (lubricants thin
  /// exponentially), the motor's torque 1 + torque_per_K (T - 25) (magnets weaken linearly).
  struct Thermal {
    double friction_per_K = 0.0, torque_per_K = 0.0;
    double heating_K_per_Nm2 = 0.0, time_constant_s = 100.0;  ///< where the motor's temperature settles, and how fast
  } thermal;

  /// What no catalogue knows.
  struct Strange {
    double lugre_width_rad = 0.0;    ///< LuGre instead of Coulomb friction: how far bristles bend
    double lugre_damping_s = 0.0;    ///< sigma1 over sigma0
    double maxwell_width_rad = 0.0;  ///< Maxwell-slip instead of Coulomb friction: where its last element slips
    double rub_Nm = 0.0, rub_at_rad = 0.0, rub_width_rad = 0.2;  ///< a dented bearing: more dry friction about an angle
    double cable_Nm_per_rad = 0.0, cable_slack_rad = 0.5;        ///< a cable that pulls once it is taut
  } strange;
};

}  // namespace pmg::hidden
