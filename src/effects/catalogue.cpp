#include "effects/catalogue.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <ranges>
#include <stdexcept>

#include "effects/named.hpp"

namespace pmg::effects {

namespace {

/// Empty where the effect has one form only, or doesn't know the name.
std::string form_title(const std::string& effect, const std::string& form) {
  if (const Effect* one = find(effect); one != nullptr) {
    for (const Form& each : one->forms) {
      if (each.name == form) return each.title;
    }
  }
  return "";
}

}  // namespace

std::span<const Effect> catalogue() {
#define PMG_EFFECT(name) named::name(),
  static const std::vector<Effect> kEffects = {PMG_EFFECTS(PMG_EFFECT)};
#undef PMG_EFFECT
  return kEffects;
}

const Effect* find(std::string_view name) {
  const std::span<const Effect> all = catalogue();
  const auto found = std::ranges::find(all, name, &Effect::name);
  return found == all.end() ? nullptr : &*found;
}

const Effect& effect(std::string_view name) {
  if (const Effect* one = find(name); one != nullptr) return *one;
  throw std::invalid_argument(fmt::format("no effect is called '{}'; expected one of {}", name,
                                          fmt::join(catalogue() | std::views::transform(&Effect::name), ", ")));
}

std::string title(const std::string& name) {
  const Effect* one = find(name);
  return one == nullptr ? name : one->title;
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
