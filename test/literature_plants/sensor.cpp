#include "sensor.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::literature {

namespace {

constexpr double kReversal_rad = 1e-4;  // smaller motion doesn't turn a relay's direction

}  // namespace

void Sensor::reset(double angle_rad) {
  angle_rad_ = angle_rad;
  behind_rad_ = s_.play_form == SensorPlay::kRelay ? 0.5 * s_.play_rad : 0.0;
  const double shown = shown_rad(0.0, carried_rad(angle_rad));
  last_rad_ = s_.quantum_rad > 0.0 ? s_.quantum_rad * std::round(shown / s_.quantum_rad) : shown;
  past_ = {{-1.0, {shown, 0.0}}, {0.0, {shown, 0.0}}};
  averaged_.clear();
  taken_s_ = -1.0;
  filtered_rad_ = held_.q_rad = quantised(shown, last_rad_);
  filtered_rad_s_ = filtered_at_s_ = held_.dq_rad_s = 0.0;
}

double Sensor::carried_rad(double angle_rad) const { return angle_rad - behind_rad_; }

double Sensor::shown_rad(double t_s, double at_rad) const {
  double shown = s_.scale * at_rad + s_.offset_rad;
  if (s_.drift_rad != 0.0) shown += s_.drift_rad * (1.0 - std::exp(-t_s / s_.drift_s));
  if (s_.eccentricity_rad != 0.0) {
    const double turn = s_.eccentricity_order * at_rad + s_.eccentricity_phase_rad;
    shown += s_.eccentricity_rad * (std::sin(turn) + s_.eccentricity_second * std::sin(2.0 * turn + 0.7));
  }
  return shown;
}

void Sensor::follow(double t_s, double angle_rad, double speed_rad_s) {
  const double moved_rad = angle_rad - angle_rad_, half_rad = 0.5 * s_.play_rad;
  if (s_.play_rad > 0.0) {
    switch (s_.play_form) {
      case SensorPlay::kPlay:
        behind_rad_ = std::clamp(behind_rad_ + moved_rad, -half_rad, half_rad);
        break;
      case SensorPlay::kSmooth:
        behind_rad_ += moved_rad - std::abs(moved_rad) * behind_rad_ / half_rad;
        break;
      case SensorPlay::kRelay:
        if (std::abs(moved_rad) > kReversal_rad) behind_rad_ = std::copysign(half_rad, moved_rad);
        break;
    }
  }
  // A relay's direction shows only in motion of some size: the angle of the last turn stays.
  if (s_.play_form != SensorPlay::kRelay || s_.play_rad == 0.0 || std::abs(moved_rad) > kReversal_rad) {
    angle_rad_ = angle_rad;
  }
  const Sample now{t_s, {shown_rad(t_s, carried_rad(angle_rad)), s_.scale * speed_rad_s}};
  if (past_.back().t_s > t_s - 1e-9)
    past_.back() = now;
  else
    past_.push_back(now);
  while (past_.size() > 2 && past_[1].t_s < t_s - s_.delay_s - 1e-9) past_.pop_front();
}

double Sensor::quantised(double value_rad, double last_rad) const {
  const double step = s_.quantum_rad;
  if (step == 0.0) return value_rad;
  switch (s_.quantum_form) {
    case QuantumForm::kRound:
      return step * std::round(value_rad / step);
    case QuantumForm::kFloor:
      return step * std::floor(value_rad / step);
    case QuantumForm::kHysteresis:
      return std::abs(value_rad - last_rad) > 0.75 * step ? step * std::round(value_rad / step) : last_rad;
  }
  return value_rad;
}

Sensor::Seen Sensor::delayed(double t_s) const {
  if (s_.delay_s == 0.0) return past_.back().shown;
  const double from_s = t_s - s_.delay_s;
  std::size_t later = past_.size() - 1;
  while (later > 1 && past_[later - 1].t_s > from_s) --later;
  const Sample &a = past_[later - 1], &b = past_[later];
  const double share = std::clamp((from_s - a.t_s) / (b.t_s - a.t_s), 0.0, 1.0);
  return {a.shown.q_rad + share * (b.shown.q_rad - a.shown.q_rad),
          a.shown.dq_rad_s + share * (b.shown.dq_rad_s - a.shown.dq_rad_s)};
}

double Sensor::reading_rad(double noise_rad) const {
  return quantised(delayed(past_.back().t_s).q_rad + noise_rad, last_rad_);
}

Sensor::Seen Sensor::seen(double t_s) {
  Seen raw = delayed(t_s);
  last_rad_ = raw.q_rad = quantised(raw.q_rad, last_rad_);
  if (s_.hold_s > 0.0) {
    if (taken_s_ >= 0.0 && t_s - taken_s_ < s_.hold_s - 1e-9) return held_;
    taken_s_ = t_s;
    held_ = raw;
    return raw;
  }
  return s_.lag_s > 0.0 ? filtered(t_s, raw) : raw;
}

Sensor::Seen Sensor::filtered(double t_s, const Seen& raw) {
  const double h = t_s - filtered_at_s_;
  filtered_at_s_ = t_s;
  switch (s_.lag_form) {
    case LagForm::kFirstOrder: {
      const double before_rad = filtered_rad_;
      filtered_rad_ += (1.0 - std::exp(-h / s_.lag_s)) * (raw.q_rad - filtered_rad_);
      return {filtered_rad_, h > 0.0 ? (filtered_rad_ - before_rad) / h : 0.0};
    }
    case LagForm::kMovingAverage: {  // over twice the lag, so that the mean is late by the lag
      averaged_.push_back({t_s, raw});
      while (averaged_.front().t_s < t_s - 2.0 * s_.lag_s) averaged_.pop_front();
      Seen mean;
      for (const Sample& one : averaged_) mean.q_rad += one.shown.q_rad, mean.dq_rad_s += one.shown.dq_rad_s;
      const auto count = static_cast<double>(averaged_.size());
      return {mean.q_rad / count, mean.dq_rad_s / count};
    }
    case LagForm::kTracking: {  // x'' = w^2 (q - x) - 2 w x', of delay 2 / w at low frequency
      const double w = 2.0 / s_.lag_s;
      filtered_rad_s_ =
          (filtered_rad_s_ + h * w * w * (raw.q_rad - filtered_rad_)) / (1.0 + 2.0 * w * h + w * w * h * h);
      filtered_rad_ += h * filtered_rad_s_;
      return {filtered_rad_, filtered_rad_s_};
    }
  }
  return raw;
}

}  // namespace pmg::literature
