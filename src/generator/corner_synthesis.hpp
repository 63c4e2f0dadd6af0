// Clips of two velocities at once: the generator interpolates between these corners of the command box.
#pragma once

#include <string>
#include <vector>

#include "generator/gait_parts.hpp"
#include "pmg/clip.hpp"
#include "work/progress.hpp"

namespace pmg::generator {

struct SingleGaits {
  MadeGait forward, backward, lateral, turn;
};

/// Makes forward with sidestepping, forward and backward with turning (a walked circle), and sidestepping with turning
/// to either side. The other corners are their mirror images or superpositions (pmg/corner_clips.hpp). library contains
/// the single clips. With d = q - q_stand the generator mixes
///   q = q_stand + n1 (1 - n2) d1 + (1 - n1) n2 d2 + n1 n2 d12.
/// The unknown is d12. It shall keep the feet on the ground at amplitudes n1, n2 over the whole box.
std::vector<CornerClip> make_corners(const Making& making, const ClipLibrary& library, const SingleGaits& gaits,
                                     const work::Progress& progress);

}  // namespace pmg::generator
