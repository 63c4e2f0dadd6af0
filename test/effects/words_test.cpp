#include "effects/words.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "effects/catalogue.hpp"
#include "folders.hpp"

namespace pmg::effects {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::UnorderedElementsAreArray;

std::string page(const std::string& name) {
  std::ifstream in(pmg::test::project_folder() + "/docs/" + name);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

TEST(Words, EveryEffectIsAWordForItsSimplestForm) {
  for (const Effect& one : catalogue()) {
    const Meaning found = meaning(one.name);
    EXPECT_THAT(found.parameters, UnorderedElementsAreArray(one.forms.front().parameters)) << one.name;
    EXPECT_TRUE(one.forms.front().fixed.empty()) << one.name << ": a word frees parameters and sets none";
    EXPECT_EQ(found.hint, "") << one.name;
  }
}

TEST(Words, ParametersComeInTheOrderOfMotorYaml) {
  EXPECT_THAT(meaning("backlash").parameters,
              ElementsAre("transmission.stiffness_Nm_per_rad", "transmission.damping_Nm_s_per_rad",
                          "transmission.backlash_rad"));
}

TEST(Words, FormerWordsAreTakenAndThePresentOneIsSaid) {
  const std::pair<const char*, const char*> kFormer[] = {{"friction", "coulomb"},
                                                         {"damping", "viscous"},
                                                         {"asymmetry", "direction_friction"},
                                                         {"presliding", "friction.presliding_rad"},
                                                         {"brake", "drive.brake_when_disabled"},
                                                         {"velocity_lag", "sensor.velocity_lag_s"},
                                                         {"inertia", "load.inertia_scale"},
                                                         {"gravity", "load.gravity_scale"}};
  for (const auto& [former, present] : kFormer) {
    EXPECT_EQ(meaning(former).hint, present);
    EXPECT_EQ(meaning(former).parameters, meaning(present).parameters);
    EXPECT_EQ(meaning(present).hint, "");
  }
}

TEST(Words, AnUnknownWordIsRefusedWithTheNearest) {
  const auto refusal = [](const char* word) -> std::string {
    try {
      meaning(word);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal("backlsh"), "'backlsh' isn't an effect; did you mean backlash?");
  EXPECT_THAT(refusal("magic"), HasSubstr("expected one of coulomb, viscous, "));
}

TEST(Words, TheTablesOfThePagesAreThoseOfTheCatalogue) {
  EXPECT_THAT(page("how-to/calibration.md"), HasSubstr("\n" + table_of_words() + "\n")) << "write this table there";
  EXPECT_THAT(page("reference/effects.md"), HasSubstr("\n" + table_of_forms() + "\n")) << "write this table there";
}

}  // namespace
}  // namespace pmg::effects
