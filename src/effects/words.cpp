#include "effects/words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <ranges>
#include <stdexcept>
#include <utility>

#include "effects/catalogue.hpp"
#include "files/nearest_name.hpp"
#include "model/actuator_parameters.hpp"

namespace pmg::effects {

namespace {

/// Words of earlier versions, and the present ones.
constexpr std::pair<const char*, const char*> kFormer[] = {
    {"friction", "coulomb"},
    {"damping", "viscous"},
    {"asymmetry", "direction_friction"},
    {"presliding", "friction.presliding_rad"},
    {"brake", "drive.brake_when_disabled"},
    {"velocity_lag", "sensor.velocity_lag_s"},
    {"inertia", "load.inertia_scale"},
    {"gravity", "load.gravity_scale"},
};

std::vector<std::string> parameter_names() {
  std::vector<std::string> names;
  for (const model::ActuatorParameter& parameter : model::actuator_parameters()) names.emplace_back(parameter.name);
  names.insert(names.end(), {"load.inertia_scale", "load.gravity_scale"});
  return names;
}

std::string in_code(const std::vector<std::string>& names) { return fmt::format("`{}`", fmt::join(names, "`, `")); }

}  // namespace

Meaning meaning(const std::string& word) {
  for (const auto& [former, present] : kFormer) {
    if (word == former) return {meaning(present).parameters, present};
  }
  const std::vector<std::string> parameters = parameter_names();
  if (contains(parameters, word)) return {{word}, ""};
  if (const Effect* one = find(word); one != nullptr) {
    Meaning found;
    std::ranges::copy_if(parameters, std::back_inserter(found.parameters),
                         [&](const std::string& name) { return contains(one->forms.front().parameters, name); });
    return found;
  }
  std::vector<std::string> known = parameters;
  for (const Effect& one : catalogue()) known.push_back(one.name);
  if (const std::string nearest = files::nearest_name(word, known); !nearest.empty())
    throw std::invalid_argument(fmt::format("'{}' isn't an effect; did you mean {}?", word, nearest));
  throw std::invalid_argument(fmt::format("'{}' isn't an effect; expected one of {}, or a parameter of motor.yaml",
                                          word, fmt::join(catalogue() | std::views::transform(&Effect::name), ", ")));
}

std::string table_of_words() {
  std::string table =
      "| word | parameters of motor.yaml | how it shows | what a recording needs |\n|---|---|---|---|\n";
  for (const Effect& one : catalogue())
    table +=
        fmt::format("| `{}` | {} | {} | {} |\n", one.name, in_code(meaning(one.name).parameters), one.shows, one.needs);
  return table;
}

std::string table_of_forms() {
  std::string table = "| effect | form | in words | parameters | source |\n|---|---|---|---|---|\n";
  for (const Effect& one : catalogue()) {
    for (const Form& form : one.forms) {
      std::string parameters = in_code(form.parameters);
      for (const FixedValue& fixed : form.fixed)
        parameters += fmt::format(", `{}` = {:g}", fixed.parameter, fixed.value);
      table += fmt::format("| `{}` | `{}` | {} | {} | {} |\n", one.name, form.name,
                           form.title.empty() ? one.title : form.title, parameters, form.source);
    }
  }
  return table;
}

}  // namespace pmg::effects
