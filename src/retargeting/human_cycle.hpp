// One gait cycle of a human as a clip has it: left contact at phase 0, feet half a cycle apart, ends that meet.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "retargeting/human_pose.hpp"

namespace pmg::retargeting {

struct HumanCycle {
  mocap::GaitCycle cut;  ///< as recorded
  double leg_length_m = 0.0;
  double period_s = 0.0;
  double duty_factor = 0.0;                                 ///< mean of both feet
  Eigen::Vector3d mean_velocity = Eigen::Vector3d::Zero();  ///< vx, vy [m/s], omega [rad/s]
  std::vector<HumanPose> pose;                              ///< kClipSamples, sample k at phase k / kClipSamples
  std::vector<double> recorded_phase;  ///< of each sample: where it is in the cut, which begins at 0 and ends at 1
  /// The part of the stance in which the sole is flat, as shares of the stance; both feet's overlap.
  double flat_from = 0.0, flat_to = 1.0;
  double hike_rad = 0.0;                                  ///< amplitude of the pelvis' roll as generator::hike has it
  double sway_m = 0.0;                                    ///< amplitude of the pelvis' sway towards the stance foot
  double warp_cycles = 0.0;                               ///< largest shift of an instant that the alignment took
  double seam_before_rad = 0.0, closing_moved_rad = 0.0;  ///< jump of the recording; what closing it changed
};

/// (recording, cycle) => (aligned cycle). Time is warped by a monotone periodic cubic (Fritsch and Carlson, SIAM J.
/// Numer. Anal. 17(2), 1980) so that both feet have the same duty factor r, the left one lands at phase 0 and the right
/// one at 0.5. Clips of one library agree on contact centres then, and with the same r on when a foot is loaded. The
/// sole's pitch counts from the one that it keeps in stance. Throws files::ConfigError with what was expected if the
/// feet don't alternate as in walking.
HumanCycle human_cycle(const mocap::Recording& recording, const mocap::GaitCycle& cut,
                       std::optional<double> duty_factor = {});

/// The mean of both feet's: r where no other is asked for.
double duty_factor_of(const mocap::GaitCycle& cut);

}  // namespace pmg::retargeting
