// A synthetic clip library for any number of joints: smooth periodic curves with a known left-right symmetry.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include "pmg/generator.hpp"

namespace pmg::test {

inline constexpr double kDt_s = 0.01;  // the control loop's

/// Joints 0 and 1, 2 and 3, ... are left-right pairs; every third pair has the sign -1. An odd last joint is its own
/// mirror image with the sign -1, as a yaw or roll joint of the trunk.
inline MirrorMap mirror_map(int joints) {
  MirrorMap map;
  for (int i = 0; i < joints; ++i) {
    const bool own = i == joints - 1 && joints % 2 == 1;
    map.partner.push_back(own ? i : i ^ 1);
    map.sign.push_back(own || (i / 2) % 3 == 1 ? -1.0 : 1.0);
  }
  return map;
}

/// Two harmonics per joint about the standing posture; `amplitude` [rad] bounds each of them.
struct Wave {
  double offset = 0.0;
  std::array<double, 2> sine{}, cosine{};
  double value(double phase) const {
    double q = offset;
    for (int h = 0; h < 2; ++h) {
      const double angle = 2.0 * std::numbers::pi * (h + 1) * phase;
      q += sine[static_cast<std::size_t>(h)] * std::sin(angle) + cosine[static_cast<std::size_t>(h)] * std::cos(angle);
    }
    return q;
  }
  double slope(double phase) const {
    double dq = 0.0;
    for (int h = 0; h < 2; ++h) {
      const double rate = 2.0 * std::numbers::pi * (h + 1);
      dq += rate * (sine[static_cast<std::size_t>(h)] * std::cos(rate * phase) -
                    cosine[static_cast<std::size_t>(h)] * std::sin(rate * phase));
    }
    return dq;
  }
};

class LibraryMaker {
 public:
  LibraryMaker(int joints, std::uint64_t seed) : joints_(joints), random_(seed), map_(mirror_map(joints)) {}

  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

  JointVector symmetric_stand() {
    JointVector q(joints_);
    for (int i = 0; i < joints_; ++i) {
      const auto partner = map_.partner[static_cast<std::size_t>(i)];
      q[i] = partner < i    ? map_.sign[static_cast<std::size_t>(i)] * q[partner]
             : partner == i ? 0.0
                            : uniform(-0.3, 0.3);
    }
    return q;
  }

  Wave wave(double centre, double amplitude) {
    Wave w;
    w.offset = centre + uniform(-0.2, 0.2) * amplitude;
    for (std::size_t h = 0; h < 2; ++h) {
      w.sine[h] = uniform(-0.5, 0.5) * amplitude;
      w.cosine[h] = uniform(-0.5, 0.5) * amplitude;
    }
    return w;
  }

  /// symmetric: the right side repeats the left side half a cycle later, as in walking straight ahead.
  DynamicClip dynamic_clip(const JointVector& stand, std::size_t samples, double period_s, double duty_factor,
                           bool symmetric) {
    std::vector<Wave> waves;
    for (int i = 0; i < joints_; ++i) waves.push_back(wave(stand[i], 0.4));
    DynamicClip clip;
    clip.period_s = period_s;
    clip.duty_factor = {duty_factor, duty_factor};
    clip.contact_center = {0.5 * duty_factor, 0.5 + 0.5 * duty_factor};
    for (std::size_t k = 0; k < samples; ++k) {
      const double phase = static_cast<double>(k) / static_cast<double>(samples);
      JointVector q(joints_), dq(joints_);
      for (int i = 0; i < joints_; ++i) {
        const auto joint = static_cast<std::size_t>(i);
        const auto partner = static_cast<std::size_t>(map_.partner[joint]);
        const double sign = map_.sign[joint];
        const auto own = [&](const auto& of) { return of(waves[joint], phase); };
        const auto later = [&](const auto& of) { return sign * of(waves[partner], phase + 0.5); };
        const auto pick = [&](const auto& of) {
          if (!symmetric || partner > joint) return own(of);
          return partner < joint ? later(of) : 0.5 * (own(of) + later(of));
        };
        q[i] = pick([](const Wave& w, double p) { return w.value(p); });
        dq[i] = pick([](const Wave& w, double p) { return w.slope(p); });
      }
      clip.q.push_back(q);
      clip.dq_dphi.push_back(dq);
    }
    return clip;
  }

