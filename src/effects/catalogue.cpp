#include "effects/catalogue.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "effects/families.hpp"

namespace pmg::effects {

namespace {

std::vector<Effect> entries() {
  std::vector<Effect> found;
  for (const auto family : {friction_effects, transmission_effects, command_effects, drive_effects, sensor_effects,
                            warmth_and_load_effects}) {
    std::ranges::move(family(), std::back_inserter(found));
  }
  return found;
}

/// Nothing for a name from another version of the catalogue.
const Effect* find(std::string_view name) {
  const auto found = std::ranges::find(catalogue(), name, &Effect::name);
  return found == catalogue().end() ? nullptr : &*found;
}

/// Nothing for a name that the effect doesn't know.
const Form* find(const Effect& effect, const std::string& form) {
  const auto found = std::ranges::find(effect.forms, form, &Form::name);
  return found == effect.forms.end() ? nullptr : &*found;
}

/// Empty where the effect has one form only, or doesn't know the name.
std::string form_title(const std::string& effect, const std::string& form) {
  const Effect* const one = find(effect);
  const Form* const found = one == nullptr ? nullptr : find(*one, form);
  return found == nullptr ? "" : found->title;
}

}  // namespace

std::span<const Effect> catalogue() {
  static const std::vector<Effect> kEntries = entries();
  return kEntries;
}

const Effect& effect(std::string_view name) {
  if (const Effect* const found = find(name)) return *found;
  std::string names;
  for (const Effect& one : catalogue()) names += (names.empty() ? "" : ", ") + one.name;
  throw std::invalid_argument(fmt::format("no effect is called '{}'; expected one of {}", name, names));
}

std::string title(const std::string& name) {
  const Effect* const found = find(name);
  return found == nullptr ? name : found->title;
}

WorkshopWords workshop_words(const std::string& effect, const std::string& form) {
  const Effect* const found = find(effect);
  if (found == nullptr) return {effect, "", ""};
  WorkshopWords words = found->workshop;
  if (const Form* const one = find(*found, form)) {
    if (!one->workshop.what.empty()) words.what = one->workshop.what;
    if (!one->workshop.check.empty()) words.check = one->workshop.check;
    if (!one->workshop.cost.empty()) words.cost = one->workshop.cost;
  }
  return words;
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
