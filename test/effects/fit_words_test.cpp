#include "effects/fit_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calib/unknown.hpp"
#include "effects/catalogue.hpp"
#include "generated_table.hpp"

namespace pmg::effects {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(FitWords, EveryEffectOfADiagnosisIsOneByItsName) {
  const std::vector<std::string> words = fit_words();
  for (const Effect& effect : catalogue()) {
    EXPECT_TRUE(contains(words, effect.name)) << effect.name;
    EXPECT_EQ(fit_word(effect.name).parameters, effect.forms.front().parameters) << effect.name;
  }
  EXPECT_GE(words.size(), 24U);
}

TEST(FitWords, EachHasParametersThatAFitKnows) {
  for (const std::string& word : fit_words()) {
    const FitWord found = fit_word(word);
    EXPECT_EQ(found.today, "") << word;
    EXPECT_FALSE(found.parameters.empty()) << word;
    for (const std::string& name : found.parameters) EXPECT_EQ(calib::unknown(name, {}).name, name) << word;
  }
}

TEST(FitWords, ThoseOfEarlierVersionsMeanWhatTheyMeantAndTellTodays) {
  EXPECT_THAT(fit_word("friction").parameters, ElementsAre("friction.coulomb_Nm"));
  EXPECT_EQ(fit_word("friction").today, "coulomb");
  EXPECT_THAT(fit_word("damping").parameters, ElementsAre("friction.viscous_Nm_s_per_rad"));
  EXPECT_EQ(fit_word("damping").today, "viscous");
  EXPECT_THAT(fit_word("asymmetry").parameters, ElementsAre("friction.asymmetry"));
  EXPECT_EQ(fit_word("asymmetry").today, "direction_friction");
  EXPECT_THAT(fit_word("inertia").parameters, ElementsAre("load.inertia_scale"));
  EXPECT_EQ(fit_word("inertia").today, "load.inertia_scale");
  EXPECT_THAT(fit_word("gravity").parameters, ElementsAre("load.gravity_scale"));
}

TEST(FitWords, AParameterIsItsOwnWord) {
  EXPECT_THAT(fit_word("friction.stribeck_exponent").parameters, ElementsAre("friction.stribeck_exponent"));
  EXPECT_THAT(fit_word("load.gravity_scale").parameters, ElementsAre("load.gravity_scale"));
}

TEST(FitWords, ThePageHasThemAll) {
  std::string rows;
  for (const std::string& word : fit_words()) {
    const FitWord found = fit_word(word);
    rows +=
        fmt::format("| `{}` | `{}` | {} | {} |\n", word, fmt::join(found.parameters, "`, `"), found.shows, found.needs);
  }
  test::expect_table("how-to/calibration.md", "| word | parameters of motor.yaml | how it shows | what shows it |",
                     rows);
}

std::string refusal(const std::string& word) {
  try {
    fit_word(word);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(FitWords, AnUnknownOneIsRefusedWithTheNearestOrAll) {
  EXPECT_EQ(refusal("coulom"), "'coulom' isn't an effect; did you mean coulomb?");
  EXPECT_EQ(refusal("frictoin"), "'frictoin' isn't an effect; did you mean friction?");
  EXPECT_THAT(refusal("magic"), HasSubstr("expected one of coulomb, viscous, stribeck"));
}

}  // namespace
}  // namespace pmg::effects
