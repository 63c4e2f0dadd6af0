// The words that tell a fit which effects a joint has: --also of pmg_calibrate_motor.
#pragma once

#include <string>
#include <vector>

namespace pmg::effects {

/// The names of the catalogue's effects, and of what only a fit knows.
std::vector<std::string> fit_words();

struct FitWord {
  std::vector<std::string> parameters;  ///< of model::actuator_parameters, or load.inertia_scale, load.gravity_scale
  std::string today;                    ///< today's word, if this one is of an earlier version; else empty
  std::string shows, needs;             ///< as an effect's; empty for a parameter
};

/// (word, or a parameter's own name) => (what is fitted: of an effect the parameters of its first form). Throws
/// std::invalid_argument that proposes the nearest word, or lists all.
FitWord fit_word(const std::string& word);

}  // namespace pmg::effects
