// The effects that a diagnosis considers. Each is a small extension of the same simulation.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/bench.hpp"

namespace pmg::effects {

/// One effect of one joint. With all parameters at their neutral values the model is without the effect.
struct Effect {
  std::string name;                        ///< of diagnosis.json: coulomb, delay, backlash, ...
  std::string title;                       ///< for people: "Coulomb friction"
  std::vector<std::string> parameters;     ///< of model::actuator_parameters, or load.inertia_scale, load.gravity_scale
  std::string shows;                       ///< its symptom in a recording
  std::string needs;                       ///< the motion or the columns that a recording needs to show it
  std::vector<std::string> contains = {};  ///< effects that are its special cases or limits
};

/// Every effect, in the order of the documentation.
std::span<const Effect> catalogue();

/// The effect of that name. Throws std::invalid_argument that lists the valid names.
const Effect& effect(std::string_view name);

/// Title of an effect; an unknown name, from another version of the catalogue, is its own title.
std::string title(const std::string& name);

/// True if the name of an effect or a parameter is in the list.
bool contains(const std::vector<std::string>& names, const std::string& name);

}  // namespace pmg::effects
