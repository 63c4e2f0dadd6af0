// One hidden plant: every effect beside the others. They act on one state.
#include "plant.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::hidden {

namespace {

constexpr int kSlipElements = 8;
constexpr double kReference_C = 25.0;

}  // namespace

Plant::Plant(const PlantParameters& parameters)
    : p_(parameters),
      elastic_(std::isfinite(parameters.transmission.stiffness_Nm_per_rad)),
      dry_(parameters.strange.lugre_width_rad == 0.0 && parameters.strange.maxwell_width_rad == 0.0),
      lugre_(parameters.strange.lugre_width_rad > 0.0),
      angle_(elastic_ ? kRotor : kLoad),
      speed_(elastic_ ? kRotorSpeed : kLoadSpeed) {
  if (p_.strange.maxwell_width_rad > 0.0) {  // elements that slip one after the other share the Coulomb friction
    for (int i = 1; i <= kSlipElements; ++i) {
      const double most_Nm = p_.friction.coulomb_Nm / kSlipElements;
      const double slips_at_rad = p_.strange.maxwell_width_rad * i / kSlipElements;
      slip_elements_.push_back({most_Nm / slips_at_rad, most_Nm, 0.0, 0.0});
    }
  }
  p_.body.load_inertia_kg_m2 *= p_.body.inertia_factor;
  p_.body.load_gravity_Nm *= p_.body.gravity_factor;
  reset(0.0);
}

void Plant::reset(double q_rad, double temperature_C) {
  state_ = {};
  state_[kLoad] = state_[kRotor] = sensor_rad_ = q_rad;
  temperature_C_ = temperature_C;
  state_[kLagged] = limited_rad_ = reading_rad();
  time_s_ = disturbance_Nm_ = held_Nm_ = emf_slope_ = torque_before_Nm_ = 0.0;
  slides_ = 0;
  told_ = {{-kNever, limited_rad_}};
  for (SlipElement& element : slip_elements_) element.bend_rad = 0.0, element.from_rad = q_rad;
  warm(0.0);
}

double Plant::reading_rad(double noise_rad) const {
  const PlantParameters::Sensor& s = p_.sensor;
  const double shown_rad =
      sensor_rad_ + s.offset_rad + s.eccentricity_rad * std::sin(sensor_rad_ + s.eccentricity_phase_rad) + noise_rad;
  return s.quantum_rad > 0.0 ? s.quantum_rad * std::round(shown_rad / s.quantum_rad) : shown_rad;
}

/// The play operator: the sensor's end stays until the joint takes it along.
void Plant::drag_sensor() {
  const double half_rad = 0.5 * p_.sensor.play_rad;
  sensor_rad_ = std::clamp(sensor_rad_, state_[kLoad] - half_rad, state_[kLoad] + half_rad);
}

void Plant::advance(double duration_s, const PlantCommand& command) {
  if (told_.back().q_rad != command.q_rad) told_.push_back({time_s_, command.q_rad});
  const int steps = std::max(1, static_cast<int>(std::ceil(duration_s / kStep_s - 1e-9)));
  const double h = duration_s / steps;
  const double most_rad = p_.command.rate_limit_rad_s * h;
  for (int k = 0; k < steps; ++k) {
    const double wanted_rad = command_now(command);
    limited_rad_ += std::clamp(wanted_rad - limited_rad_, -most_rad, most_rad);
    drive(command);
    move(h);
    drag_sensor();
    warm(h);
    time_s_ += h;
  }
  while (told_.size() > 1 && told_[1].from_s <= time_s_ - p_.command.delay_s) told_.pop_front();
}

double Plant::command_now(const PlantCommand& command) const {
  if (p_.command.delay_s == 0.0) return command.q_rad;
  double q_rad = told_.front().q_rad;
  for (const Told& told : told_) {
    if (told.from_s > time_s_ - p_.command.delay_s + 1e-9) break;
    q_rad = told.q_rad;
  }
  return q_rad;
}

