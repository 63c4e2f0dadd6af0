// Runs that could be recorded next on a bench.
#pragma once

#include <string>
#include <vector>

#include "calib/single_joint.hpp"

namespace pmg::effects {

/// A run not recorded yet. Its readings are constant, at its first position.
struct ExcitationCandidate {
  std::string shape;  ///< of the command, in words
  bench::BenchRun run;
};

/// Steps, staircases, sweeps, reversals and chirps of several sizes and paces, each with the lowest, middle and highest
/// of the gains used and of the bench's loads. Each lasts six seconds, stays within the range of the recorded commands,
/// starts where the recorded runs start and glides to the start of its shape.
std::vector<ExcitationCandidate> excitation_candidates(const bench::Bench& bench,
                                                       const std::vector<calib::SingleJoint>& runs);

}  // namespace pmg::effects
