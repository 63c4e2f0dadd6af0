#include "forms_table.hpp"

#include <fmt/format.h>

#include "planting.hpp"

namespace pmg::literature {

std::string forms_table() {
  std::vector<Form> all = catalogue_forms();
  const std::vector<Form> strange = strange_forms();
  const std::size_t of_catalogue = all.size();
  all.insert(all.end(), strange.begin(), strange.end());
  std::string text = "| effect | forms |\n|---|---|\n", effect;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Form& form = all[i];
    const std::string one = fmt::format("{} ({})", form.form, form.source);
    if (effect == form.effect) {
      text += "; " + one;
      continue;
    }
    if (!effect.empty()) text += " |\n";
    effect = form.effect;
    text += fmt::format("| {}`{}` | {}", i < of_catalogue ? "" : "off the catalogue: ", effect, one);
  }
  return text + " |\n";
}

}  // namespace pmg::literature
