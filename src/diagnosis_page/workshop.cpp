#include "diagnosis_page/workshop.hpp"

#include "effects/catalogue.hpp"

namespace pmg::diagnosis_page {

effects::WorkshopWords workshop_words(const std::string& effect) {
  const effects::Effect* one = effects::find(effect);
  return one == nullptr ? effects::WorkshopWords{effect, "", ""} : one->workshop;
}

std::string in_workshop_words(const std::vector<std::string>& effects, const std::string& last_joint) {
  std::string text;
  for (std::size_t i = 0; i < effects.size(); ++i) {
    if (i > 0) text += i + 1 == effects.size() ? last_joint : ", ";
    text += workshop_words(effects[i]).what;
  }
  return text;
}

}  // namespace pmg::diagnosis_page
