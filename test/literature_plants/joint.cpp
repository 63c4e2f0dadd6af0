#include "joint.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::literature {

Joint::Joint(const Machine& machine, std::uint64_t stream)
    : m_(machine), mechanics_(machine), sensor_(machine.sensor), drive_(machine, Draw(stream, 31)) {}

void Joint::reset(double q_rad, const Command& command, double temperature_C) {
  mechanics_.reset(q_rad);
  sensor_.reset(q_rad);
  drive_.reset(command);
  forces_ = {};
  t_s_ = torque_Nm_ = heat_Nm2_s_ = 0.0;
  temperature_C_ = temperature_C;
  ticks_ = 0;
}

double Joint::sensed_rad() const { return m_.sensor.before_gear ? mechanics_.motor_rad() : mechanics_.load_rad(); }

double Joint::reading_rad(double noise_rad) {
  sensor_.follow(t_s_, sensed_rad(), mechanics_.motor_rad_s());
  return sensor_.reading_rad(noise_rad);
}

/// H grows by the drive's torque squared and cools. Friction, dry and viscous, follows exp(friction_per_K (T - 25) +
/// friction_per_Nm2_s H + friction_per_J W), because lubricants thin exponentially (Simoni et al. 2015); torque is
/// linear in T, as data sheets give it for magnets, and a warm winding (Hanselman 2006) takes less current per volt.
void Joint::warm(double h_s) {
  const Machine::Thermal& t = m_.thermal;
  heat_Nm2_s_ += h_s * (torque_Nm_ * torque_Nm_ - heat_Nm2_s_ / t.cooling_s);
  const double above_K = temperature_C_ - kReference_C;
  Scales& s = forces_.scales;
  s.friction = std::exp(t.friction_per_K * above_K + t.friction_per_Nm2_s * heat_Nm2_s_ +
                        t.friction_per_J * mechanics_.dissipated_J());
  s.viscous = s.friction * std::exp(t.viscous_per_K * above_K);
  s.torque = (1.0 + t.torque_per_K * above_K) / (1.0 + t.resistance_per_K * above_K);
  s.torque *= std::max(0.2, 1.0 - t.torque_per_Nm2_s * heat_Nm2_s_);
  s.torque *= 1.0 - t.fade_share * (1.0 - std::exp(-t_s_ / t.fade_s));
}

void Joint::tick() {
  sensor_.follow(t_s_, sensed_rad(), mechanics_.motor_rad_s());
  forces_.drive = drive_.tick(t_s_, sensor_.seen(t_s_), mechanics_.motor_rad_s());
  torque_Nm_ =
      drive_torque_Nm(m_, forces_.drive, forces_.scales.torque, mechanics_.motor_rad(), mechanics_.motor_rad_s());
  warm(1.0 / m_.drive.loop_hz);
  ++ticks_;
}

void Joint::advance(double duration_s, double push_Nm) {
  forces_.push_Nm = push_Nm;
  const double end_s = t_s_ + duration_s;
  while (end_s - t_s_ > 1e-12) {
    const double next_s = static_cast<double>(ticks_) / m_.drive.loop_hz;
    if (next_s <= t_s_ + 1e-9) {
      tick();
      continue;
    }
    const double until_s = std::min(end_s, next_s);
    mechanics_.move(until_s - t_s_, forces_);
    t_s_ = until_s;
  }
}

}  // namespace pmg::literature
