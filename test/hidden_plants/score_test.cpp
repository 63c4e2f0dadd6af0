#include "blind_plants/score.hpp"

#include <gtest/gtest.h>

#include "tally.hpp"

namespace pmg::hidden {
namespace {

using nlohmann::json;

json cause(const std::string& effect, const std::vector<std::string>& or_instead = {}) {
  return {{"effect", effect},
          {"or_instead", or_instead},
          {"parameters", {{"command.delay_s", {{"value", 0.01}, {"low", 0.009}, {"high", 0.011}}}}}};
}

json said(const std::string& verdict, const std::vector<json>& causes) {
  return {{"verdict", verdict}, {"causes", causes}};
}

json result(const std::string& kind, const std::vector<std::pair<std::string, double>>& planted,
            const json& diagnosis) {
  json effects = json::array();
  for (const auto& [name, floors] : planted) {
    effects.push_back({{"effect", name}, {"moves_floors", floors}, {"parameters", {{"command.delay_s", 0.0105}}}});
  }
  return {{"truth", {{"seed", 1}, {"kind", kind}, {"effects", effects}}}, {"diagnosis", diagnosis}, {"seconds", 1.0}};
}

TEST(HiddenPlantScore, OnlyTheTruthAndNothingElseIsNamed) {
  const auto named = [](const json& diagnosis) { return score(result("single", {{"delay", 5.0}}, diagnosis)).named; };
  EXPECT_TRUE(named(said("found", {cause("delay")})));
  EXPECT_FALSE(named(said("found", {cause("delay"), cause("gain")})));
  EXPECT_FALSE(named(said("found", {cause("gain")})));
  EXPECT_FALSE(named(said("found", {})));
  EXPECT_FALSE(named(said("unexplained", {cause("delay")})));
  EXPECT_FALSE(named(said("none", {})));
}

TEST(HiddenPlantScore, AmbiguousCountsOnlyWithTheTruthAmongTheSuspects) {
  const auto named = [](const json& diagnosis) { return score(result("single", {{"delay", 5.0}}, diagnosis)).named; };
  EXPECT_TRUE(named(said("ambiguous", {cause("delay", {"sensor_lag"})})));
  EXPECT_TRUE(named(said("ambiguous", {cause("sensor_lag", {"delay"})})));
  EXPECT_FALSE(named(said("ambiguous", {cause("sensor_lag", {"gain"})})));
  EXPECT_FALSE(named(said("ambiguous", {cause("delay", {"sensor_lag"}), cause("gain")})));
}

TEST(HiddenPlantScore, OfTwoEffectsTheStrongOnesMustBeFoundAndTheWeakOnesMay) {
  const auto named = [](const json& diagnosis) {
    return score(result("double", {{"delay", 5.0}, {"gain", 0.5}}, diagnosis)).named;
  };
  EXPECT_TRUE(named(said("found", {cause("delay")})));
  EXPECT_TRUE(named(said("found", {cause("delay"), cause("gain")})));
  EXPECT_FALSE(named(said("found", {cause("gain")})));
  EXPECT_FALSE(score(result("double", {{"delay", 5.0}, {"gain", 3.0}}, said("found", {cause("delay")}))).named);
}

TEST(HiddenPlantScore, AnyCauseOfACleanPlantIsFalse) {
  EXPECT_FALSE(score(result("clean", {}, said("none", {}))).accused);
  EXPECT_TRUE(score(result("clean", {}, said("found", {cause("delay")}))).accused);
  EXPECT_TRUE(score(result("clean", {}, said("ambiguous", {cause("delay", {"gain"})}))).accused);
}

TEST(HiddenPlantScore, WhatWasAskedForSettlesOnlyWithTheTruth) {
  json asked = result("single", {{"delay", 5.0}}, said("ambiguous", {cause("delay", {"gain"})}));
  EXPECT_FALSE(score(asked).settled);
  asked["asked"] = said("ambiguous", {cause("delay", {"gain"})});
  EXPECT_FALSE(score(asked).settled);
  asked["asked"] = said("found", {cause("delay")});
  EXPECT_TRUE(score(asked).settled);
}

TEST(HiddenPlantScore, ParametersAreHeldAgainstTheirIntervals) {
  const Score s = score(result("single", {{"delay", 5.0}}, said("found", {cause("delay")})));
  ASSERT_EQ(s.parameters.size(), 1U);
  EXPECT_TRUE(s.parameters.front().inside());
  EXPECT_NEAR(s.parameters.front().width(), 0.002 / 0.0105, 1e-12);
}

TEST(HiddenPlantScore, FewPlantsDontBreakAPromiseThatManyDo) {
  const Promise few{"named", true, 0.9, 15, 18}, many{"named", true, 0.9, 150, 180};
  EXPECT_GT(few.chance(), 0.2);
  EXPECT_LT(many.chance(), 0.005);
  EXPECT_FALSE(few.holds());
  const Promise ambiguous{"ambiguous", false, 0.15, 9, 18};
  EXPECT_LT(ambiguous.chance(), 1e-3);
}

}  // namespace
}  // namespace pmg::hidden
