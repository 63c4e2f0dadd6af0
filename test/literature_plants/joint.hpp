// One joint on its bench: drive, sensor and mechanics together, with what heat makes of them.
#pragma once

#include "drive.hpp"
#include "mechanics.hpp"
#include "sensor.hpp"

namespace pmg::literature {

class Joint {
 public:
  explicit Joint(const Machine& machine, std::uint64_t stream = 0);

  /// At rest, commanded all along what the command says.
  void reset(double q_rad, const Command& command, double temperature_C = kReference_C);
  void tell(const Command& command) { drive_.tell(t_s_, command); }
  /// The drive ticks at its own rate; whatever is left of a tick at the end goes on at the next call.
  void advance(double duration_s, double push_Nm = 0.0);
  /// Of the sensor, at this moment.
  double reading_rad(double noise_rad = 0.0);

  const Mechanics& mechanics() const { return mechanics_; }
  double torque_Nm() const { return torque_Nm_; }  ///< of the drive, at its last tick

 private:
  void tick();
  double sensed_rad() const;
  void warm(double h_s);

  Machine m_;
  Mechanics mechanics_;
  Sensor sensor_;
  Drive drive_;
  Forces forces_;
  double t_s_ = 0.0, torque_Nm_ = 0.0, heat_Nm2_s_ = 0.0, temperature_C_ = kReference_C;
  long ticks_ = 0;
};

}  // namespace pmg::literature
