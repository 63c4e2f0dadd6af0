// What is wrong with a hidden plant: one effect, two, none, or something that no catalogue knows.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rig.hpp"

namespace pmg::hidden {

enum class PlantKind { kSingle, kDouble, kClean, kStrange };

const char* name(PlantKind kind);

/// A planted number, in terms of motor.yaml: what is known of the healthy joint plus, or times, so much; or the number.
struct PlantedParameter {
  enum class How { kAdds, kScales, kIs };
  std::string name;
  How how = How::kIs;
  double value = 0.0;
};

struct PlantedEffect {
  std::string name;                          ///< as diagnosis.json calls it; what is strange has its own
  std::vector<PlantedParameter> parameters;  ///< those that mean the same in motor.yaml as in the plant
  PlantParameters plant_without;             ///< the plant with all but this effect
};

struct HiddenPlant {
  std::uint64_t seed = 0;
  PlantKind kind = PlantKind::kClean;
  Rig rig;
  PlantParameters plant;  ///< rig.healthy with the effects in it
  std::vector<PlantedEffect> effects;
};

/// The effects that may be planted, by the names of diagnosis.json.
std::vector<std::string> planted_effects();
/// The count-th single effect.
std::string effect_in_turn(std::uint64_t count);
/// What is planted from outside the catalogue.
std::vector<std::string> strange_effects();

/// The same seed gives the same plant. Of twenty seeds in a row twelve have one effect, two have two, three none and
/// three a strange one; the effects take turns, rigs and strengths are random. A bench that doesn't follow its commands
/// at all, which nobody would record, is drawn again.
HiddenPlant hide(std::uint64_t seed);

}  // namespace pmg::hidden
