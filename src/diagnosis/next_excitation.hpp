// The runs to record next, so that rival explanations separate.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnosis/diagnosis.hpp"
#include "diagnosis/options.hpp"
#include "effects/nested_fit.hpp"

namespace pmg::diagnosis {

/// Models that explain the runs equally well, fitted and linearised: a cause and its possible replacements.
struct Rivals {
  std::vector<effects::NestedModel> models;
  std::vector<std::string> names;  ///< of the models
};

/// The separation that a campaign must reach, and its cost limits.
struct SeparationWanted {
  double deviations = 2.0;     ///< of the mean over blocks
  double noise_squares = 0.0;  ///< mean square that no model goes below [rad^2]
  double enough = 2.0;         ///< the target, in multiples of `deviations`
  std::size_t most_runs = 6;   ///< different runs
  int most_recordings = 24;
};

SeparationWanted separation_wanted(const JointDiagnosisOptions& options, double noise_squares);

struct AskedFor {
  std::optional<NextExcitation> next;
  std::vector<std::pair<std::string, std::string>> same_here;  ///< pairs of effects with the same torque on this rig
};

/// (bench, runs, rivals, wanted separation) => (campaign). A greedy choice: each recording is the candidate
/// (effects/excitation_candidates.hpp) that raises the expected separation most, summed over all pairs, with either of
/// a pair as the truth and each capped at its target. It ends when all pairs reach the target, when no candidate helps,
/// or at six runs or 24 recordings. The target is twice the wanted deviations, because the measured value scatters by
/// one deviation. Direction-dependent friction and a constant torque are the same if the friction is constant: such a
/// pair is reported in same_here and gets no runs.
AskedFor next_excitation(const bench::Bench& bench, const std::vector<calib::SingleJoint>& runs,
                         const std::vector<Rivals>& rivals, const SeparationWanted& wanted, unsigned threads = 1);

/// Effects that no run on this rig can separate become one cause with several names: from or_instead to same_here.
void unite(const std::vector<std::pair<std::string, std::string>>& same_here, std::vector<Cause>& causes);

}  // namespace pmg::diagnosis
