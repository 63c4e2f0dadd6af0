#include "diagnosis/residual.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include "diagnosis/random_bench.hpp"

namespace pmg::diagnosis {
namespace {

std::vector<calib::SingleJoint> joints(const test::RandomBench& made) {
  std::vector<calib::SingleJoint> found;
  for (const bench::BenchRun& run : made.runs) found.emplace_back(made.bench, run, 0.001);
  return found;
}

const Dependence& named(const std::vector<Dependence>& all, std::string_view name) {
  return *std::find_if(all.begin(), all.end(), [&](const Dependence& d) { return d.name == name; });
}

TEST(Residual, OfTheTrueModelDependsOnNothing) {
  int significant = 0, all = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const test::RandomBench made = test::random_bench(seed);
    for (const Dependence& d : dependences(residual_samples(made.bench, joints(made), made.truth, 1))) {
      significant += d.significant() ? 1 : 0;
      ++all;
    }
  }
  EXPECT_GT(all, 40);
  EXPECT_LE(significant, all / 20);  // of 95 % intervals, half of what is outside is above
}

TEST(Residual, OfAMissingDelayGoesWithTheVelocity) {
  const test::RandomBench made =
      test::random_bench(2, [](test::RandomBench& b, std::mt19937&) { b.truth.actuator.command.delay_s = 0.03; });
  calib::JointModel wrong = made.truth;
  wrong.actuator.command.delay_s = 0.0;
  const auto found = dependences(residual_samples(made.bench, joints(made), wrong, 1));
  const Dependence& velocity = named(found, "velocity");
  EXPECT_TRUE(velocity.significant());
  EXPECT_GT(velocity.explained_share.value, 0.2);
  // Too soon is ahead: simulated minus measured has the sign of the motion.
  EXPECT_GT(velocity.bins.back().mean_rad.low, 0.0);
  EXPECT_LT(velocity.bins.front().mean_rad.high, 0.0);
}

TEST(Residual, HasTheCircumstancesThatTheBenchHas) {
  test::RandomBench made = test::random_bench(1, {}, test::Kind::kHorizontal);
  for (bench::BenchRun& run : made.runs) run.recording.temp_C.clear();
  const ResidualSamples samples = residual_samples(made.bench, joints(made), made.truth, 1);
  std::vector<std::string> names;
  for (const Circumstance& c : samples.circumstances) {
    names.push_back(c.name);
    EXPECT_EQ(c.values.size(), samples.residual_rad.size());
  }
  EXPECT_EQ(names,
            (std::vector<std::string>{"velocity", "position", "drive", "time since the command changed", "time"}));
}

TEST(Residual, SpectrumHasTheVarianceAndTheLine) {
  test::RandomBench made = test::random_bench(1);
  made.runs.resize(1);
  bench::Recording& r = made.runs[0].recording;
  calib::JointModel model = made.truth;
  const std::vector<double> simulated = calib::SingleJoint(made.bench, made.runs[0], 0.001).rollout(model);
  constexpr double kLine_Hz = 5.0, kAmplitude_rad = 0.01;
  for (std::size_t k = 0; k < r.t_s.size(); ++k) {
    r.q_rad[k] = simulated[k] - kAmplitude_rad * std::sin(2.0 * std::numbers::pi * kLine_Hz * r.t_s[k]);
  }
  const ResidualSpectrum spectrum = residual_spectrum(joints(made), model);
  ASSERT_GT(spectrum.windows, 2U);
  double variance_rad2 = 0.0;
  for (const double density : spectrum.residual_rad2_per_Hz) variance_rad2 += density * spectrum.frequency_Hz.front();
  EXPECT_NEAR(variance_rad2, 0.5 * kAmplitude_rad * kAmplitude_rad, 0.02 * kAmplitude_rad * kAmplitude_rad);
  const auto peak = std::max_element(spectrum.residual_rad2_per_Hz.begin(), spectrum.residual_rad2_per_Hz.end());
  EXPECT_NEAR(spectrum.frequency_Hz[static_cast<std::size_t>(peak - spectrum.residual_rad2_per_Hz.begin())], kLine_Hz,
              spectrum.frequency_Hz.front());
}

}  // namespace
}  // namespace pmg::diagnosis
