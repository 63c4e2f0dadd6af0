// A wrong mass or gain that an effect hides from a quick model shows beside the model that a diagnosis found.
#include <gtest/gtest.h>

#include <cmath>

#include "data_faults/benches.hpp"
#include "data_faults/effects.hpp"
#include "data_faults/examine.hpp"

namespace pmg::data_faults {
namespace {

using test::text;

constexpr unsigned kSeeds[] = {1, 2};

/// Four loads by three gains.
test::RandomBench bench_with(const test::Effect& effect, unsigned seed) {
  constexpr double kLoads[] = {1.0, 1.25, 1.6, 2.0}, kGains[] = {1.0, 1.5, 2.2};
  test::RandomBench made = test::random_bench(
      seed,
      [&](test::RandomBench& bench, std::mt19937&) {
        effect.set(bench.truth.actuator, bench.truth.actuator.transmission.armature_kg_m2 / 0.006);
      },
      effect.kind);
  const bench::BenchRun first = made.runs.front();
  for (std::size_t i = 0; i < made.runs.size(); ++i) {
    bench::BenchRun& run = made.runs[i];
    const double load = kLoads[i / std::size(kGains) % std::size(kLoads)], gain = kGains[i % std::size(kGains)];
    run.load.inertia_kg_m2 = load * first.load.inertia_kg_m2;
    run.load.gravity_Nm = load * first.load.gravity_Nm;
    run.kp = gain * first.kp, run.kd = gain * first.kd;
  }
  test::play(made, seed);
  return made;
}

class SecondLook : public testing::TestWithParam<test::Effect> {};

TEST_P(SecondLook, SaysNothingOfSoundData) {
  for (const unsigned seed : kSeeds) {
    const test::RandomBench made = bench_with(GetParam(), seed);
    EXPECT_EQ(text(find_shared_faults(made.bench, made.runs, made.truth, {}, 1)), "") << "seed " << seed;
  }
}

TEST_P(SecondLook, NamesTheLoadThatIsWrong) {
  for (const unsigned seed : kSeeds) {
    test::RandomBench made = bench_with(GetParam(), seed);
    const double inertia = made.runs[3].load.inertia_kg_m2;
    std::vector<std::string> files;
    for (bench::BenchRun& run : made.runs) {
      if (run.load.inertia_kg_m2 != inertia) continue;
      run.load.inertia_kg_m2 *= 1.3, run.load.gravity_Nm *= 1.3;
      files.push_back(run.file);
    }
    const std::vector<DataFault> found = find_shared_faults(made.bench, made.runs, made.truth, {}, 1);
    ASSERT_EQ(found.size(), 1U) << "seed " << seed << '\n' << text(found);
    EXPECT_EQ(found[0].kind, Kind::kMass);
    EXPECT_EQ(found[0].files, files);
    EXPECT_NEAR(found[0].fixes.front().load_factor, 1.0 / 1.3, 0.1 / 1.3) << "seed " << seed;
  }
}

TEST_P(SecondLook, NamesTheGainThatIsWrong) {
  for (const unsigned seed : kSeeds) {
    test::RandomBench made = bench_with(GetParam(), seed);
    const double kp = made.runs[1].kp;
    std::vector<std::string> files;
    for (bench::BenchRun& run : made.runs) {
      if (run.kp != kp) continue;
      run.kp *= 0.6;
      files.push_back(run.file);
    }
    const std::vector<DataFault> found = find_shared_faults(made.bench, made.runs, made.truth, {}, 1);
    ASSERT_EQ(found.size(), 1U) << "seed " << seed << '\n' << text(found);
    EXPECT_EQ(found[0].kind, Kind::kGainFactor);
    EXPECT_EQ(found[0].files, files);
    EXPECT_NEAR(found[0].fixes.front().kp_factor, 1.0 / 0.6, 0.1 / 0.6) << "seed " << seed;
  }
}

TEST_P(SecondLook, WithdrawsAWrongGainThatTheModelDoesNotNeed) {
  for (const bool is_wrong : {false, true}) {
    test::RandomBench made = bench_with(GetParam(), 1);
    const double kp = made.runs[1].kp;
    DataFault fault{.kind = Kind::kGainFactor, .where = "kp", .correction = "kp", .fixes = {{.kp_factor = 1.0 / 0.6}}};
    for (bench::BenchRun& run : made.runs) {
      if (run.kp != kp) continue;
      if (is_wrong) run.kp *= 0.6;
      fault.files.push_back(run.file);
    }
    fault.fixes.front().files = fault.files;
    EXPECT_EQ(upheld(made.bench, made.runs, {fault}, made.truth, 1).size(), is_wrong ? 1U : 0U);
    fault.files.clear();  // of all runs: the model's own gain would be as good
    EXPECT_EQ(upheld(made.bench, made.runs, {fault}, made.truth, 1).size(), 1U);
  }
}

/// A preload that the model lacks bears a part of each load: every load wants another factor.
TEST(SecondLooks, TakeATrendOverLoadsForPhysics) {
  DataFaultOptions easily{};  // however small
  easily.least_mass_factor = 1.08, easily.mass_gain = 1.0, easily.factor_deviations = 0.0;
  DataFaultOptions trends_too = easily;
  trends_too.others_within = 1e9;
  for (const unsigned seed : {1U, 4U}) {
    test::RandomBench made = bench_with(test::effects().front(), seed);
    const double lightest_Nm = made.runs.front().load.gravity_Nm;
    std::vector<bench::BenchRun> written = made.runs;
    for (bench::BenchRun& run : made.runs) run.load.gravity_Nm -= 0.8 * lightest_Nm;
    test::play(made, seed);
    for (std::size_t i = 0; i < written.size(); ++i) written[i].recording = made.runs[i].recording;
    EXPECT_EQ(text(find_shared_faults(made.bench, written, made.truth, easily, 1)), "") << "seed " << seed;
    EXPECT_NE(text(find_shared_faults(made.bench, written, made.truth, trends_too, 1)), "") << "no trend: no test";
  }
}

INSTANTIATE_TEST_SUITE_P(DataFaults, SecondLook, testing::ValuesIn(test::effects()),
                         [](const auto& effect) { return std::string(effect.param.name); });

}  // namespace
}  // namespace pmg::data_faults
