#include "effects/catalogue.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <set>

#include "calib/synthetic_bench.hpp"
#include "calib/unknown.hpp"
#include "generated_table.hpp"

namespace pmg::diagnosis {
namespace {

using effects::Effect;
using effects::Form;

TEST(Catalogue, EveryParameterIsOneOfTheSimulation) {
  const bench::Bench bench;
  for (const Effect& effect : effects::catalogue()) {
    EXPECT_FALSE(effect.forms.empty()) << effect.name;
    for (const Form& form : effect.forms) {
      EXPECT_FALSE(form.parameters.empty()) << effect.name << " " << form.name;
      for (const std::string& parameter : form.parameters) EXPECT_NO_THROW(calib::unknown(parameter, bench));
      for (const effects::FixedValue& fixed : form.fixed) EXPECT_NO_THROW(calib::unknown(fixed.parameter, bench));
    }
  }
}

TEST(Catalogue, AnUnknownNameIsRefusedWithTheNamesThereAre) {
  EXPECT_THROW(effects::effect("frction"), std::invalid_argument);
  EXPECT_EQ(effects::effect("delay").forms.front().parameters.front(), "command.delay_s");
}

TEST(Catalogue, FormsOfAnEffectHaveNamesTitlesAndSources) {
  for (const Effect& effect : effects::catalogue()) {
    std::set<std::string> names, titles;
    for (const Form& form : effect.forms) {
      EXPECT_TRUE(names.insert(form.name).second) << effect.name << " " << form.name;
      EXPECT_TRUE(titles.insert(form.title).second) << effect.name << " " << form.name;
      EXPECT_EQ(form.title.empty(), effect.forms.size() == 1) << effect.name << " " << form.name;
      EXPECT_FALSE(form.source.empty()) << effect.name << " " << form.name;
    }
  }
}

TEST(Catalogue, EveryFormIsInTheDocumentationWithItsSource) {
  std::string rows;
  for (const Effect& effect : effects::catalogue()) {
    for (const Form& form : effect.forms) {
      std::string words = form.title.empty() ? effect.title : form.title, parameters;
      for (const std::string& parameter : form.parameters)
        parameters += fmt::format("{}`{}`", parameters.empty() ? "" : ", ", parameter);
      for (const effects::FixedValue& fixed : form.fixed)
        parameters += fmt::format(", `{}` = {}", fixed.parameter, fixed.value);
      rows += fmt::format("| `{}` | `{}` | {} | {} | {} |\n", effect.name, form.name, words, parameters, form.source);
    }
  }
  test::expect_table("reference/effects.md", "| effect | form | in words | parameters | source |", rows);
}

TEST(Catalogue, WordsForPeopleNameTheFormAndThoseThatAreLeftOpen) {
  EXPECT_EQ(effects::described("viscous", "quadratic", {}), "viscous friction, growing with the square of speed");
  EXPECT_EQ(effects::described("viscous", "quadratic", {"linear"}),
            "viscous friction, growing with the square of speed (not told from: growing in proportion to speed)");
  EXPECT_EQ(effects::described("offset", "constant", {}), "constant torque (asymmetry)")
      << "the only form has no words";
}

}  // namespace
}  // namespace pmg::diagnosis
