#include "effects/fit_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "effects/catalogue.hpp"
#include "files/nearest_name.hpp"
#include "model/actuator_parameters.hpp"

namespace pmg::effects {

namespace {

struct OwnWord {
  const char *word, *parameter, *shows, *needs;
};

/// What no diagnosis looks for.
constexpr OwnWord kOnlyFits[] = {
    {"presliding", "friction.presliding_rad", "held by friction, the joint gives way a little before it slides",
     "small steps, and rests"},
    {"velocity_lag", "sensor.velocity_lag_s", "rings more than damping explains", "steps at two settings of kd"},
    {"brake", "drive.brake_when_disabled",
     "a voltage servo that is switched off still brakes the joint by its back-EMF", "the drive switched off"}};

struct FormerWord {
  const char* word;
  const char* today;
};

constexpr FormerWord kFormer[] = {{"friction", "coulomb"},
                                  {"damping", "viscous"},
                                  {"asymmetry", "direction_friction"},
                                  {"inertia", "load.inertia_scale"},
                                  {"gravity", "load.gravity_scale"}};

std::vector<std::string> parameter_names() {
  std::vector<std::string> names = {"load.inertia_scale", "load.gravity_scale"};
  for (const model::ActuatorParameter& p : model::actuator_parameters()) names.emplace_back(p.name);
  return names;
}

}  // namespace

std::vector<std::string> fit_words() {
  std::vector<std::string> words;
  for (const Effect& effect : catalogue()) words.push_back(effect.name);
  for (const OwnWord& own : kOnlyFits) words.emplace_back(own.word);
  return words;
}

FitWord fit_word(const std::string& word) {
  for (const Effect& effect : catalogue()) {
    if (word == effect.name) return {effect.forms.front().parameters, "", effect.shows, effect.needs};
  }
  for (const OwnWord& own : kOnlyFits) {
    if (word == own.word) return {{own.parameter}, "", own.shows, own.needs};
  }
  for (const FormerWord& former : kFormer) {
    if (word != former.word) continue;
    FitWord found = fit_word(former.today);
    found.today = former.today;
    return found;
  }
  std::vector<std::string> known = parameter_names();
  if (contains(known, word)) return {{word}, "", "", ""};
  const std::vector<std::string> words = fit_words();
  known.insert(known.end(), words.begin(), words.end());
  for (const FormerWord& former : kFormer) known.emplace_back(former.word);
  if (const std::string nearest = files::nearest_name(word, known); !nearest.empty()) {
    throw std::invalid_argument(fmt::format("'{}' isn't an effect; did you mean {}?", word, nearest));
  }
  throw std::invalid_argument(fmt::format("'{}' isn't an effect; expected one of {}, or a parameter of motor.yaml",
                                          word, fmt::join(words, ", ")));
}

}  // namespace pmg::effects
