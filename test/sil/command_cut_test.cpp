// What of a run's commands counts as cut, and how it is told.
#include "sil/command_cut.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace pmg::sil {
namespace {

constexpr int kSecond = 100;  // ticks

/// The admitted command ramps from `from` to `to`, then stays there; beyond as told of the ramp and of what follows.
void hold(CommandCuts& cuts, const Command& asked, const Command& from, const Command& to, bool beyond_at_first,
          bool beyond, int ticks = kSecond) {
  for (int k = 1; k <= ticks; ++k) {
    const double share = std::min(1.0, 2.0 * k / kSecond);
    Command admitted;
    for (std::size_t i = 0; i < kChannels; ++i) admitted.u[i] = from.u[i] + share * (to.u[i] - from.u[i]);
    cuts.add(asked, admitted, share < 1.0 ? beyond_at_first : beyond);
  }
}

TEST(CommandCut, OfACommandBeyondTheRangeItsLastAdmittedOneIsTold) {
  CommandCuts cuts;
  hold(cuts, {}, {}, {}, false, false);
  hold(cuts, {{50.0}}, {}, {{0.8}}, true, true);
  const CommandCut cut = cuts.worst();
  EXPECT_DOUBLE_EQ(cut.for_s, 1.0);
  EXPECT_EQ(cut.commands, 1);
  EXPECT_EQ(cut_text(cut), "forward 50 m/s asked, 0.8 m/s admitted");
  const auto json = cut_json(cut);
  EXPECT_EQ(json["worst"]["asked"]["vx_m_s"], 50.0);
  EXPECT_NEAR(json["worst"]["admitted"]["vx_m_s"].get<double>(), 0.8, 1e-12);
  EXPECT_EQ(json["text"], cut_text(cut));
}

TEST(CommandCut, WhatIsAdmittedAsAskedIsNoCut) {
  CommandCuts cuts;
  hold(cuts, {{0.8}}, {}, {{0.8}}, false, false);
  hold(cuts, {{0.8, 0.0, 0.0, 0.2, 0.0, -0.05}}, {{0.8}}, {{0.8, 0.0, 0.0, 0.2, 0.0, -0.05}}, false, false);
  EXPECT_EQ(cuts.worst().commands, 0);
  EXPECT_EQ(cut_text(cuts.worst()), "");
  EXPECT_TRUE(cut_json(cuts.worst()).is_null());
}

TEST(CommandCut, ARampThatMixesTwoCommandsIsNoCut) {
  CommandCuts cuts;
  hold(cuts, {{0.8}}, {}, {{0.8}}, false, false);
  hold(cuts, {{0.0, 0.35}}, {{0.8}}, {{0.0, 0.35}}, true, false);
  EXPECT_EQ(cuts.worst().commands, 0);
  for (int k = 0; k < 30; ++k) cuts.add({{-0.5}}, {{0.8 - 0.01 * k, 0.35 - 0.01 * k}}, k < 20);
  EXPECT_EQ(cuts.worst().commands, 0) << "nor where the next command comes before the ramp's end";
}

TEST(CommandCut, RoundingIsNoCut) {
  CommandCuts cuts;
  hold(cuts, {{0.804}}, {}, {{0.8}}, true, true);
  EXPECT_EQ(cuts.worst().commands, 0);
  hold(cuts, {{0.82}}, {}, {{0.8}}, true, true);
  EXPECT_EQ(cuts.worst().commands, 1);
}

TEST(CommandCut, TheWorstOfSeveralIsToldAndTheyAreCounted) {
  CommandCuts cuts;
  hold(cuts, {{0.8, 0.35}}, {}, {{0.5, 0.2}}, true, true);
  hold(cuts, {{0.0, 0.0, -9.0, 0.0, 0.7}}, {}, {{0.0, 0.0, -0.8, 0.0, 0.25}}, true, true);
  hold(cuts, {{1.0}}, {}, {{0.8}}, true, true);
  const CommandCut cut = cuts.worst();
  EXPECT_EQ(
      cut_text(cut),
      "turn -9 rad/s asked, -0.8 rad/s admitted; roll 0.7 rad asked, 0.25 rad admitted (the worst of 3 commands)");
  EXPECT_DOUBLE_EQ(cut.for_s, 3.0);
}

TEST(CommandCut, NobodyIsAskedToFollowInAnotherMode) {
  CommandCuts cuts;
  hold(cuts, {{50.0}}, {}, {{0.8}}, true, true);
  for (int k = 0; k < kSecond; ++k) cuts.skip();
  EXPECT_EQ(cuts.worst().commands, 1);
  EXPECT_DOUBLE_EQ(cuts.worst().for_s, 1.0);
  hold(cuts, {{50.0}}, {}, {{0.8}}, true, true);
  EXPECT_EQ(cuts.worst().commands, 2) << "it was asked for anew";
}

}  // namespace
}  // namespace pmg::sil
