#include "mechanics.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::literature {

namespace {

constexpr double kContact_rad = 2e-3;  // penetration at which Hunt and Crossley's damping is the number given
constexpr int kMostTurns = 40;         // of sticking and sliding within one tick; then it sticks to its end

double sign(double value) { return value >= 0.0 ? 1.0 : -1.0; }

}  // namespace

Mechanics::Mechanics(const Machine& machine)
    : machine_(machine),
      elastic_(std::isfinite(machine.transmission.stiffness_Nm_per_rad)),
      stops_(machine.friction.dry == DryForm::kSign && has_dry_friction(machine)) {
  reset(0.0);
}

void Mechanics::reset(double q_rad) {
  state_ = {};
  state_[kMotor] = state_[kLoad] = q_rad;
  slides_ = 0;
  rested_s_ = 0.0;
}

void Mechanics::move(double duration_s, const Forces& forces) {
  const auto slopes = [&](const State& at) { return slope(at, forces); };
  if (!stops_) {
    solver_.advance(slopes, state_, duration_s, [](const State&) { return 1.0; });
    return;
  }
  double left_s = duration_s;
  for (int turn = 0; left_s > 1e-12; ++turn) {
    const double push_Nm = held_push_Nm(state_, forces);
    if (slides_ == 0 && turn < kMostTurns && std::abs(push_Nm) > breakaway_Nm(state_, forces, sign(push_Nm))) {
      slides_ = push_Nm > 0.0 ? 1 : -1;
      rested_s_ = 0.0;
    }
    if (slides_ == 0) {
      const auto holds = [&](const State& at) {
        const double push = held_push_Nm(at, forces);
        return turn < kMostTurns ? breakaway_Nm(at, forces, sign(push)) - std::abs(push) : 1.0;
      };
      const double passed_s = solver_.advance(slopes, state_, left_s, holds);
      rested_s_ += passed_s;
      if (passed_s < left_s) {
        slides_ = held_push_Nm(state_, forces) > 0.0 ? 1 : -1;
        rested_s_ = 0.0;
      }
      left_s -= passed_s;
      continue;
    }
    const int direction = slides_;
    const double passed_s =
        solver_.advance(slopes, state_, left_s, [&](const State& at) { return at[speed()] * direction; });
    if (passed_s < left_s || state_[speed()] * direction < 0.0) {
      state_[speed()] = 0.0;
      slides_ = 0;
    }
    left_s -= passed_s;
  }
}

double Mechanics::inertia_kg_m2(const State& at) const {
  const Machine::Body& b = machine_.body;
  const double out = 1.0 + at[kScrew];
  return b.load_inertia_kg_m2 * b.inertia_factor * out * out + b.more_inertia_kg_m2;
}

double Mechanics::gravity_Nm(const State& at) const {
  const Machine::Body& b = machine_.body;
  return b.load_gravity_Nm * b.gravity_factor * (1.0 + at[kScrew]) + b.more_gravity_Nm;
}

double Mechanics::outside_Nm(const State& at, const Forces& forces) const {
  const Machine::Ripple& r = machine_.ripple;
  double torque_Nm = forces.push_Nm - gravity_Nm(at) * std::sin(at[kLoad]);
  if (r.latch_Nm != 0.0) {  // (x/w) (1 + (x/w)^2)^(-5/2), of largest value 0.286
    const double x = (at[kLoad] - r.latch_at_rad) / r.latch_width_rad, y = 1.0 + x * x;
    torque_Nm -= r.latch_Nm / 0.286 * x / (y * y * std::sqrt(y));
  }
  return torque_Nm;
}

double Mechanics::motor_Nm(const State& at, const Forces& forces, double speed_rad_s) const {
  const Machine::Ripple& r = machine_.ripple;
  const double angle_rad = at[elastic_ ? kMotor : kLoad];
  double torque_Nm = drive_torque_Nm(machine_, forces.drive, forces.scales.torque, angle_rad, speed_rad_s) +
                     r.offset_Nm - r.preload_Nm_per_rad * angle_rad;
  if (r.cogging_Nm != 0.0) {
    const double turn = r.cogging_order * angle_rad + r.cogging_phase_rad;
    torque_Nm += r.cogging_Nm * (std::sin(turn) + r.second_share * std::sin(2.0 * turn + 1.0));
  }
  return torque_Nm;
}

