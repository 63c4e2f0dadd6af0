// One gait cycle of a recording: which one, where each foot stands in it, and its ends made to meet.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "mocap/gait_events.hpp"

namespace pmg::mocap {

/// The paper's c = {mu, sigma} of one foot, as clips have it: phase of the middle of its contact, and the share of the
/// cycle that it lasts.
struct FootContact {
  double center = 0.0, duty_factor = 0.0;
};

/// From an initial contact of one foot to its next. Phase 0 is from_s.
struct GaitCycle {
  Side side = Side::left;
  double from_s = 0.0, to_s = 0.0;
  /// Root mean square over the key bodies of the distance between the pose at from_s and that at to_s, both in the
  /// heading frame at the pelvis [m].
  double loop_error_m = 0.0;
  std::array<FootContact, 2> contact;  ///< by Side
  double period_s() const { return to_s - from_s; }
};

/// The cycle with the least loop error of those that lie between the two times, with one swing of each foot. Nothing if
/// there is none.
std::optional<GaitCycle> best_cycle(const Recording& recording, const std::vector<Step>& steps, double from_s,
                                    double to_s);

/// Angles of a human's segments over time. Every kind of recording has them, as they need positions alone.
struct HumanAngles {
  std::vector<std::string> names;              ///< "left_knee_flexion", ...
  std::vector<std::vector<double>> angle_rad;  ///< [angle][sample at rate_hz]
  double rate_hz = 0.0;
};

/// In the heading frame of the hips: trunk pitch (+ forward) and roll (+ right); of each side thigh pitch and foot
/// pitch
/// (+ toes or knee to the front and up), thigh roll (+ outwards), knee flexion, upper arm pitch and roll, elbow
/// flexion. Angles whose bodies the recording lacks are left out. The positions are interpolated and smoothed as for
/// gait events (a heading without hips and shoulders is that of x).
HumanAngles human_angles(const Recording& recording, const GaitEventOptions& options = {});

/// One cycle of angles whose end meets its begin.
struct ClosedCycle {
  std::vector<std::string> names;
  std::vector<std::vector<double>> angle_rad;  ///< [angle][sample]; sample k is phase k / N, the end isn't repeated
  double period_s = 0.0;
  double seam_before_rad = 0.0, seam_before_rad_s = 0.0;  ///< largest jump of the recording between its two ends
  double moved_rad = 0.0;                                 ///< largest change that closing took
};

struct SeamOptions {
  std::size_t samples = 100;
  /// Standard deviation of the Gaussian with which the correction fades [cycles]. Wide enough that closing a jump of
  /// 0.1 rad in a cycle of 1 s adds 0.4 rad/s at most, an eighth of a knee's speed; at the other end nothing is left of
  /// it.
  double sigma_cycles = 0.08;
};

/// Gaussian smoothing at the seam. Let d be the jump of the angle and e that of its speed over the seam. Each end takes
/// half: at phase p after the seam q + (d + e T p) / 2 exp(-p^2 / (2 sigma^2)), mirrored before it. Then q and dq close
/// exactly, and the cycle's middle stays as it was recorded.
ClosedCycle close_cycle(const HumanAngles& angles, const GaitCycle& cycle, const SeamOptions& options = {});

/// Jumps of a periodic curve at its end against the way it goes on inside: angle [rad] and speed [rad/s], largest over
/// the curves, by one-sided cubics through the last and the first samples.
struct SeamJump {
  double angle_rad = 0.0, speed_rad_s = 0.0;
};
SeamJump seam_jump(const std::vector<std::vector<double>>& angle_rad, double period_s);

}  // namespace pmg::mocap
