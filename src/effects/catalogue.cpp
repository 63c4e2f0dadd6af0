#include "effects/catalogue.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace pmg::effects {

namespace {

/// Empty where the effect has one form only, or doesn't know the name.
std::string form_title(const std::string& effect, const std::string& form) {
  for (const Effect& one : catalogue()) {
    if (one.name != effect) continue;
    for (const Form& each : one.forms) {
      if (each.name == form) return each.title;
    }
  }
  return "";
}

}  // namespace

const Effect& effect(std::string_view name) {
  std::string names;
  for (const Effect& one : catalogue()) {
    if (one.name == name) return one;
    names += (names.empty() ? "" : ", ") + one.name;
  }
  throw std::invalid_argument(fmt::format("no effect is called '{}'; expected one of {}", name, names));
}

std::string title(const std::string& name) {
  for (const Effect& one : catalogue()) {
    if (one.name == name) return one.title;
  }
  return name;
}

std::string described(const std::string& effect, const std::string& form, const std::vector<std::string>& open_forms) {
  std::string text = title(effect);
  if (const std::string of_form = form_title(effect, form); !of_form.empty()) text += ", " + of_form;
  std::string others;
  for (const std::string& other : open_forms) others += (others.empty() ? "" : "; ") + form_title(effect, other);
  return others.empty() ? text : text + " (not told from: " + others + ")";
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace pmg::effects
