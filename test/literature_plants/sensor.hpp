// From an angle to a reading, and to what the drive sees of it.
#pragma once

#include <deque>

#include "machine.hpp"

namespace pmg::literature {

class Sensor {
 public:
  explicit Sensor(const Machine::Sensor& sensor) : s_(sensor) { reset(0.0); }

  struct Seen {
    double q_rad = 0.0, dq_rad_s = 0.0;
  };

  /// At rest at that angle all along.
  void reset(double angle_rad);
  /// The angle and its speed at the time of a tick, which never falls.
  void follow(double t_s, double angle_rad, double speed_rad_s);
  /// What is recorded now, with electrical noise added before it is quantised.
  double reading_rad(double noise_rad) const;
  /// What the drive sees at this tick.
  Seen seen(double t_s);

 private:
  double carried_rad(double angle_rad) const;
  double shown_rad(double t_s, double at_rad) const;
  double quantised(double value_rad, double last_rad) const;
  Seen delayed(double t_s) const;
  Seen filtered(double t_s, const Seen& raw);

  Machine::Sensor s_;
  struct Sample {
    double t_s = 0.0;
    Seen shown;
  };
  std::deque<Sample> past_;      // as shown
  std::deque<Sample> averaged_;  // of the moving average
  double angle_rad_ = 0.0, behind_rad_ = 0.0, last_rad_ = 0.0, taken_s_ = -1.0;
  double filtered_rad_ = 0.0, filtered_rad_s_ = 0.0, filtered_at_s_ = 0.0;
  Seen held_{};
};

}  // namespace pmg::literature
