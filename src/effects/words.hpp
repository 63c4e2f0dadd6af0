// The words by which people ask for what else is fitted: pmg_calibrate_motor --also.
#pragma once

#include <string>
#include <vector>

namespace pmg::effects {

/// What a word stands for.
struct Meaning {
  std::vector<std::string> parameters;  ///< in the order of motor.yaml
  std::string hint;                     ///< the present word, where the given one is a former; else empty
};

/// (name of an effect, for the parameters of its first form, or of a parameter; or a former word for one of them) =>
/// (its meaning). Throws std::invalid_argument that names the nearest word, or all.
Meaning meaning(const std::string& word);

/// A page's table of the effects: word, parameters, how it shows, what shows it. docs/how-to/calibration.md has it.
std::string table_of_words();

/// A page's table of the effects' forms. docs/reference/effects.md has it.
std::string table_of_forms();

}  // namespace pmg::effects
