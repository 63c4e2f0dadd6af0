#include "effects/pair_screen.hpp"

#include <gtest/gtest.h>

#include "calib/synthetic_bench.hpp"

namespace pmg::effects {
namespace {

calib::JointModel without_effects() { return test::plain_joint(0.1); }

TEST(ScreenedPairs, TheTwoEffectsOfAJointComeFirst) {
  const bench::Bench bench = test::pd_bench(true);
  calib::JointModel truth = without_effects();
  truth.actuator.command.delay_s = 0.01;
  truth.actuator.ripple.offset_Nm = 0.2;
  const NestedFit fit(test::record(bench, truth, 4, 1e-4), 1);
  NestedModel current = fit.fit(without_effects(), {}, 0);
  fit.linearise(current);
  const StartScreen screen(fit, current);
  const BenchScale scale = scale_of(bench, fit.runs(), without_effects());
  std::vector<EffectStart> starts;
  for (const char* name : {"coulomb", "delay", "offset", "zero_offset", "viscous"}) {
    for (const ScreenedStart& start : screen.best(effect(name), 0, scale)) starts.push_back({&effect(name), start});
  }
  const std::vector<ScreenedPair> pairs = screened_pairs(screen, starts);
  ASSERT_FALSE(pairs.empty());
  EXPECT_EQ(pairs.front().first->effect->name, "delay");
  EXPECT_EQ(pairs.front().second->effect->name, "offset");
  EXPECT_LT(pairs.front().squares, 0.1 * current.squares) << "one alone leaves the other's residual";
  for (const ScreenedPair& pair : pairs) EXPECT_NE(pair.first->effect, pair.second->effect);
}

}  // namespace
}  // namespace pmg::effects
