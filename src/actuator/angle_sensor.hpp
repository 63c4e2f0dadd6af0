// The drive's sensor: what it shows of an angle, and when the drive gets to know it.
#pragma once

#include <array>

#include "actuator/delay_line.hpp"
#include "actuator/period.hpp"
#include "model/actuator_parameters.hpp"

namespace pmg::actuator {

/// What a drive knows of its joint.
struct Seen {
  double q_rad, dq_rad_s;
};

inline Seen between(const Seen& a, const Seen& b, double share) noexcept {
  return {between(a.q_rad, b.q_rad, share), between(a.dq_rad_s, b.dq_rad_s, share)};
}

class AngleSensor {
 public:
  AngleSensor(const model::ActuatorParameters::Sensor& parameters, double step_s);

  /// At rest at this angle.
  void reset(double angle_rad) noexcept;

  /// (angle and speed at the sensor at the beginning of this step) => (what the drive works with).
  Seen step(double angle_rad, double dq_rad_s) noexcept {
    if (plain_)
      return {parameters_.angle_scale * angle_rad + parameters_.zero_offset_rad, parameters_.angle_scale * dq_rad_s};
    return stepped(angle_rad, dq_rad_s);
  }

  /// The reading of an angle that is reached `share` of a step after the step before began. With s = the angle behind
  /// the hysteresis:
  ///   quantised(scale s + zero_offset + eccentricity sin(order s + phase) + ellipticity sin(2 s + its phase)), delay_s
  ///   ago.
  double reading_rad(double angle_rad, double share) const noexcept;

  /// Inverse of reading_rad without quantum and delay, for an angle in the middle of the hysteresis.
  static double angle_rad(const model::ActuatorParameters::Sensor& parameters, double reading_rad);

  /// By how much the speed that the drive sees changes with the speed within the same step: less the later it comes,
  /// so that next to no delay is none.
  double prompt_speed() const noexcept { return prompt_speed_; }

  void restart_periods() noexcept { refresh_.restart(); }

 private:
  Seen stepped(double angle_rad, double dq_rad_s) noexcept;
  double followed_rad(double angle_rad) const noexcept;
  double shown_rad(double followed_rad) const noexcept;
  double quantised_rad(double shown_rad) const noexcept;

  model::ActuatorParameters::Sensor parameters_;
  double delay_steps_;
  bool delays_, lags_, velocity_lags_, round_, plain_;
  DelayLine<Seen> past_;
  Period refresh_;
  Seen held_{};
  double followed_rad_ = 0.0;  // angle of the sensor's side of its play
  int lag_stages_;
  double lag_share_;  // of the way to its input that each stage goes in a step
  double velocity_lag_share_, prompt_speed_;
  std::array<Seen, 3> lagged_{};  // after each stage of the lag
  double lagged_rad_s_ = 0.0;
};

}  // namespace pmg::actuator