void Plant::drive(const PlantCommand& command) {
  const double motor_rad_s = state_[speed_];
  double seen_rad = reading_rad(), seen_rad_s = motor_rad_s;
  if (p_.sensor.lag_s > 0.0) {
    seen_rad_s = (seen_rad - state_[kLagged]) / p_.sensor.lag_s;
    seen_rad = state_[kLagged];
  }
  held_Nm_ = emf_slope_ = 0.0;
  if (!command.enabled) return;
  double error_rad = limited_rad_ - seen_rad;
  if (std::abs(error_rad) < p_.drive.dead_band_rad) error_rad = 0.0;
  const double wish = p_.drive.kp_factor * command.kp * error_rad - p_.drive.kd_factor * command.kd * seen_rad_s;
  if (p_.drive.servo)
    bridge(wish, command.bus_V);
  else
    held_Nm_ = regulated_torque_Nm(wish, motor_rad_s);
  const double strength = 1.0 + p_.thermal.torque_per_K * (temperature_C_ - kReference_C);
  held_Nm_ *= strength;
  emf_slope_ *= strength;
  torque_before_Nm_ = held_Nm_ - emf_slope_ * motor_rad_s;
}

/// The bus loses a share sag duty torque of itself to its source, and the torque follows the bus: solved for both at
/// once.
void Plant::bridge(double wish, double bus_V) {
  const PlantParameters::Drive& d = p_.drive;
  const double duty = std::clamp(wish, -1.0, 1.0);
  const double sags = 1.0 + d.sag_per_Nm * d.torque_Nm_per_V * bus_V * duty * duty;
  held_Nm_ = d.torque_Nm_per_V * duty * bus_V / sags;
  emf_slope_ = d.torque_Nm_per_V * d.back_emf_V_s_per_rad / sags;
}

double Plant::regulated_torque_Nm(double wish, double motor_rad_s) const {
  const PlantParameters::Drive& d = p_.drive;
  const double torque_Nm = std::clamp(wish, -d.limit, d.limit);
  if (!std::isfinite(d.stall_torque_Nm)) return torque_Nm;
  const double towards = torque_Nm >= 0.0 ? 1.0 : -1.0;
  const double can_Nm = d.stall_torque_Nm * std::clamp(1.0 - towards * motor_rad_s / d.no_load_rad_s, 0.0, 1.0);
  return towards * std::min(std::abs(torque_Nm), can_Nm);
}

void Plant::warm(double h) {
  const PlantParameters::Thermal& t = p_.thermal;
  const double settles_C = kReference_C + t.heating_K_per_Nm2 * torque_before_Nm_ * torque_before_Nm_;
  if (t.heating_K_per_Nm2 > 0.0) temperature_C_ += h / t.time_constant_s * (settles_C - temperature_C_);
  friction_scale_ = t.friction_per_K == 0.0 ? 1.0 : std::exp(t.friction_per_K * (temperature_C_ - kReference_C));
}

/// Slides until the speed crosses zero, then sticks if friction can hold what pushes.
void Plant::move(double h) {
  if (!dry_) {
    state_ = rk4(state_, h);
    settle_slip_elements(state_[angle_]);
    return;
  }
  double left_s = h;
  for (int turn = 0; turn < 4 && left_s > 0.0; ++turn) {
    if (slides_ == 0) {
      const double push = push_Nm(state_);
      const int direction = push >= 0.0 ? 1 : -1;
      if (std::abs(push) > breakaway_Nm(state_, direction)) slides_ = direction;
    }
    State next = rk4(state_, left_s);
    if (slides_ == 0 || next[speed_] * slides_ > 0.0) {
      state_ = next;
      return;
    }
    double before_s = 0.0, before = state_[speed_], after_s = left_s, after = next[speed_];
    for (int i = 0; i < 4 && before != after; ++i) {  // regula falsi: speed is all but straight over 0.1 ms
      const double at_s = before_s + (after_s - before_s) * before / (before - after);
      next = rk4(state_, at_s);
      if (std::abs(next[speed_]) < 1e-12) break;
      if (next[speed_] * slides_ > 0.0)
        before_s = at_s, before = next[speed_];
      else
        after_s = at_s, after = next[speed_];
    }
    if (before == 0.0) next = state_, after_s = 0.0;  // pushed back at once: it doesn't come off
    state_ = next;
    state_[speed_] = 0.0;
    slides_ = 0;
    left_s -= after_s;
    if (after_s == 0.0) break;
  }
  if (left_s > 0.0) state_ = rk4(state_, left_s);  // held for the rest of this tenth of a millisecond
}

