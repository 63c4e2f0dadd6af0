// Runs that could be recorded next on a bench.
#pragma once

#include <string>
#include <vector>

#include "calib/single_joint.hpp"

namespace pmg::diagnosis {

/// A run that nobody has recorded yet: its readings are those of a joint that stays where it begins.
struct ExcitationCandidate {
  std::string shape;  ///< of the command, in words
  bench::BenchRun run;
};

/// Steps, staircases, sweeps, reversals and chirps of several sizes and paces, each with the lowest, middle and highest
/// of the gains that were used and of the loads that the bench has. Six seconds each, within the range of the commands
/// that were recorded; each begins where the recorded runs begin and glides to where its shape does.
std::vector<ExcitationCandidate> excitation_candidates(const bench::Bench& bench,
                                                       const std::vector<calib::SingleJoint>& runs);

}  // namespace pmg::diagnosis
