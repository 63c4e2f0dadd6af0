// What to record next so that explanations part.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnosis/diagnosis.hpp"
#include "effects/nested_fit.hpp"

namespace pmg::diagnosis {

/// Models that explain the runs equally well, fitted and linearised, and what they are called: a cause and what could
/// stand in its place.
struct Rivals {
  std::vector<effects::NestedModel> models;
  std::vector<std::string> names;  ///< the models'
};

/// How sure a comparison has to be before it tells two models apart.
struct SeparationWanted {
  double deviations = 2.0;     ///< of the mean over blocks
  double noise_squares = 0.0;  ///< mean square that no model goes below [rad^2]
  double enough = 2.0;         ///< times `deviations`, to aim at
  std::size_t most_runs = 6;   ///< that differ
  int most_recordings = 24;
};

struct AskedFor {
  std::optional<NextExcitation> next;
  std::vector<std::pair<std::string, std::string>> same_here;  ///< two names for one torque on this rig
};

/// A small campaign, chosen recording by recording: of the candidates (excitation_candidates.hpp) the one that brings
/// all pairs of rivals together furthest towards twice of what is wanted, as Separation expects it, whichever of a pair
/// is the truth; until all are there, or recordings don't help any more, or there are six runs or 24 recordings. Twice:
/// what is found strays by one deviation. Direction-dependent friction and a constant torque are one where the friction
/// varies with nothing; such a pair is named and not asked about.
AskedFor next_excitation(const bench::Bench& bench, const std::vector<calib::SingleJoint>& runs,
                         const std::vector<Rivals>& rivals, const SeparationWanted& wanted, unsigned threads = 1);

}  // namespace pmg::diagnosis
