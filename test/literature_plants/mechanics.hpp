// Rotor, shaft and load between two ticks of the drive: an adaptive integrator, and events where friction catches or
// lets go.
#pragma once

#include "dormand_prince.hpp"
#include "drive_output.hpp"
#include "friction.hpp"
#include "machine.hpp"

namespace pmg::literature {

/// What acts from outside while the drive's output is held.
struct Forces {
  DriveOutput drive;
  Scales scales;
  double push_Nm = 0.0;  ///< on the load
};

class Mechanics {
 public:
  explicit Mechanics(const Machine& machine);

  /// At rest, nothing bent.
  void reset(double q_rad);
  void move(double duration_s, const Forces& forces);

  double load_rad() const { return state_[kLoad]; }
  double load_rad_s() const { return state_[kLoadSpeed]; }
  double motor_rad() const { return state_[elastic_ ? kMotor : kLoad]; }
  double motor_rad_s() const { return state_[elastic_ ? kMotorSpeed : kLoadSpeed]; }
  double dissipated_J() const { return state_[kWork]; }  ///< by friction
  bool sticks() const { return stops_ && slides_ == 0; }
  double energy_J() const;  ///< of rotor, load, shaft and gravity

 private:
  enum Index { kMotor, kMotorSpeed, kLoad, kLoadSpeed, kBristle, kBelt, kScrew, kWork, kStates };
  using State = std::array<double, kStates>;

  State slope(const State& at, const Forces& forces) const;
  /// (state, external torque, slopes so far) => accelerations of a rigid or an elastic joint, and friction's torque.
  double rigid(const State& at, const Forces& forces, State& slope) const;
  double elastic(const State& at, const Forces& forces, State& slope) const;
  double motor_Nm(const State& at, const Forces& forces, double speed_rad_s) const;
  double outside_Nm(const State& at, const Forces& forces) const;
  double shaft_Nm(const State& at) const;
  double inertia_kg_m2(const State& at) const;
  double gravity_Nm(const State& at) const;
  /// How far dry friction is taken up, -1 to 1, against positive motion.
  double taken_up(const State& at, const Forces& forces) const;
  double bristle_rate(const State& at, const Forces& forces) const;
  double held_push_Nm(const State& at, const Forces& forces) const;
  double breakaway_Nm(const State& at, const Forces& forces, double direction) const;
  double angle(const State& at) const { return at[elastic_ && !machine_.friction.at_load ? kMotor : kLoad]; }
  Index speed() const { return elastic_ && !machine_.friction.at_load ? kMotorSpeed : kLoadSpeed; }

  Machine machine_;
  bool elastic_, stops_;  ///< stops: dry friction that holds still
  DormandPrince<kStates> solver_;
  State state_{};
  int slides_ = 0;
  double rested_s_ = 0.0;
};

}  // namespace pmg::literature