  /// Slightly curved between rows, monotone in the command; rows at multiples of step. symmetric: pitch and height.
  StaticClip static_clip(const JointVector& stand, int first_row, int last_row, double step, bool symmetric) {
    JointVector slope(joints_), bend(joints_);
    for (int i = 0; i < joints_; ++i) {
      const auto joint = static_cast<std::size_t>(i);
      const int partner = map_.partner[joint];
      // Roll has the opposite sign: leaning to the other side is the mirror image.
      const double sign = map_.sign[joint] * (symmetric ? 1.0 : -1.0);
      slope[i] = partner < i ? sign * slope[partner] : partner == i && symmetric ? 0.0 : uniform(-0.8, 0.8);
      bend[i] = std::abs(slope[i]) * 0.3;
    }
    StaticClip clip;
    for (int row = first_row; row <= last_row; ++row) {
      const double u = row * step;
      clip.command.push_back(u);
      JointVector q = stand;
      for (int i = 0; i < joints_; ++i) q[i] += slope[i] * u * (1.0 - bend[i] * std::abs(u));
      clip.q.push_back(q);
    }
    return clip;
  }

  ClipLibrary library() {
    ClipLibrary lib;
    lib.q_stand = symmetric_stand();
    lib.q_lower.setConstant(joints_, -3.0);
    lib.q_upper.setConstant(joints_, 3.0);
    lib.mirror = map_;
    lib.positive[kVx] = dynamic_clip(lib.q_stand, 100, 1.10, 0.60, true);
    lib.negative[kVx] = dynamic_clip(lib.q_stand, 100, 1.17, 0.58, true);
    lib.positive[kVy] = dynamic_clip(lib.q_stand, 96, 1.02, 0.56, false);
    lib.positive[kOmega] = dynamic_clip(lib.q_stand, 101, 1.18, 0.62, false);  // odd: mirroring has to interpolate
    lib.posture = {static_clip(lib.q_stand, -8, 25, 0.02, true), static_clip(lib.q_stand, -13, 13, 0.02, false),
                   static_clip(lib.q_stand, -10, 1, 0.02, true)};
    return lib;
  }

 private:
  int joints_;
  std::mt19937_64 random_;
  MirrorMap map_;
};

inline ClipLibrary make_library(int joints, std::uint64_t seed = 1) { return LibraryMaker(joints, seed).library(); }

/// Ranges, rates and scales of a small humanoid.
inline GeneratorOptions make_options() {
  GeneratorOptions options;
  options.limits.lower = {-0.5, -0.35, -0.8, -0.15, -0.25, -0.20};
  options.limits.upper = {0.8, 0.35, 0.8, 0.50, 0.25, 0.02};
  options.limits.rate_per_s = {0.8, 0.5, 1.0, 0.4, 0.4, 0.15};
  options.scale_positive = {0.8, 0.35, 0.8};
  options.scale_negative = {0.5, 0.35, 0.8};
  return options;
}

inline Command make_command(double vx, double vy, double omega, double pitch = 0.0, double roll = 0.0,
                            double height = 0.0) {
  return Command{{vx, vy, omega, pitch, roll, height}};
}

/// Steps with a constant command and returns the last reference.
inline Reference run(Generator& generator, const Command& command, double duration_s) {
  const int ticks = static_cast<int>(std::lround(duration_s / kDt_s));
  for (int i = 0; i < ticks; ++i) generator.step(command, kDt_s);
  return generator.reference();
}

}  // namespace pmg::test
