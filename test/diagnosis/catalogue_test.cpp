#include "effects/catalogue.hpp"

#include <gtest/gtest.h>

#include "calib/fit_problem.hpp"

namespace pmg::diagnosis {
namespace {

TEST(Catalogue, EveryParameterIsOneOfTheSimulation) {
  const bench::Bench bench;
  for (const effects::Effect& effect : effects::catalogue()) {
    EXPECT_FALSE(effect.parameters.empty()) << effect.name;
    for (const std::string& parameter : effect.parameters) EXPECT_NO_THROW(calib::fit_parameter(parameter, bench));
  }
}

TEST(Catalogue, AnUnknownNameIsRefusedWithTheNamesThereAre) {
  EXPECT_THROW(effects::effect("frction"), std::invalid_argument);
  EXPECT_EQ(effects::effect("delay").parameters.front(), "command.delay_s");
}

}  // namespace
}  // namespace pmg::diagnosis
