// The effects that a diagnosis considers, each a family of forms. Each form is a small extension of the same
// simulation. An effect is one file of this room: src/effects/coulomb.cpp has Coulomb friction.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/bench.hpp"
#include "effects/demonstration.hpp"

namespace pmg::effects {

struct NominalJoint;
using Starts = std::vector<std::vector<double>>;  ///< values of a form's parameters, in their order

/// One law that the literature gives for an effect. With all parameters at their neutral values the model is without
/// it; the fixed values alone change nothing.
struct Form {
  std::string name;                      ///< of diagnosis.json: linear, quadratic, ...
  std::string title = {};                ///< for people, after the effect's title; empty where it is the only form
  std::vector<std::string> parameters;   ///< of model::actuator_parameters, or load.inertia_scale, load.gravity_scale
  std::vector<std::string> shapes = {};  ///< those that mean nothing without the effect: a speed, an order, a phase
  std::vector<FixedValue> fixed = {};    ///< what the form sets and no fit moves: a Stribeck curve's exponent
  std::string source;                    ///< author and year; docs/reference/effects.md
  /// Start values for a fit. None where these recordings can't have the form: a sag of the bus without a voltage servo,
  /// a thermal drift without temperatures, what a drive's own loop does where commands are torques.
  Starts (*starts)(const NominalJoint& joint);
};

/// What a model-free check measured.
struct MeasuredCheck {
  double value;
  double torque_Nm;                        ///< the value, if it is one of the torque balance
  const model::ActuatorParameters& joint;  ///< without the effect
  double slow_rad_s;                       ///< the speed below which the check counts motion as slow
};

/// What the model-free check of an effect decides by itself.
enum class CheckSays {
  kWhereToLook,     ///< where it agrees, the search starts there; where it disagrees, the effect is in doubt
  kNothingAgainst,  ///< likewise, but its disagreement is no doubt
  kAll,             ///< likewise, and where it agrees the effect is named though no fit can size it
  kSize,            ///< the recordings give the size, and no fit is needed
};

/// An effect without the words of control theory.
struct WorkshopWords {
  std::string what;   ///< the effect as a noun: "play in the gear"
  std::string check;  ///< what to do at the joint: whole sentences
  std::string cost;   ///< what the robot suffers from it: a whole sentence
};

/// One effect of one joint: a family of forms. The first form is the simplest.
struct Effect {
  std::string name;   ///< of diagnosis.json and of pmg_calibrate_motor --also: coulomb, delay, backlash, ...
  std::string title;  ///< for people: "Coulomb friction"
  std::vector<Form> forms;
  std::string shows;                       ///< its symptom in a recording
  std::string needs;                       ///< the motion or the columns that a recording needs to show it
  std::vector<std::string> contains = {};  ///< effects that are its special cases or limits
  bool one_sign =
      false;            ///< its first parameter can't be negative: what a check or a fit finds there is another effect
  bool linear = false;  ///< rollouts are nearly linear in all its parameters together
  CheckSays check = CheckSays::kWhereToLook;
  /// (what its check measured) => (values of the first form's parameters; empty where it doesn't tell). Null where the
  /// check's value is no parameter, or there is none.
  std::vector<double> (*strength)(const MeasuredCheck& measured) = nullptr;
  WorkshopWords workshop;
  Demonstration demonstration;
};

/// Every effect, in the order of the documentation.
std::span<const Effect> catalogue();

/// The effect of that name; null for a name of another version of the catalogue.
const Effect* find(std::string_view name);

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
