#include "score.hpp"

#include <gtest/gtest.h>

#include "promise.hpp"

namespace pmg::literature {
namespace {

using nlohmann::json;

json cause_of(const std::string& effect, const std::vector<std::string>& or_instead = {}) {
  return {{"effect", effect},
          {"or_instead", or_instead},
          {"parameters", {{"command.delay_s", {{"value", 0.01}, {"low", 0.009}, {"high", 0.011}}}}}};
}

json verdict_with(const std::string& verdict, const std::vector<json>& causes) {
  return {{"verdict", verdict}, {"causes", causes}};
}

json scored_plant(const std::string& kind, const std::vector<std::pair<std::string, double>>& planted,
                  const json& diagnosis) {
  json effects = json::array();
  for (const auto& [name, floors] : planted) {
    effects.push_back({{"effect", name}, {"moves_floors", floors}, {"parameters", {{"command.delay_s", 0.0105}}}});
  }
  return {{"truth", {{"seed", 1}, {"kind", kind}, {"effects", effects}}}, {"diagnosis", diagnosis}, {"seconds", 1.0}};
}

TEST(LiteratureScore, OnlyTheTruthAndNothingElseIsNamed) {
  const auto named = [](const json& diagnosis) {
    return score(scored_plant("single", {{"delay", 5.0}}, diagnosis)).named;
  };
  EXPECT_TRUE(named(verdict_with("found", {cause_of("delay")})));
  EXPECT_FALSE(named(verdict_with("found", {cause_of("delay"), cause_of("gain")})));
  EXPECT_FALSE(named(verdict_with("found", {cause_of("gain")})));
  EXPECT_FALSE(named(verdict_with("found", {})));
  EXPECT_FALSE(named(verdict_with("unexplained", {cause_of("delay")})));
  EXPECT_FALSE(named(verdict_with("none", {})));
}

TEST(LiteratureScore, AmbiguousCountsOnlyWithTheTruthAmongTheSuspects) {
  const auto named = [](const json& diagnosis) {
    return score(scored_plant("single", {{"delay", 5.0}}, diagnosis)).named;
  };
  EXPECT_TRUE(named(verdict_with("ambiguous", {cause_of("delay", {"sensor_lag"})})));
  EXPECT_TRUE(named(verdict_with("ambiguous", {cause_of("sensor_lag", {"delay"})})));
  EXPECT_FALSE(named(verdict_with("ambiguous", {cause_of("sensor_lag", {"gain"})})));
  EXPECT_FALSE(named(verdict_with("ambiguous", {cause_of("delay", {"sensor_lag"}), cause_of("gain")})));
}

TEST(LiteratureScore, OfTwoEffectsTheStrongOnesMustBeFoundAndTheWeakOnesMay) {
  const auto named = [](const json& diagnosis) {
    return score(scored_plant("double", {{"delay", 5.0}, {"gain", 0.5}}, diagnosis)).named;
  };
  EXPECT_TRUE(named(verdict_with("found", {cause_of("delay")})));
  EXPECT_TRUE(named(verdict_with("found", {cause_of("delay"), cause_of("gain")})));
  EXPECT_FALSE(named(verdict_with("found", {cause_of("gain")})));
  EXPECT_FALSE(
      score(scored_plant("double", {{"delay", 5.0}, {"gain", 3.0}}, verdict_with("found", {cause_of("delay")}))).named);
}

TEST(LiteratureScore, AnyCauseOfACleanPlantIsFalse) {
  EXPECT_FALSE(score(scored_plant("clean", {}, verdict_with("none", {}))).accused);
  EXPECT_TRUE(score(scored_plant("clean", {}, verdict_with("found", {cause_of("delay")}))).accused);
  EXPECT_TRUE(score(scored_plant("clean", {}, verdict_with("ambiguous", {cause_of("delay", {"gain"})}))).accused);
}

TEST(LiteratureScore, WhatWasAskedForSettlesOnlyWithTheTruth) {
  json asked = scored_plant("single", {{"delay", 5.0}}, verdict_with("ambiguous", {cause_of("delay", {"gain"})}));
  EXPECT_FALSE(score(asked).settled);
  asked["asked"] = verdict_with("ambiguous", {cause_of("delay", {"gain"})});
  EXPECT_FALSE(score(asked).settled);
  asked["asked"] = verdict_with("found", {cause_of("delay")});
  EXPECT_TRUE(score(asked).settled);
}

TEST(LiteratureScore, ParametersAreHeldAgainstTheirIntervals) {
  const Score s = score(scored_plant("single", {{"delay", 5.0}}, verdict_with("found", {cause_of("delay")})));
  ASSERT_EQ(s.parameters.size(), 1U);
  EXPECT_TRUE(s.parameters.front().inside());
  EXPECT_NEAR(s.parameters.front().width(), 0.002 / 0.0105, 1e-12);
}

TEST(LiteratureScore, FewPlantsDontBreakAPromiseThatManyDo) {
  const Promise few{"named", true, 0.9, 15, 18}, many{"named", true, 0.9, 150, 180};
  EXPECT_GT(few.chance(), 0.2);
  EXPECT_TRUE(few.is_likely());
  EXPECT_LT(many.chance(), 0.005);
  EXPECT_FALSE(many.is_likely());
  const Promise ambiguous{"ambiguous", false, 0.15, 9, 18};
  EXPECT_LT(ambiguous.chance(), 1e-3);
}

}  // namespace
}  // namespace pmg::literature