Plant::State Plant::rk4(const State& at, double h) const {
  const auto ahead = [&](const State& slope, double by) {
    State to = at;
    for (std::size_t i = 0; i < to.size(); ++i) to[i] += by * slope[i];
    return to;
  };
  const State k1 = derivative(at), k2 = derivative(ahead(k1, 0.5 * h)), k3 = derivative(ahead(k2, 0.5 * h)),
              k4 = derivative(ahead(k3, h));
  State to = at;
  for (std::size_t i = 0; i < to.size(); ++i) to[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
  return to;
}

double Plant::smooth_rotor_torque_Nm(double rotor_rad, double rotor_rad_s) const {
  double torque_Nm =
      held_Nm_ + p_.ripple.offset_Nm - (emf_slope_ + friction_scale_ * p_.friction.viscous_Nm_s_per_rad) * rotor_rad_s;
  if (p_.ripple.cogging_Nm != 0.0) {
    torque_Nm += p_.ripple.cogging_Nm * std::sin(p_.ripple.cogging_order * rotor_rad + p_.ripple.cogging_phase_rad);
  }
  return torque_Nm;
}

double Plant::load_torque_Nm(const State& at) const {
  const PlantParameters::Strange& s = p_.strange;
  const double q_rad = at[kLoad];
  double torque_Nm = disturbance_Nm_ - p_.body.load_gravity_Nm * std::sin(q_rad);
  if (s.cable_Nm_per_rad > 0.0 && std::abs(q_rad) > s.cable_slack_rad) {
    torque_Nm -= s.cable_Nm_per_rad * std::copysign(std::abs(q_rad) - s.cable_slack_rad, q_rad);
  }
  return torque_Nm;
}

double Plant::shaft_Nm(const State& at) const {
  const PlantParameters::Transmission& t = p_.transmission;
  const double twist_rad = at[kRotor] - at[kLoad], rate_rad_s = at[kRotorSpeed] - at[kLoadSpeed];
  if (t.backlash_rad == 0.0) return t.stiffness_Nm_per_rad * twist_rad + t.damping_Nm_s_per_rad * rate_rad_s;
  const double half_rad = 0.5 * t.backlash_rad;
  if (std::abs(twist_rad) <= half_rad) return 0.0;
  const double side = twist_rad > 0.0 ? 1.0 : -1.0;
  const double pressed_rad = std::abs(twist_rad) - half_rad;
  return side * std::max(0.0, t.stiffness_Nm_per_rad * pressed_rad + side * t.damping_Nm_s_per_rad * rate_rad_s);
}

/// Without what depends on load and direction.
double Plant::dry_level_Nm(double angle_rad, double speed_rad_s) const {
  const PlantParameters::Friction& f = p_.friction;
  double level_Nm = f.coulomb_Nm;
  if (f.stribeck_Nm != 0.0) {
    const double ratio = speed_rad_s / f.stribeck_rad_s;
    level_Nm += f.stribeck_Nm * std::exp(-ratio * ratio);
  }
  if (p_.strange.rub_Nm > 0.0) {
    const double away = (angle_rad - p_.strange.rub_at_rad) / p_.strange.rub_width_rad;
    level_Nm += p_.strange.rub_Nm * std::exp(-away * away);
  }
  return friction_scale_ * level_Nm;
}

double Plant::push_Nm(const State& at) const {
  const double smooth_Nm = smooth_rotor_torque_Nm(at[angle_], 0.0);
  return smooth_Nm + (elastic_ ? -shaft_Nm(at) : load_torque_Nm(at));
}

double Plant::breakaway_Nm(const State& at, int direction) const {
  const PlantParameters::Friction& f = p_.friction;
  const double through_gear_Nm = elastic_ ? shaft_Nm(at) : -load_torque_Nm(at);
  const double share = through_gear_Nm * direction > 0.0 ? f.load_driving : f.load_backdriving;
  const double level_Nm = dry_level_Nm(at[angle_], 0.0) + friction_scale_ * share * std::abs(through_gear_Nm);
  return level_Nm * (1.0 + f.asymmetry * direction);
}

/// LuGre's bristles: dz = v - sigma0 |v| / g(v) z, with sigma0 = coulomb / width.
double Plant::bristle_rate(const State& at, double speed_rad_s) const {
  const double stiffness = p_.friction.coulomb_Nm / p_.strange.lugre_width_rad;
  return speed_rad_s - stiffness * std::abs(speed_rad_s) / dry_level_Nm(at[angle_], speed_rad_s) * at[kBristle];
}

double Plant::slip_elements_Nm(double angle_rad) const {
  double torque_Nm = 0.0;
  for (const SlipElement& e : slip_elements_) {
    torque_Nm += std::clamp(e.stiffness * (e.bend_rad + angle_rad - e.from_rad), -e.most_Nm, e.most_Nm);
  }
  return torque_Nm;
}

void Plant::settle_slip_elements(double angle_rad) {
  for (SlipElement& e : slip_elements_) {
    const double most_rad = e.most_Nm / e.stiffness;
    e.bend_rad = std::clamp(e.bend_rad + angle_rad - e.from_rad, -most_rad, most_rad);
    e.from_rad = angle_rad;
  }
}

Plant::State Plant::derivative(const State& at) const {
  const PlantParameters::Friction& f = p_.friction;
  State slope{};
  slope[kLoad] = at[kLoadSpeed];
  if (p_.sensor.lag_s > 0.0)
    slope[kLagged] = (reading_rad() + at[kLoad] - state_[kLoad] - at[kLagged]) / p_.sensor.lag_s;
  const double angle_rad = at[angle_], speed_rad_s = at[speed_];
  const bool held = dry_ && slides_ == 0;
  double smooth_Nm = smooth_rotor_torque_Nm(angle_rad, speed_rad_s);
  if (lugre_) {
    slope[kBristle] = bristle_rate(at, speed_rad_s);
    const double stiffness = f.coulomb_Nm / p_.strange.lugre_width_rad;
    smooth_Nm -= stiffness * (at[kBristle] + p_.strange.lugre_damping_s * slope[kBristle]);
  } else if (!dry_) {
    smooth_Nm -= slip_elements_Nm(angle_rad);
  }
  const double direction = slides_;
  const double lopsided = 1.0 + f.asymmetry * direction;
  const double level_Nm = dry_ ? direction * lopsided * dry_level_Nm(angle_rad, speed_rad_s) : 0.0;
  const auto share = [&](double through_gear_Nm) {
    if (!dry_) return 0.0;
    return friction_scale_ * lopsided * (through_gear_Nm * direction > 0.0 ? f.load_driving : -f.load_backdriving);
  };
  if (elastic_) {
    const double shaft = shaft_Nm(at);
    slope[kRotor] = at[kRotorSpeed];
    slope[kLoadSpeed] = (shaft + load_torque_Nm(at)) / p_.body.load_inertia_kg_m2;
    const double rotor_Nm = smooth_Nm - level_Nm - (1.0 + share(shaft)) * shaft;
    slope[kRotorSpeed] = held ? 0.0 : rotor_Nm / p_.body.rotor_inertia_kg_m2;
    return slope;
  }
  if (held) {
    slope[kLoad] = 0.0;
    return slope;
  }
  // What the gear carries, T, is the load's inertia and outside torque. Friction that depends on it takes direction
  // times a share of |T|, which is +-share of T itself: one linear equation for each sign of T.
  const double outside_Nm = load_torque_Nm(at);
  const double inertias = p_.body.rotor_inertia_kg_m2 / p_.body.load_inertia_kg_m2;
  const double right_Nm = smooth_Nm - level_Nm - inertias * outside_Nm;
  const double through_gear_Nm = right_Nm / (1.0 + inertias + share(right_Nm));
  slope[kLoadSpeed] = (through_gear_Nm + outside_Nm) / p_.body.load_inertia_kg_m2;
  return slope;
}

double Plant::energy_J() const {
  const PlantParameters::Body& b = p_.body;
  const double rotor_rad_s = state_[speed_];
  double energy_J = 0.5 * b.load_inertia_kg_m2 * state_[kLoadSpeed] * state_[kLoadSpeed] +
                    0.5 * b.rotor_inertia_kg_m2 * rotor_rad_s * rotor_rad_s +
                    b.load_gravity_Nm * (1.0 - std::cos(state_[kLoad]));
  if (elastic_) {
    const double half_rad = 0.5 * p_.transmission.backlash_rad, twist_rad = state_[kRotor] - state_[kLoad];
    const double wound_rad = twist_rad - std::clamp(twist_rad, -half_rad, half_rad);
    energy_J += 0.5 * p_.transmission.stiffness_Nm_per_rad * wound_rad * wound_rad;
  }
  return energy_J;
}

}  // namespace pmg::hidden
