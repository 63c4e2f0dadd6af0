// The effects that a diagnosis knows: each a small extension of the same simulation.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/bench.hpp"

namespace pmg::effects {

/// One effect of one joint. What it does is in the parameters; neutral values of all of them are the model without it.
struct Effect {
  std::string name;                        ///< of diagnosis.json: coulomb, delay, backlash, ...
  std::string title;                       ///< for people: "Coulomb friction"
  std::vector<std::string> parameters;     ///< of sim::actuator_parameters, or load.inertia_scale, load.gravity_scale
  std::string shows;                       ///< how it shows in a recording
  std::string needs;                       ///< what must have been recorded for it to be seen
  std::vector<std::string> contains = {};  ///< effects that are special cases or limits of it
};

/// Every effect, in the order of the documentation.
std::span<const Effect> catalogue();

/// Throws std::invalid_argument that lists the names.
const Effect& effect(std::string_view name);

/// Whether the name of an effect or a parameter is among these.
bool contains(const std::vector<std::string>& names, const std::string& name);

}  // namespace pmg::effects
