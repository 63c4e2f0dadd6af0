// The effects that a diagnosis considers, each a family of forms. Each form is a small extension of the same
// simulation.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "effects/unknowns.hpp"

namespace pmg::effects {

/// A parameter that a form sets and no fit moves, such as a Stribeck curve's exponent.
struct FixedValue {
  std::string parameter;
  double value = 0.0;
};

struct Form;

/// What start values of a form follow from: the model that it extends, and the size of the bench's motion.
struct StartsFrom {
  const Form& form;
  const model::ActuatorParameters& actuator;
  const BenchScale& scale;
};

using Values = std::vector<std::vector<double>>;
using Starts = std::function<Values(const StartsFrom&)>;

/// For the workshop.
struct WorkshopWords {
  std::string what = "";   ///< the effect as a noun, without the words of control theory: "play in the gear"
  std::string check = "";  ///< what to do at the joint: whole sentences
  std::string cost = "";   ///< what the robot suffers from it: a whole sentence
};

/// One law that the literature gives for an effect. With all parameters at their neutral values the model is without
/// it; the fixed values alone change nothing.
struct Form {
  std::string name;                     ///< of diagnosis.json: linear, quadratic, ...
  std::string title;                    ///< for people, after the effect's title: "growing with the square of speed"
  std::vector<std::string> parameters;  ///< of model::actuator_parameters, or load.inertia_scale, load.gravity_scale
  std::string source;                   ///< author and year; docs/reference/effects.md
  /// Values of the parameters to fit from. None where these recordings can't have the form: a sag of the bus without a
  /// voltage servo, a thermal drift without temperatures, what a drive's own loop does where commands are torques.
  Starts starts;
  std::vector<FixedValue> fixed = {};
  WorkshopWords workshop = {};  ///< where the effect's don't fit; an empty one is the effect's

  Values starts_at(const calib::JointModel& current, const BenchScale& scale) const {
    return starts({*this, current.actuator, scale});
  }
};

/// What a check without a model measured, of a joint without the effect.
struct Measured {
  double value;
  double torque_Nm;  ///< the value in Nm where it is in the drive's unit
  const model::ActuatorParameters& joint;
  double slow_rad_s;  ///< the check's slow motion is below it
};

namespace shown {
double steps(double t_s);
}

/// What shows the effect best: docs/images/effects. Parameters have the table's examples.
struct Demonstration {
  double (*command)(double t_s) = shown::steps;
  enum class Against { kTime, kPosition, kVelocity } against = Against::kTime;  ///< of the residual's picture
  std::vector<FixedValue> both = {};                                            ///< what both joints have
  double kp = 25.0, gravity_Nm = 1.5;
};

/// One effect of one joint: a family of forms. The first form is the simplest.
struct Effect {
  std::string name;   ///< of diagnosis.json: coulomb, delay, backlash, ...
  std::string title;  ///< for people: "Coulomb friction"
  std::vector<Form> forms;
  std::string shows;  ///< its symptom in a recording
  std::string needs;  ///< the motion or the columns that a recording needs to show it
  WorkshopWords workshop;
  std::vector<std::string> contains = {};  ///< effects that are its special cases or limits
  std::vector<std::string> shapes = {};  ///< parameters that aren't its strength, beside orders, phases, time constants
  /// Values of its parameters, in their order, from what a check measures; none if no check does.
  std::vector<double> (*strength)(const Measured&) = nullptr;
  bool never_negative = false;  ///< a check that measures less than nothing shows something else
  Demonstration demonstration = {};
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

/// (name of an effect, name of its form or nothing where the form is open) => (its words). A name from another version
/// of the catalogue is its own word.
WorkshopWords workshop_words(const std::string& effect, const std::string& form = "");

/// True if the name of an effect or a parameter is in the list.
bool contains(const std::vector<std::string>& names, const std::string& name);

}  // namespace pmg::effects
