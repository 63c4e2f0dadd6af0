// Parameters that another assembly of the same joint may have another value of.
#pragma once

#include <span>
#include <string>

namespace pmg::assembly {

/// When a parameter is looked at.
enum class Looked {
  kAlways,
  kIfPresent,  ///< only if the model has the effect: about zero its slope says nothing
};

struct AssemblyParameter {
  const char* name = "";    ///< of model::actuator_parameters, or load.gravity_scale
  const char* title = "";   ///< for people: "zero offset"
  const char* reason = "";  ///< why assemblies differ in it
  const char* check = "";   ///< what to do at the joint: an imperative without a full stop
  Looked looked = Looked::kAlways;
};

std::span<const AssemblyParameter> assembly_parameters();

/// Title of a parameter; a name that the list lacks is its own title.
std::string title(const std::string& parameter);
/// What to check where this parameter differs.
std::string check(const std::string& parameter);

}  // namespace pmg::assembly
