// What is wrong with a plant: effects of the catalogue in forms of the literature, data faults, things off the
// catalogue, or nothing.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "faults.hpp"
#include "recorder.hpp"
#include "rig.hpp"

namespace pmg::literature {

enum class Stratum { kSingle, kDouble, kClean, kStrange, kFault };

const char* name(Stratum stratum);

/// A planted number, in terms of motor.yaml: what is known of the healthy joint plus, or times, so much; or the number.
struct PlantedParameter {
  enum class How { kAdds, kScales, kIs };
  std::string name;
  How how = How::kIs;
  double value = 0.0;
};

/// One form of one effect.
struct Form {
  const char* effect;  ///< as diagnosis.json calls it; what is off the catalogue has its own name
  const char* form;
  const char* source;  ///< author and year
  RigNeeds needs;
  /// Draws a strength and puts the effect into the machine. Returns the numbers that mean the same in motor.yaml.
  std::vector<PlantedParameter> (*plant)(Draw&, const Rig&, Machine&);
  /// Effects that describe a part of the form: they may be named beside it.
  std::vector<std::string> besides = {};
};

/// All forms of the catalogue's effects; those of one effect stand together.
std::vector<Form> catalogue_forms();
/// What takes turns in the stratum "strange": what no catalogue knows, and what came to the catalogue or to the data
/// faults after the turns were set: a belt, which is a single effect, and readings that freeze, which are a data fault.
std::vector<Form> strange_forms();
bool off_catalogue(const Form& form);
bool is_data_fault(const Form& form);

/// Names by which the planted form may be called as well, because the torque is the same on this rig.
std::vector<std::string> same_here(const Form& form, const Machine& machine);

struct PlantedEffect {
  Form form;
  std::vector<PlantedParameter> parameters;
  Machine without;  ///< the machine with all but this effect
};

struct LiteraturePlant {
  std::uint64_t seed = 0;
  Stratum stratum = Stratum::kClean;
  Rig rig;
  Rig sound_rig;          ///< without what a data fault changes of it
  Machine machine;        ///< rig.healthy with the effects in it
  Machine sound_machine;  ///< without what a data fault changes of it
  std::vector<PlantedEffect> effects;
  std::vector<DataFault> faults;
};

/// Seeds 2i and 2i + 1 have the same stratum. Of twenty even (or odd) seeds in a row four have one effect each for the
/// catalogue's forms in turn, and so on: see kStrata in planting.cpp.
Stratum stratum_of(std::uint64_t seed);

/// The form of the count-th plant with one effect, among even seeds or (1) among odd ones.
Form form_of_single(std::uint64_t count, std::uint64_t parity);

/// The same seed gives the same plant. A bench that doesn't follow its commands at all, which nobody would record, is
/// drawn again.
LiteraturePlant plant_of(std::uint64_t seed);

/// A rig on which the form can be, with the form planted; for tests of single forms.
LiteraturePlant plant_with(const Form& form, std::uint64_t seed);

}  // namespace pmg::literature
