#include "forms_table.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "planting.hpp"

namespace pmg::literature {

std::string forms_table() {
  std::vector<Form> all = catalogue_forms();
  const auto of_what = [](const Form& form) {
    return is_data_fault(form) ? "data fault: " : off_catalogue(form) ? "off the catalogue: " : "";
  };
  for (const Form& form : strange_forms()) {
    const auto same = std::find_if(all.rbegin(), all.rend(),
                                   [&](const Form& other) { return other.effect == std::string(form.effect); });
    all.insert(off_catalogue(form) ? all.end() : same.base(), form);
  }
  std::string text = "| effect | forms |\n|---|---|\n", effect;
  for (const Form& form : all) {
    const std::string one = fmt::format("{} ({})", form.form, form.source);
    if (effect == form.effect) {
      text += "; " + one;
      continue;
    }
    if (!effect.empty()) text += " |\n";
    effect = form.effect;
    text += fmt::format("| {}`{}` | {}", of_what(form), effect, one);
  }
  return text + " |\n";
}

}  // namespace pmg::literature
