// The effects that can be hidden in a plant, and how strong they are.
#pragma once

#include <span>
#include <vector>

#include "planting.hpp"

namespace pmg::hidden {

struct EffectKind {
  const char* name;
  RigKind rig;  ///< on which it can be
  /// Draws a strength, puts the effect into the plant (and what must be recorded with it into the rig).
  std::vector<PlantedParameter> (*plants)(Draw&, Rig&, PlantParameters&);
};

/// Of the diagnosis' catalogue, by the names of diagnosis.json.
std::span<const EffectKind> effect_kinds();
/// From outside it.
std::span<const EffectKind> strange_kinds();

}  // namespace pmg::hidden
