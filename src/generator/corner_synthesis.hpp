// Clips of two velocities at once: the corners of the command box between which the generator interpolates.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "generator/gait_parts.hpp"
#include "pmg/clip.hpp"

namespace pmg::generator {

struct SingleGaits {
  MadeGait forward, backward, lateral, turn;
};

/// Forward with sidestepping, forward and backward with turning, and sidestepping with turning either way: a walked
/// circle, say.
/// The other corners are their mirror images, or what superposition gives (pmg/corner_clips.hpp). library holds the
/// single clips. The generator mixes q = q_stand + n1 (1 - n2) d1 + (1 - n1) n2 d2 + n1 n2 d12; unknown is d12, asked
/// to keep the ground at amplitudes n1, n2 over the whole box.
std::vector<CornerClip> make_corners(const Making& making, const ClipLibrary& library, const SingleGaits& gaits,
                                     const std::function<void(const std::string&)>& progress);

}  // namespace pmg::generator
