#include "actuator/angle_sensor.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::actuator {

namespace {

/// What a disc that is not round or not in its centre adds to the reading of this angle [rad].
double wobble_rad(const model::ActuatorParameters::Sensor& p, double angle_rad) noexcept {
  double added_rad = p.eccentricity_rad * std::sin(p.eccentricity_order * angle_rad + p.eccentricity_phase_rad);
  if (p.ellipticity_rad != 0.0) added_rad += p.ellipticity_rad * std::sin(2.0 * angle_rad + p.ellipticity_phase_rad);
  return added_rad;
}

}  // namespace

AngleSensor::AngleSensor(const model::ActuatorParameters::Sensor& parameters, double step_s)
    : parameters_(parameters),
      delay_steps_(parameters.delay_s / step_s),
      delays_(parameters.delay_s > 0.0),
      lags_(parameters.lag_s > 0.0),
      velocity_lags_(parameters.velocity_lag_s > 0.0),
      round_(parameters.eccentricity_rad == 0.0 && parameters.ellipticity_rad == 0.0),
      plain_(!delays_ && !lags_ && !velocity_lags_ && parameters.hold_s <= step_s && parameters.hysteresis_rad == 0.0 &&
             round_ && parameters.quantum_rad == 0.0),
      refresh_(parameters.hold_s, step_s),
      lag_stages_(static_cast<int>(parameters.lag_stages)),
      lag_share_(step_s / (parameters.lag_s / parameters.lag_stages + step_s)),
      velocity_lag_share_(step_s / (parameters.velocity_lag_s + step_s)),
      prompt_speed_(parameters.hold_s <= step_s ? parameters.angle_scale * share_within_step(delay_steps_) *
                                                      std::pow(lag_share_, lag_stages_) * velocity_lag_share_
                                                : 0.0) {}

void AngleSensor::reset(double angle_rad) noexcept {
  followed_rad_ = angle_rad;
  if (delays_) past_.fill({shown_rad(angle_rad), 0.0});
  lagged_.fill({quantised_rad(shown_rad(angle_rad)), 0.0});
  lagged_rad_s_ = 0.0;
  refresh_.restart();
}

/// The play operator: the sensor stays until the joint takes it along.
double AngleSensor::followed_rad(double angle_rad) const noexcept {
  const double half_rad = 0.5 * parameters_.hysteresis_rad;
  return half_rad > 0.0 ? std::clamp(followed_rad_, angle_rad - half_rad, angle_rad + half_rad) : angle_rad;
}

double AngleSensor::shown_rad(double followed_rad) const noexcept {
  const double shown = parameters_.angle_scale * followed_rad + parameters_.zero_offset_rad;
  return round_ ? shown : shown + wobble_rad(parameters_, followed_rad);
}

double AngleSensor::quantised_rad(double shown_rad) const noexcept {
  const double quantum = parameters_.quantum_rad;
  return quantum > 0.0 ? quantum * std::round(shown_rad / quantum) : shown_rad;
}

double AngleSensor::reading_rad(double angle_rad, double share) const noexcept {
  double shown = shown_rad(followed_rad(angle_rad));
  if (delays_) {
    const double ago = delay_steps_ - share;  // steps before the newest that is stored
    shown = ago >= 0.0 ? past_.at(ago).q_rad : between(shown, past_.at(0.0).q_rad, (share + ago) / share);
  }
  return quantised_rad(shown);
}

/// Solves scale q + wobble(q) = reading - offset by Newton's method; expect_simulable keeps the slope above 0.
double AngleSensor::angle_rad(const model::ActuatorParameters::Sensor& p, double reading_rad) {
  const double shown_rad = reading_rad - p.zero_offset_rad;
  if (p.eccentricity_rad == 0.0 && p.ellipticity_rad == 0.0) return shown_rad / p.angle_scale;
  double angle_rad = shown_rad / p.angle_scale;
  for (int i = 0; i < 20; ++i) {
    const double of_disc = p.eccentricity_order * p.eccentricity_rad *
                           std::cos(p.eccentricity_order * angle_rad + p.eccentricity_phase_rad);
    const double of_ellipse = 2.0 * p.ellipticity_rad * std::cos(2.0 * angle_rad + p.ellipticity_phase_rad);
    angle_rad -=
        (p.angle_scale * angle_rad + wobble_rad(p, angle_rad) - shown_rad) / (p.angle_scale + of_disc + of_ellipse);
  }
  return angle_rad;
}

/// Delay, quantum, lag, refresh period. The stages of a lag are of first order, implicit Euler:
///   lagged += h / (lag / stages + h) (reading - lagged).
/// The speed lags as the position does. As without a lag, it knows no quantum: a drive smooths the steps away.
Seen AngleSensor::stepped(double angle_rad, double dq_rad_s) noexcept {
  followed_rad_ = followed_rad(angle_rad);
  Seen seen{shown_rad(followed_rad_), parameters_.angle_scale * dq_rad_s};
  if (delays_) {
    past_.push(seen);
    seen = past_.at(delay_steps_);
  }
  seen.q_rad = quantised_rad(seen.q_rad);
  if (lags_) {
    for (int stage = 0; stage < lag_stages_; ++stage) {
      Seen& lagged = lagged_[static_cast<std::size_t>(stage)];
      lagged = between(lagged, seen, lag_share_);
      seen = lagged;
    }
  }
  if (velocity_lags_) {
    lagged_rad_s_ += velocity_lag_share_ * (seen.dq_rad_s - lagged_rad_s_);
    seen.dq_rad_s = lagged_rad_s_;
  }
  if (refresh_.every_step()) return seen;
  if (refresh_.due()) held_ = seen;
  return held_;
}

}  // namespace pmg::actuator
