// Feet whose events are known exactly: heel and toe rest, swing on minimum-jerk paths, and rest again.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "mocap_files/recording.hpp"

namespace pmg::mocap::test {

/// A walk along x. The toe leaves the ground at the lift, the heel touches it at the landing.
struct ExactWalk {
  double leg_m = 0.85, froude_speed = 0.4;  ///< walking speed as a share of sqrt(g leg)
  double rate_hz = 100.0, noise_m = 0.0;
  unsigned seed = 1;
  /// Speed of the toe at the lift and of the heel at the landing, as shares of the walking speed. Real ones: a marker
  /// on the toe moves before the tip of the shoe leaves the ground, and the heel comes to the ground at speed.
  double lift_share = 0.66, land_share = 0.78;
  double contact_s = 0.03;  ///< time in which the toe gets, and the heel loses, that speed on the ground
  /// The heel leaves the ground before the toe, and the toe comes to rest after the heel [cycles]. 0: the foot moves as
  /// one piece.
  double heel_lead = 0.10, toe_lag = 0.08;
  int cycles = 6;
  double speed_m_s() const { return froude_speed * std::sqrt(9.81 * leg_m); }
  /// Cadence follows the root of speed (R. Inman et al., "Human Walking", 1981).
  double period_s() const { return 1.1 * std::sqrt(leg_m / 0.85) * std::sqrt(0.4 / froude_speed); }
  double stride_m() const { return speed_m_s() * period_s(); }
  double swing_s() const { return 0.4 * period_s(); }
  /// Of the swing k of a side.
  double lift_s(int side, int k) const { return (k + 0.3 + 0.5 * side) * period_s(); }
  double land_s(int side, int k) const { return lift_s(side, k) + swing_s(); }
};

/// Minimum jerk from 0 to 1 in [0, 1] with these speeds at both ends and no acceleration there.
inline double minimum_jerk(double s, double v0, double v1) {
  const double a = 10.0 - 6.0 * v0 - 4.0 * v1, b = -15.0 + 8.0 * v0 + 7.0 * v1, c = 6.0 - 3.0 * v0 - 3.0 * v1;
  return s * (v0 + s * s * (a + s * (b + s * c)));
}

/// Distance along x of a point that rests before begin_s, leaves the ground at lift_s with speed v0, comes to it at
/// land_s with v1 and rests from end_s. On the ground the speed changes linearly.
inline double travelled(double t_s, double begin_s, double lift_s, double land_s, double end_s, double v0, double v1,
                        double stride_m) {
  if (t_s <= begin_s) return 0.0;
  if (t_s >= end_s) return stride_m;
  const double first_m = 0.5 * v0 * (lift_s - begin_s), last_m = 0.5 * v1 * (end_s - land_s);
  if (t_s < lift_s) return first_m * std::pow((t_s - begin_s) / (lift_s - begin_s), 2);
  if (t_s > land_s) return stride_m - last_m * std::pow((end_s - t_s) / (end_s - land_s), 2);
  const double air_m = stride_m - first_m - last_m, air_s = land_s - lift_s;
  return first_m + air_m * minimum_jerk((t_s - lift_s) / air_s, v0 * air_s / air_m, v1 * air_s / air_m);
}

/// Heels and toes alone: gait events need no more.
inline Recording exact_walk(const ExactWalk& walk) {
  Recording recording;
  recording.rate_hz = walk.rate_hz;
  recording.frames = static_cast<std::size_t>((walk.cycles + 1.0) * walk.period_s() * walk.rate_hz);
  recording.leg_length_m = walk.leg_m;
  std::mt19937 random(walk.seed);
  std::normal_distribution<double> noise(0.0, walk.noise_m > 0.0 ? walk.noise_m : 1.0);
  const auto put = [&](KeyBody key, double x, double y, double z) {
    Eigen::Vector3d at(x, y, z);
    if (walk.noise_m > 0.0) at += Eigen::Vector3d(noise(random), noise(random), noise(random));
    recording.bodies[static_cast<std::size_t>(key)].position_m.push_back(at);
  };
  const double period_s = walk.period_s(), v_lift = walk.lift_share * walk.speed_m_s(),
               v_land = walk.land_share * walk.speed_m_s();
  const auto bump = [](double t_s, double from_s, double to_s) {  // a smooth rise and fall of height 1
    const double s = (t_s - from_s) / (to_s - from_s);
    return s <= 0.0 || s >= 1.0 ? 0.0 : std::pow(4.0 * s * (1.0 - s), 3);
  };
  for (std::size_t f = 0; f < recording.frames; ++f) {
    const double t_s = static_cast<double>(f) / walk.rate_hz;
    for (int side = 0; side < 2; ++side) {
      double heel = 0.5 * side * walk.stride_m(), toe = heel + 0.22 * walk.leg_m, heel_z = 0.0, toe_z = 0.0;
      for (int k = 0; k < walk.cycles; ++k) {
        const double lift_s = walk.lift_s(side, k), land_s = walk.land_s(side, k);
        const double heel_off_s = lift_s - walk.heel_lead * period_s, toe_down_s = land_s + walk.toe_lag * period_s;
        const bool one_piece = walk.heel_lead == 0.0;
        heel += travelled(t_s, one_piece ? lift_s - walk.contact_s : heel_off_s, one_piece ? lift_s : heel_off_s,
                          land_s, land_s + walk.contact_s, one_piece ? v_lift : 0.0, v_land, walk.stride_m());
        toe += travelled(t_s, lift_s - walk.contact_s, lift_s, one_piece ? land_s : toe_down_s,
                         one_piece ? land_s + walk.contact_s : toe_down_s, v_lift, one_piece ? v_land : 0.0,
                         walk.stride_m());
        heel_z += 0.2 * walk.leg_m * bump(t_s, heel_off_s, land_s);
        toe_z += 0.06 * walk.leg_m * bump(t_s, lift_s, toe_down_s);
      }
      const Side of = side == 0 ? Side::left : Side::right;
      const double y = (side == 0 ? 0.1 : -0.1) * walk.leg_m;
      // A foot in one piece stays level, so that its speed is known in closed form.
      put(of_side(KeyBody::left_heel, of), heel, y, walk.heel_lead == 0.0 ? 0.0 : heel_z);
      put(of_side(KeyBody::left_toe, of), toe, y, walk.heel_lead == 0.0 ? 0.0 : toe_z);
    }
  }
  return recording;
}

}  // namespace pmg::mocap::test
