// When each foot touches the ground and leaves it, from its motion alone.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "mocap/signals.hpp"
#include "mocap_files/recording.hpp"

namespace pmg::mocap {

/// Constants of the method, published or scaled by the body. Among the published signals this one was chosen because it
/// was nearest to the force plates of one recording; its constants were not fitted to them.
struct GaitEventOptions {
  /// A foot lands when the first of its points, heel or toe, is slower than this share of the walking speed, and leaves
  /// when the last one is faster: the speeds' thresholds of D. Bruening and S. Ridge, "Automated event detection
  /// algorithms in pathological gait", Gait & Posture 39:472-477, 2014, after Ghoussayni et al. 2004.
  double landing_share = 0.78, lifting_share = 0.66;
  /// Walking speed of one step: this share of the foot's mean speed in its swing. A foot covers the stride within its
  /// swing, which is 40 % of the cycle (J. Perry, "Gait Analysis"). So it needs no pelvis, and holds for each step of a
  /// start, a stop, a turn and a sidestep alone.
  double swing_share = 0.40;
  /// A swing is faster than this at least, as a share of sqrt(g leg length): slower feet shift, but don't step.
  double slowest_swing = 0.10;
  /// The middle of heel and toe travels this far in a swing at least, as a share of the leg's length: less is a foot
  /// that rolls, slips or is put right. People's shortest steps, those of a turn in place, are longer than a foot's
  /// half (0.15).
  double shortest_path = 0.12;
  /// A foot rests on the ground if one of its points is lower than this above its lowest, as a share of the leg's
  /// length. A heel rises by 0.2 and more in a swing.
  double ground_height = 0.08;
  /// Standard deviation of the Gaussian on positions [s]: -3 dB at 10 Hz, above the content of walking (D. Winter: 6
  /// Hz).
  double smoothing_s = 0.0132;
  /// Slower recordings are interpolated to this rate [Hz], so that a threshold's crossing isn't bound to frames.
  double rate_hz = 200.0;
  /// Slower recordings [Hz] show no events: a swing of 0.4 s has fewer than 4 frames.
  double slowest_rate_hz = 10.0;
};

/// One swing of one foot. A swing that began before the recording or ends after it has no time there.
struct Step {
  Side side = Side::left;
  std::optional<double> lift_s, land_s;
  double speed_m_s = 0.0;  ///< mean speed of the foot in the swing
  double from_s() const { return lift_s ? *lift_s : *land_s; }
  double to_s() const { return land_s ? *land_s : *lift_s; }
};

/// The points of a foot that touch the ground, of each frame [m].
struct Sole {
  Positions heel, toe;
};

/// From the heel and the toe that the recording has. A skeleton without heels gets one that is fixed to its foot: below
/// the ankle at the toe's height, and behind it by half the distance from ankle to toe (ankle at a quarter of the
/// foot's length, ball at three quarters). Empty if the recording lacks the ankle and the toe.
Sole sole_of(const Recording& recording, Side side);

/// Swings of both feet in the order of their landing. Feet that the recording lacks have none, and so have recordings
/// below the slowest rate.
std::vector<Step> find_steps(const Recording& recording, const GaitEventOptions& options = {});

/// Times of one foot's initial contacts (in forward walking its heel strikes), and of its toe-offs [s].
struct FootEvents {
  std::vector<double> contact_s, off_s;
};
std::array<FootEvents, 2> events_of(const std::vector<Step>& steps);

/// Height of the ground [m]: the 5th percentile of the lower sole points' heights; 0 without feet.
double ground_height_m(const Recording& recording);

}  // namespace pmg::mocap