double Mechanics::shaft_Nm(const State& at) const {
  const Machine::Transmission& t = machine_.transmission;
  const double twist_rad = at[kMotor] - at[kLoad], rate_rad_s = at[kMotorSpeed] - at[kLoadSpeed];
  if (t.backlash_rad == 0.0) {
    const double bent_rad = (1.0 - t.belt_share) * twist_rad + t.belt_share * at[kBelt];
    return t.stiffness_Nm_per_rad * bent_rad + t.hardening_Nm_per_rad3 * twist_rad * twist_rad * twist_rad +
           t.damping_Nm_s_per_rad * rate_rad_s;
  }
  const double soft_Nm = t.contact == ContactForm::kSoftGap
                             ? t.gap_stiffness_Nm_per_rad * twist_rad + 0.1 * t.damping_Nm_s_per_rad * rate_rad_s
                             : 0.0;
  const double pressed_rad = std::abs(twist_rad) - 0.5 * t.backlash_rad;
  if (pressed_rad <= 0.0) return soft_Nm;
  const double side = sign(twist_rad), closing_rad_s = side * rate_rad_s;
  const double damping = t.contact == ContactForm::kHuntCrossley ? t.damping_Nm_s_per_rad * pressed_rad / kContact_rad
                                                                 : t.damping_Nm_s_per_rad;
  return soft_Nm + side * std::max(0.0, t.stiffness_Nm_per_rad * pressed_rad + damping * closing_rad_s);
}

double Mechanics::bristle_rate(const State& at, const Forces& forces) const {
  const Machine::Friction& f = machine_.friction;
  const double speed_rad_s = at[speed()];
  // LuGre's bristle bends by level(v) / (coulomb / width); Dahl's by the width.
  double most_rad = f.bristle_rad;
  if (f.dry == DryForm::kLuGre) {
    const double level_Nm = dry_level_Nm(f, forces.scales, angle(at), speed_rad_s, sign(speed_rad_s));
    most_rad *= level_Nm / std::max(1e-9, forces.scales.friction * f.coulomb_Nm);
  }
  return speed_rad_s - std::abs(speed_rad_s) * at[kBristle] / most_rad;
}

double Mechanics::taken_up(const State& at, const Forces& forces) const {
  const Machine::Friction& f = machine_.friction;
  switch (f.dry) {
    case DryForm::kSign:
      return slides_;
    case DryForm::kTanh:
      return std::tanh(at[speed()] / f.smoothing_rad_s);
    case DryForm::kDahl:
      return at[kBristle] / f.bristle_rad;
    case DryForm::kLuGre: {  // coulomb / width (z + damping dz/dt), over the level
      const double level_Nm = dry_level_Nm(f, forces.scales, angle(at), at[speed()], sign(at[speed()]));
      const double bent = at[kBristle] + f.bristle_damping_s * bristle_rate(at, forces);
      return forces.scales.friction * f.coulomb_Nm * bent / f.bristle_rad / std::max(1e-9, level_Nm);
    }
  }
  return 0.0;
}

double Mechanics::held_push_Nm(const State& at, const Forces& forces) const {
  if (!elastic_) return motor_Nm(at, forces, 0.0) + outside_Nm(at, forces);
  if (machine_.friction.at_load) return shaft_Nm(at) + outside_Nm(at, forces);
  return motor_Nm(at, forces, 0.0) - shaft_Nm(at);
}

double Mechanics::breakaway_Nm(const State& at, const Forces& forces, double direction) const {
  const Machine::Friction& f = machine_.friction;
  const double outside = outside_Nm(at, forces), motor = motor_Nm(at, forces, 0.0);
  const double carried_Nm = elastic_ ? shaft_Nm(at) : -outside;
  const LoadShare share = load_share(f, motor, outside, carried_Nm * direction > 0.0);
  double level_Nm = dry_level_Nm(f, forces.scales, angle(at), 0.0, direction) +
                    forces.scales.friction * (1.0 + f.asymmetry * direction) *
                        (share.of_transmitted * std::abs(carried_Nm) + share.besides_Nm);
  if (f.dwell_Nm > 0.0) level_Nm += f.dwell_Nm * (1.0 - std::exp(-rested_s_ / f.dwell_s));
  return level_Nm;
}

/// T is what the gear carries: rotor J_m a = m - s (level + share |T|) - T, load J_l a = T + o. So
///   T (1 + J_m / J_l + s share sign(T)) = m - s level - J_m / J_l o.
double Mechanics::rigid(const State& at, const Forces& forces, State& to) const {
  const Machine::Friction& f = machine_.friction;
  const double speed_rad_s = at[kLoadSpeed], s = taken_up(at, forces), direction = stops_ ? slides_ : sign(speed_rad_s);
  const double load = inertia_kg_m2(at), ratio = machine_.body.rotor_inertia_kg_m2 / load;
  const double outside = outside_Nm(at, forces), motor = motor_Nm(at, forces, speed_rad_s);
  const double scale = forces.scales.friction * (1.0 + f.asymmetry * direction);
  const double viscous = viscous_Nm(f, forces.scales, speed_rad_s);
  const LoadShare besides = load_share(f, motor, outside, true);
  const double level_Nm =
      dry_level_Nm(f, forces.scales, angle(at), speed_rad_s, direction) + scale * besides.besides_Nm;
  const double right_Nm = motor - viscous - s * level_Nm - ratio * outside;
  const LoadShare share = load_share(f, motor, outside, right_Nm * s > 0.0);
  const double carried_Nm = right_Nm / (1.0 + ratio + s * scale * share.of_transmitted * sign(right_Nm));
  if (stops_ && slides_ == 0) return 0.0;
  to[kLoad] = speed_rad_s;
  to[kLoadSpeed] = (carried_Nm + outside) / load;
  return viscous + s * (level_Nm + scale * share.of_transmitted * std::abs(carried_Nm));
}

