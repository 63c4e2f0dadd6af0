#include "drive.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::literature {

void Drive::reset(const Command& command) {
  newest_ = taken_ = command;
  told_.clear();
  shaped_rad_ = command.q_rad;
  shaped_rad_s_ = integral_ = output_ = given_ = bus_lost_ = ticked_s_ = 0.0;
  taken_s_ = computed_s_ = -1.0;
  awake_ = true;
  outputs_.clear();
}

void Drive::tell(double t_s, const Command& command) {
  newest_ = command;  // switching off, gains and the bus don't travel
  const double late_s = m_.command.delay_s * (1.0 + (m_.command.delay_jitter > 0.0 ? draw_.uniform(-1.0, 1.0) : 0.0) *
                                                        m_.command.delay_jitter);
  told_.push_back({t_s + late_s, command});
}

/// The newest command that has arrived, taken once in so long where the drive holds it.
void Drive::take(double t_s) {
  if (m_.command.hold_s > 0.0) {
    if (taken_s_ >= 0.0 && t_s - taken_s_ < m_.command.hold_s - 1e-9) return;
    taken_s_ = t_s;
  }
  while (!told_.empty() && told_.front().arrives_s <= t_s + 1e-9) {
    taken_ = told_.front().command;
    told_.pop_front();
  }
}

/// A rate limit, or a profile with an acceleration limit as well (Biagiotti, Melchiorri 2008): towards the target at
/// the speed from which it can still brake.
void Drive::shape(double h_s) {
  const double away_rad = taken_.q_rad - shaped_rad_, most_rad_s = m_.command.rate_limit_rad_s;
  if (!std::isfinite(m_.command.acceleration_rad_s2)) {
    shaped_rad_ += std::clamp(away_rad, -most_rad_s * h_s, most_rad_s * h_s);
    return;
  }
  const double a = m_.command.acceleration_rad_s2;
  const double wanted_rad_s = std::copysign(
      std::min(most_rad_s, std::min(std::sqrt(2.0 * a * std::abs(away_rad)), std::abs(away_rad) / h_s)), away_rad);
  shaped_rad_s_ += std::clamp(wanted_rad_s - shaped_rad_s_, -a * h_s, a * h_s);
  shaped_rad_ += h_s * shaped_rad_s_;
}

double Drive::error_rad(double seen_rad) {
  const double error = shaped_rad_ - seen_rad, band = m_.drive.dead_band_rad;
  if (band == 0.0) return error;
  switch (m_.drive.dead_form) {
    case DeadBandForm::kJump:
      return std::abs(error) < band ? 0.0 : error;
    case DeadBandForm::kSubtract:
      return error - std::clamp(error, -band, band);
    case DeadBandForm::kHysteresis:
      if (std::abs(error) < band) awake_ = false;
      if (std::abs(error) > 2.0 * band) awake_ = true;
      return awake_ ? error : 0.0;
    case DeadBandForm::kOutput:
      break;
  }
  return error;
}

double Drive::wish(const Sensor::Seen& seen, double h_s) {
  const Machine::Drive& d = m_.drive;
  double output = taken_.feed_forward;
  if (d.law != Law::kTorque) {
    const double kp = d.kp_factor * newest_.kp, kd = d.kd_factor * newest_.kd, error = error_rad(seen.q_rad);
    const double dq_cmd_rad_s = d.law == Law::kServo ? 0.0 : taken_.dq_rad_s;
    output += kp * error + kd * (dq_cmd_rad_s - seen.dq_rad_s) + integral_;
    if (d.integral_per_s > 0.0 && !(std::abs(output) >= d.limit && output * error > 0.0)) {
      integral_ += h_s * d.integral_per_s * kp * error;
    }
  }
  if (d.dead_output > 0.0) output -= std::clamp(output, -d.dead_output, d.dead_output);
  return std::clamp(output, -d.limit, d.limit);
}

double Drive::late(double t_s, double output) {
  if (m_.drive.torque_delay_s == 0.0) return output;
  outputs_.emplace_back(t_s, output);
  while (outputs_.size() > 1 && outputs_[1].first <= t_s - m_.drive.torque_delay_s + 1e-9) outputs_.pop_front();
  return outputs_.front().first <= t_s - m_.drive.torque_delay_s + 1e-9 ? outputs_.front().second : 0.0;
}

/// Motor torque T = k (duty V - back_emf w). The bridge takes duty T from the bus, which loses a share s duty T of
/// itself:
///   T = k (duty V (1 - lost - s duty T) - back_emf w)  =>  T (1 + s k V duty^2) = k (duty V (1 - lost) - back_emf w).
DriveOutput Drive::bridge(double duty, double motor_rad_s, double h_s) {
  const Machine::Drive& d = m_.drive;
  const bool battery = d.sag_form == SagForm::kBattery;
  const double at_once = d.sag_per_Nm * (battery ? 0.4 : 1.0);
  const double sags = 1.0 + at_once * d.torque_per_unit * newest_.bus_V * duty * duty;
  DriveOutput output;
  output.held_Nm = d.torque_per_unit * duty * newest_.bus_V * (1.0 - bus_lost_) / sags;
  output.emf_slope = d.torque_per_unit * d.back_emf / sags;
  if (std::isfinite(d.sag_limit_Nm)) output.most_Nm = d.sag_limit_Nm / std::max(1e-3, std::abs(duty));
  if (battery) {
    const double feeds_Nm = duty * (output.held_Nm - output.emf_slope * motor_rad_s);
    bus_lost_ += h_s / d.sag_time_s * (0.6 * d.sag_per_Nm * feeds_Nm - bus_lost_);
  }
  return output;
}

DriveOutput Drive::tick(double t_s, const Sensor::Seen& seen, double motor_rad_s) {
  const double h_s = t_s - ticked_s_;
  ticked_s_ = t_s;
  take(t_s);
  shape(h_s);
  if (!newest_.enabled) {
    integral_ = given_ = output_ = 0.0;
    outputs_.clear();
    return {};
  }
  if (computed_s_ < 0.0 || t_s - computed_s_ >= m_.drive.hold_s - 1e-9) {
    const double since_s = computed_s_ < 0.0 ? 0.0 : t_s - computed_s_;
    computed_s_ = t_s;
    output_ = wish(seen, since_s);
  }
  const double most = m_.drive.output_rate_per_s * h_s;
  const double wanted = late(t_s, output_);
  given_ = std::isfinite(m_.drive.output_rate_per_s) ? given_ + std::clamp(wanted - given_, -most, most) : wanted;
  DriveOutput output;
  if (m_.drive.law == Law::kServo)
    output = bridge(given_, motor_rad_s, h_s);
  else
    output.held_Nm = m_.drive.torque_per_unit * given_;
  output.held_Nm += m_.drive.offset_when_on_Nm;
  return output;
}

}  // namespace pmg::literature
