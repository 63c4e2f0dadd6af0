// The effects that a diagnosis considers, each a family of forms. Each form is a small extension of the same
// simulation.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/bench.hpp"

namespace pmg::effects {

/// A parameter that a form sets and no fit moves, such as a Stribeck curve's exponent.
struct FixedValue {
  std::string parameter;
  double value = 0.0;
};

/// One law that the literature gives for an effect. With all parameters at their neutral values the model is without
/// it; the fixed values alone change nothing.
struct Form {
  std::string name;                     ///< of diagnosis.json: linear, quadratic, ...
  std::string title;                    ///< for people, after the effect's title: "growing with the square of speed"
  std::vector<std::string> parameters;  ///< of model::actuator_parameters, or load.inertia_scale, load.gravity_scale
  std::string source;                   ///< author and year; docs/reference/effects.md
  std::vector<FixedValue> fixed = {};
};

/// One effect of one joint: a family of forms. The first form is the simplest.
struct Effect {
  std::string name;   ///< of diagnosis.json: coulomb, delay, backlash, ...
  std::string title;  ///< for people: "Coulomb friction"
  std::vector<Form> forms;
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

/// (effect, name of its form, names of forms that explain as much) => (words for people): "viscous friction, growing
/// with the square of speed (not told from: growing in proportion to speed)". Without forms the effect's title.
std::string described(const std::string& effect, const std::string& form, const std::vector<std::string>& open_forms);

/// True if the name of an effect or a parameter is in the list.
bool contains(const std::vector<std::string>& names, const std::string& name);

}  // namespace pmg::effects
