#include "effects/catalogue.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include "calib/synthetic_bench.hpp"
#include "calib/unknown.hpp"
#include "folders.hpp"
#include "generated_table.hpp"
#include "model/actuator_parameters.hpp"

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

/// From one line of the page to another.
std::string part_of_page(const std::string& from, const std::string& to) {
  std::ostringstream text;
  text << std::ifstream(test::project_folder() + "/docs/reference/effects.md").rdbuf();
  const std::string page = text.str();
  return page.substr(page.find(from), page.find(to) - page.find(from));
}

TEST(Catalogue, EverySourceHasItsTitleInTheDocumentation) {
  std::string titles = part_of_page("Sources, in the order of the table:", "### Formulas");
  std::erase(titles, '\n');  // a line that goes on begins with two spaces
  for (const Effect& effect : effects::catalogue()) {
    for (const Form& form : effect.forms) {
      std::istringstream sources(form.source);
      for (std::string source; std::getline(sources >> std::ws, source, ';');)
        EXPECT_NE(titles.find(" " + source + ": "), std::string::npos) << effect.name << ": " << source;
    }
  }
}

TEST(Catalogue, EveryParameterHasItsFormulaInTheDocumentation) {
  std::istringstream rows(part_of_page("| effect | parameters | formula | source |", "Why is a recording late"));
  std::set<std::string> names;
  for (std::string row; std::getline(rows, row);) {
    std::istringstream quoted(row);
    std::string group, text;
    for (bool is_name = false; std::getline(quoted, text, '`'); is_name = !is_name) {
      if (!is_name) continue;
      const std::size_t point = text.find('.');  // the group may stand once in a row
      if (point != std::string::npos) group = text.substr(0, point + 1);
      names.insert(point == std::string::npos ? group + text : text);
    }
  }
  for (const model::ActuatorParameter& parameter : model::actuator_parameters())
    EXPECT_TRUE(names.contains(std::string(parameter.name))) << parameter.name;
}

TEST(Catalogue, WordsForPeopleNameTheFormAndThoseThatAreLeftOpen) {
  EXPECT_EQ(effects::described("viscous", "quadratic", {}), "viscous friction, growing with the square of speed");
  EXPECT_EQ(effects::described("viscous", "quadratic", {"linear"}),
            "viscous friction, growing with the square of speed (not told from: growing in proportion to speed)");
  EXPECT_EQ(effects::described("quantisation", "rounds", {}), "quantisation") << "the only form has no words";
}

}  // namespace
}  // namespace pmg::diagnosis
