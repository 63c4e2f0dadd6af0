// The hidden plants' own simulation: RK4 at 10 kHz, with velocity reversals located within the step.
#pragma once

#include <array>
#include <deque>
#include <vector>

#include "plant_parameters.hpp"

namespace pmg::hidden {

/// What the drive is told from now on.
struct PlantCommand {
  double q_rad = 0.0;
  double kp = 1.0, kd = 0.0;  ///< as told, in the law's units
  double bus_V = 1.0;
  bool enabled = true;
};

/// One joint on its bench. The drive is digital at the simulation's 10 kHz; everything mechanical is continuous.
class Plant {
 public:
  static constexpr double kStep_s = 1e-4;

  explicit Plant(const PlantParameters& parameters);

  /// At rest, nothing bent, told all along to stay there.
  void reset(double q_rad, double temperature_C = 25.0);

  /// Goes on by duration_s under the command. Commands are remembered for as long as they may be delayed.
  void advance(double duration_s, const PlantCommand& command);

  /// A torque from outside on the load, until set again.
  void disturb(double torque_Nm) { disturbance_Nm_ = torque_Nm; }

  /// What the sensor says, with electrical noise added before it is quantised.
  double reading_rad(double noise_rad = 0.0) const;

  double q_rad() const { return state_[kLoad]; }
  double dq_rad_s() const { return state_[kLoadSpeed]; }
  double rotor_rad() const { return elastic_ ? state_[kRotor] : state_[kLoad]; }
  double temperature_C() const { return temperature_C_; }
  bool sticks() const { return dry_ && slides_ == 0; }
  /// Of load, rotor, shaft and gravity [J].
  double energy_J() const;

 private:
  enum Index { kLoad, kLoadSpeed, kRotor, kRotorSpeed, kLagged, kBristle, kStates };
  using State = std::array<double, kStates>;

  double command_now(const PlantCommand& command) const;
  void drive(const PlantCommand& command);
  void bridge(double wish, double bus_V);
  double regulated_torque_Nm(double wish, double motor_rad_s) const;
  /// The mechanical part over h with the drive's torque held.
  void move(double h);
  State rk4(const State& at, double h) const;
  State derivative(const State& at) const;
  /// Torque on the body that the dry friction holds, without that friction.
  double push_Nm(const State& at) const;
  double smooth_rotor_torque_Nm(double rotor_rad, double rotor_rad_s) const;
  double load_torque_Nm(const State& at) const;  ///< from outside on the load
  double shaft_Nm(const State& at) const;
  double dry_level_Nm(double angle_rad, double speed_rad_s) const;
  double breakaway_Nm(const State& at, int direction) const;
  double bristle_rate(const State& at, double speed_rad_s) const;
  double slip_elements_Nm(double angle_rad) const;
  void settle_slip_elements(double angle_rad);
  void warm(double h);
  void drag_sensor();

  PlantParameters p_;
  bool elastic_, dry_, lugre_;
  Index angle_, speed_;  // of the body with friction
  State state_{};
  int slides_ = 0;  // direction, or 0 while it sticks
  double time_s_ = 0.0, disturbance_Nm_ = 0.0, temperature_C_ = 25.0;
  double friction_scale_ = 1.0;
  double held_Nm_ = 0.0, emf_slope_ = 0.0, torque_before_Nm_ = 0.0;
  double limited_rad_ = 0.0, sensor_rad_ = 0.0;
  struct Told {
    double from_s, q_rad;
  };
  std::deque<Told> told_;
  struct SlipElement {
    double stiffness, most_Nm, bend_rad, from_rad;
  };
  std::vector<SlipElement> slip_elements_;
};

}  // namespace pmg::hidden
