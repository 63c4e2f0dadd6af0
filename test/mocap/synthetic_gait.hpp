// A made-up person whose gait events are known: legs that follow the published mean angles of adult gait.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>

#include "generator/published_gait.hpp"
#include "mocap_files/recording.hpp"

namespace pmg::mocap::test {

struct Walker {
  double leg_m = 0.85, period_s = 1.1, rate_hz = 100.0, noise_m = 0.0;
  double heading_rad = 0.0;
  int cycles = 5;
  unsigned seed = 1;
};

/// Foot points in the sagittal plane, x forward, relative to the hip. Thigh and shank are 0.53 and 0.47 of the leg, the
/// heel is 0.06 of the leg behind and the ball 0.16 before the ankle, both 0.09 below (D. Winter's segment lengths).
struct LegPose {
  Eigen::Vector2d knee, ankle, heel, toe;
};
inline LegPose leg_pose(double phase, double leg_m) {
  const generator::PublishedGait& gait = generator::published_gait();
  const double thigh = gait.hip_flexion.at_rad(phase) - gait.pelvic_tilt_deg * std::numbers::pi / 180.0;
  const double shank = thigh - gait.knee_flexion.at_rad(phase), foot = shank + gait.ankle_dorsiflexion.at_rad(phase);
  const auto down = [](double angle, double length) {
    return Eigen::Vector2d(length * std::sin(angle), -length * std::cos(angle));
  };
  LegPose leg;
  leg.knee = down(thigh, 0.53 * leg_m);
  leg.ankle = leg.knee + down(shank, 0.47 * leg_m);
  const Eigen::Rotation2Dd turn(foot);
  leg.heel = leg.ankle + turn * Eigen::Vector2d(-0.06 * leg_m, -0.09 * leg_m);
  leg.toe = leg.ankle + turn * Eigen::Vector2d(0.16 * leg_m, -0.09 * leg_m);
  return leg;
}

/// The speed at which the foot that stands moves least, by the mean of its flat phase (15 to 40 % of the cycle).
inline double walking_speed(const Walker& walker) {
  const LegPose a = leg_pose(0.15, walker.leg_m), b = leg_pose(0.40, walker.leg_m);
  return (a.ankle.x() - b.ankle.x()) / (0.25 * walker.period_s);
}

/// The recording: the pelvis at a height at which the lower foot is on the ground, at constant speed. Left contact is
/// at the times k T, right contact half a cycle later, toe-off follows 0.6 T later.
inline Recording walk(const Walker& walker) {
  Recording recording;
  recording.rate_hz = walker.rate_hz;
  recording.frames = static_cast<std::size_t>(walker.cycles * walker.period_s * walker.rate_hz);
  recording.leg_length_m = walker.leg_m;
  std::mt19937 random(walker.seed);
  std::normal_distribution<double> noise(0.0, 1.0);
  const double speed = walking_speed(walker);
  const Eigen::AngleAxisd turn(walker.heading_rad, Eigen::Vector3d::UnitZ());
  const auto put = [&](KeyBody key, double x, double y, double z) {
    const Eigen::Vector3d shake = walker.noise_m * Eigen::Vector3d(noise(random), noise(random), noise(random));
    recording.bodies[static_cast<std::size_t>(key)].position_m.emplace_back(turn * Eigen::Vector3d(x, y, z) + shake);
  };
  for (std::size_t f = 0; f < recording.frames; ++f) {
    const double t_s = static_cast<double>(f) / walker.rate_hz, phase = t_s / walker.period_s, x = speed * t_s;
    const std::array<LegPose, 2> legs = {leg_pose(phase, walker.leg_m), leg_pose(phase + 0.5, walker.leg_m)};
    double z = 0.0;
    for (const LegPose& leg : legs) z = std::max({z, -leg.heel.y(), -leg.toe.y()});
    put(KeyBody::pelvis, x, 0.0, z + 0.1 * walker.leg_m);
    put(KeyBody::neck, x + 0.03, 0.0, z + 0.7 * walker.leg_m);
    for (const Side side : {Side::left, Side::right}) {
      const LegPose& leg = legs[static_cast<std::size_t>(side)];
      const double y = (side == Side::left ? 0.1 : -0.1) * walker.leg_m;
      put(of_side(KeyBody::left_hip, side), x, y, z);
      for (const auto& [key, at] : {std::pair{KeyBody::left_knee, leg.knee}, std::pair{KeyBody::left_ankle, leg.ankle},
                                    std::pair{KeyBody::left_heel, leg.heel}, std::pair{KeyBody::left_toe, leg.toe}}) {
        put(of_side(key, side), x + at.x(), y, z + at.y());
      }
    }
  }
  return recording;
}

}  // namespace pmg::mocap::test
