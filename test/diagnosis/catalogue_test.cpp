#include "effects/catalogue.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "calib/fit_problem.hpp"
#include "calib/synthetic_bench.hpp"
#include "effects/starts.hpp"
#include "folders.hpp"

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
      for (const std::string& parameter : form.parameters) EXPECT_NO_THROW(calib::fit_parameter(parameter, bench));
      for (const effects::FixedValue& fixed : form.fixed) EXPECT_NO_THROW(calib::fit_parameter(fixed.parameter, bench));
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
  std::ifstream in(pmg::test::project_folder() + "/docs/reference/effects.md");
  std::ostringstream read;
  read << in.rdbuf();
  const std::string text = read.str();
  for (const Effect& effect : effects::catalogue()) {
    for (const Form& form : effect.forms) {
      const std::string row = "| `" + effect.name + "` | `" + form.name + "` |";
      const std::size_t at = text.find(row);
      ASSERT_NE(at, std::string::npos) << row;
      const std::string line = text.substr(at, text.find('\n', at) - at);
      EXPECT_NE(line.find(form.source), std::string::npos) << line;
      for (const std::string& parameter : form.parameters)
        EXPECT_NE(line.find("`" + parameter + "`"), std::string::npos) << line << " lacks " << parameter;
      for (const effects::FixedValue& fixed : form.fixed)
        EXPECT_NE(line.find("`" + fixed.parameter + "` = "), std::string::npos) << line << " lacks " << fixed.parameter;
    }
  }
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
