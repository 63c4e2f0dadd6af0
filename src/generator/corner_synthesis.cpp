#include "generator/corner_synthesis.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <utility>

#include "pmg/corner_clips.hpp"
#include "work/parallel.hpp"

namespace pmg::generator {
namespace {

/// The same gait to the other side.
MadeGait mirrored_gait(const Making& making, const MadeGait& gait) {
  MadeGait out = gait;
  out.task.velocity.tail<2>() *= -1.0;
  out.body.gaze_yaw_rad *= -1.0;
  for (std::size_t k = 0; k < kClipSamples; ++k) {
    const std::size_t source = (k + kClipSamples / 2) % kClipSamples;
    for (const Foot foot : {kLeft, kRight}) {
      const Foot other = foot == kLeft ? kRight : kLeft;
      out.legs.q[k][foot] = gait.legs.q[source][other].cwiseProduct(making.legs.mirror_sign);
      out.legs.dq_dphi[k][foot] = gait.legs.dq_dphi[source][other].cwiseProduct(making.legs.mirror_sign);
    }
  }
  return out;
}

struct Pair {
  const MadeGait& first;
  const MadeGait& second;
};

/// The corner's clip as a scenario at amplitudes n1, n2 of the two gaits.
Scenario at(const Making& making, const Pair& pair, double period_s, double n1, double n2, double weight) {
  Scenario scenario;
  scenario.gain = n1 * n2;
  scenario.weight = weight;
  scenario.lift = 1.0 - (1.0 - n1) * (1.0 - n2);
  scenario.promised = true;
  const auto part = [&](const MadeGait& gait, double gain) {
    Addition addition = clip_addition(making, gait.legs, gait.task, gain, period_s);
    addition.velocity = gain * gait.task.velocity;  // asked of the mixture, independent of its cadence
    return addition;
  };
  scenario.addition = together(part(pair.first, n1 * (1.0 - n2)), part(pair.second, (1.0 - n1) * n2));
  return scenario;
}

GaitTask corner_task(const Making& making, const Pair& pair, double period_s, const std::vector<LegPose>& reference) {
  GaitTask task;
  task.period_s = period_s;
  task.duty_factor = 0.5 * (pair.first.task.duty_factor + pair.second.task.duty_factor);
  task.velocity = pair.first.task.velocity + pair.second.task.velocity;
  task.symmetric = false;
  task.sway_m = pair.first.task.sway_m + pair.second.task.sway_m;
  task.hike_rad = pair.first.task.hike_rad + pair.second.task.hike_rad;
  task.height_m = std::min(pair.first.task.height_m, pair.second.task.height_m);
  task.clearance_m = 0.035;
  task.foot_gap_m = 0.025;
  task.flat_from = 0.25;
  task.flat_to = 0.65;
  task.reference = reference;
  task.weights.reference = LegVector<double>::Constant(1.0);
  task.weights.bias = LegVector<double>::Constant(0.5);
  task.weights.step_height = 4500.0;
  task.weights.step_height_free_m = 0.004;
  task.weights.velocity = 12.0;
  task.weights.velocity_yaw = 6.0;
  task.weights.height = 40.0;
  task.weights.above_ground = 2000.0;
  task.weights.limit = 300.0;
  // The generator's limit of n1 + n2 is 1.8 (kCornerReach).
  constexpr std::array<std::array<double, 3>, 9> kMixtures = {{{0.9, 0.9, 1.5},
                                                               {0.8, 0.8, 1.0},
                                                               {0.6, 0.6, 1.0},
                                                               {0.4, 0.4, 1.0},
                                                               {1.0, 0.75, 1.0},
                                                               {0.75, 1.0, 1.0},
                                                               {1.0, 0.4, 0.7},
                                                               {0.4, 1.0, 0.7},
                                                               {0.7, 0.3, 0.7}}};
  for (const auto& [n1, n2, weight] : kMixtures) {
    task.scenarios.push_back(at(making, pair, task.period_s, n1, n2, weight));
  }
  Scenario squatting = at(making, pair, task.period_s, 0.6, 0.6, 0.5);
  squatting.addition = together(squatting.addition, posture_addition(making, kHeight, -0.09));
  squatting.promised = false;
  task.scenarios.push_back(squatting);
  return task;
}

/// The legs of a whole-body clip, with the hips turned back by the pelvis' tilt.
std::vector<LegPose> legs_of(const Making& making, const DynamicClip& clip, double pelvis_tilt_rad) {
  std::vector<LegPose> legs(kClipSamples);
  for (std::size_t k = 0; k < kClipSamples; ++k) {
    for (const Foot foot : {kLeft, kRight}) {
      for (std::size_t role = 0; role < kLegJoints; ++role) {
        legs[k][foot][static_cast<Eigen::Index>(role)] = clip.q[k][making.roles.leg[foot][role]];
      }
      legs[k][foot][kHipPitch] += pelvis_tilt_rad;
    }
  }
  return legs;
}

}  // namespace

std::vector<CornerClip> make_corners(const Making& making, const ClipLibrary& library, const SingleGaits& gaits,
                                     const work::Progress& progress) {
  PerCorner<std::optional<DynamicClip>> clips;
  for (std::size_t channel = 0; channel < kVelocityChannels; ++channel) {
    const std::optional<DynamicClip>& positive = library.positive[channel];
    clips[direction_of(channel, false)] = positive;
    clips[direction_of(channel, true)] =
        library.negative[channel] ? *library.negative[channel] : mirrored(library.mirror, *positive);
  }
  const Superposition superposition(clips, library.q_stand);
  const MadeGait turn_right = mirrored_gait(making, gaits.turn);
  // Tilt of the shared lift M (corner_clips.hpp): each channel has a share of a third, each direction half of it.
  const double lift_tilt_rad = (0.5 * (gaits.forward.body.pelvis_tilt_rad + gaits.backward.body.pelvis_tilt_rad) +
                                gaits.lateral.body.pelvis_tilt_rad + gaits.turn.body.pelvis_tilt_rad) /
                               3.0;
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): the pair refers to two gaits, which have no default
  struct Wanted {
    Corner corner;
    Pair pair;
    double period_s;
  };
  // The means of the pair's periods. Forward with lateral is a little faster, so that a library stays below ten
  // seconds.
  const std::array<Wanted, 5> wanted = {{{{{1, 1, 0}}, {gaits.forward, gaits.lateral}, 1.00},
                                         {{{1, 0, 1}}, {gaits.forward, gaits.turn}, 1.14},
                                         {{{-1, 0, 1}}, {gaits.backward, gaits.turn}, 1.17},
                                         {{{0, 1, 1}}, {gaits.lateral, gaits.turn}, 1.10},
                                         {{{0, 1, -1}}, {gaits.lateral, turn_right}, 1.10}}};
  const work::Progress during{.report =
                                  [&](double share, std::string_view) {
                                    if (progress.report) progress.report(share, "combinations of two velocities");
                                  },
                              .interrupted = progress.interrupted};
  const auto make = [&](const Wanted& want) {
    const UpperBody& a = want.pair.first.body;
    const UpperBody& b = want.pair.second.body;
    const UpperBody body = {.pelvis_tilt_rad = a.pelvis_tilt_rad + b.pelvis_tilt_rad - lift_tilt_rad,
                            .arm_swing = a.arm_swing + b.arm_swing,
                            .torso_yaw_rad = a.torso_yaw_rad + b.torso_yaw_rad,
                            .gaze_yaw_rad = a.gaze_yaw_rad + b.gaze_yaw_rad};
    const GaitTask task = corner_task(making, want.pair, want.period_s,
                                      legs_of(making, superposition.at(want.corner), body.pelvis_tilt_rad));
    return CornerClip{want.corner.sign, assemble(making, task, optimize_gait(making.legs, task, during).legs, body)};
  };
  std::vector<CornerClip> corners(wanted.size());
  work::for_each_in_parallel(wanted.size(), static_cast<unsigned>(wanted.size()),
                             [&](std::size_t i) { corners[i] = make(wanted[i]); });
  return corners;
}

}  // namespace pmg::generator