double Mechanics::elastic(const State& at, const Forces& forces, State& to) const {
  const Machine::Friction& f = machine_.friction;
  const double speed_rad_s = at[speed()], s = taken_up(at, forces), direction = stops_ ? slides_ : sign(speed_rad_s);
  const double outside = outside_Nm(at, forces), motor = motor_Nm(at, forces, at[kMotorSpeed]), shaft = shaft_Nm(at);
  const double scale = forces.scales.friction * (1.0 + f.asymmetry * direction);
  const LoadShare share = load_share(f, motor, outside, shaft * direction > 0.0);
  const double friction_Nm = viscous_Nm(f, forces.scales, speed_rad_s) +
                             s * (dry_level_Nm(f, forces.scales, angle(at), speed_rad_s, direction) +
                                  scale * (share.of_transmitted * std::abs(shaft) + share.besides_Nm));
  const bool held = stops_ && slides_ == 0;
  if (!(held && !f.at_load)) {
    to[kMotor] = at[kMotorSpeed];
    to[kMotorSpeed] = (motor - shaft - (f.at_load ? 0.0 : friction_Nm)) / machine_.body.rotor_inertia_kg_m2;
  }
  if (!(held && f.at_load)) {
    to[kLoad] = at[kLoadSpeed];
    to[kLoadSpeed] = (shaft + outside - (f.at_load ? friction_Nm : 0.0)) / inertia_kg_m2(at);
  }
  if (machine_.transmission.belt_share > 0.0) {
    const double rate_rad_s = at[kMotorSpeed] - at[kLoadSpeed];
    to[kBelt] = rate_rad_s - std::abs(rate_rad_s) * at[kBelt] / machine_.transmission.belt_width_rad;
  }
  return friction_Nm;
}

Mechanics::State Mechanics::slope(const State& at, const Forces& forces) const {
  State to{};
  const Machine::Friction& f = machine_.friction;
  if (f.dry == DryForm::kDahl || f.dry == DryForm::kLuGre) to[kBristle] = bristle_rate(at, forces);
  const double friction_Nm = elastic_ ? elastic(at, forces, to) : rigid(at, forces, to);
  to[kWork] = friction_Nm * at[speed()];
  const Machine::Screw& screw = machine_.screw;
  if (screw.most_share > 0.0) {
    const double swing = screw.length_m * (1.0 + at[kScrew]) * at[kLoadSpeed] * at[kLoadSpeed];
    const double pull = (swing + kGravity_m_s2 * std::cos(at[kLoad])) / screw.holds_m_s2 - 1.0;
    to[kScrew] = std::max(0.0, pull) / screw.creep_s * std::max(0.0, screw.most_share - at[kScrew]);
    const double slid = 2.0 * machine_.body.load_inertia_kg_m2 * (1.0 + at[kScrew]) * to[kScrew];
    to[kLoadSpeed] -= slid * at[kLoadSpeed] / inertia_kg_m2(at);  // what is slung outwards keeps its momentum
  }
  return to;
}

double Mechanics::energy_J() const {
  const Machine::Transmission& t = machine_.transmission;
  double energy_J = 0.5 * inertia_kg_m2(state_) * load_rad_s() * load_rad_s() +
                    0.5 * machine_.body.rotor_inertia_kg_m2 * motor_rad_s() * motor_rad_s() +
                    gravity_Nm(state_) * (1.0 - std::cos(load_rad()));
  if (elastic_) {
    const double twist_rad = state_[kMotor] - state_[kLoad], half_rad = 0.5 * t.backlash_rad;
    const double wound_rad = twist_rad - std::clamp(twist_rad, -half_rad, half_rad);
    energy_J += 0.5 * t.stiffness_Nm_per_rad * wound_rad * wound_rad +
                0.25 * t.hardening_Nm_per_rad3 * std::pow(twist_rad, 4) +
                0.5 * t.gap_stiffness_Nm_per_rad * twist_rad * twist_rad;
  }
  return energy_J;
}

}  // namespace pmg::literature
