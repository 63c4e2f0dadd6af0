// What repeats say of a run without a model; and the bus voltage.
#include "data_faults/repeat_checks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <utility>

#include "data_faults/benches.hpp"
#include "data_faults/column_checks.hpp"
#include "data_faults/examine.hpp"

namespace pmg::data_faults {
namespace {

using bench::Column;

/// One command under each of two gains and two loads, `repeats` times each; the truth may have an effect.
test::RandomBench designs(unsigned seed, int repeats,
                          const std::function<void(test::RandomBench&, std::mt19937&)>& change = {}) {
  test::RandomBench made = test::random_bench(seed, change);
  std::vector<bench::BenchRun> runs;
  const bench::BenchRun first = made.runs.front();
  for (const double heavier : {1.0, 1.7}) {
    for (const double factor : {1.0, 2.5}) {
      for (int repeat = 0; repeat < repeats; ++repeat) {
        bench::BenchRun run = first;
        run.load.inertia_kg_m2 *= heavier;
        run.load.gravity_Nm *= heavier;
        run.kp = factor * first.kp;
        run.repeat = repeat;
        run.trajectory = "one";
        run.file = "run" + std::to_string(runs.size()) + ".csv";
        runs.push_back(run);
      }
    }
  }
  made.runs = runs;
  test::play(made, seed, 1e-3);
  return made;
}

void late(bench::BenchRun& run, double by_s) {
  run.recording.q_rad = bench::shifted(run.recording.t_s, run.recording.q_rad, -by_s);
}

std::vector<DataFault> found_in(const test::RandomBench& made) {
  return repeat_faults(Examined(made.bench, made.runs, std::nullopt, {}, 1));
}

std::string said(const std::vector<DataFault>& faults) {
  std::string all;
  for (const DataFault& fault : faults)
    all += fault.where + ": " + fault.correction + "; " + fault.evidence.back() + "\n";
  return all;
}

class Repeats : public testing::TestWithParam<unsigned> {};

TEST_P(Repeats, ThatAgreeHaveNoFault) { EXPECT_TRUE(found_in(designs(GetParam(), 4)).empty()); }

TEST_P(Repeats, SayByHowMuchOneOfThemIsLateOrEarly) {
  for (const double late_s : {0.03, -0.03, 0.12}) {
    test::RandomBench made = designs(GetParam(), 4);
    late(made.runs[5], late_s);
    const std::vector<DataFault> found = found_in(made);
    ASSERT_EQ(found.size(), 1U) << late_s << said(found);
    EXPECT_EQ(found.front().kind, Kind::kTimeShift);
    EXPECT_EQ(found.front().files, std::vector<std::string>{made.runs[5].file});
    EXPECT_NEAR(found.front().fixes.front().shift_s, late_s, 0.005) << said(found);
  }
}

TEST_P(Repeats, MayBeginTwoSamplesApart) {
  for (const double samples : {2.0, -2.0}) {
    test::RandomBench made = designs(GetParam(), 4);
    late(made.runs[5], samples / made.bench.sample_rate_hz);
    const std::vector<DataFault> found = found_in(made);
    EXPECT_TRUE(found.empty()) << said(found);
  }
}

TEST_P(Repeats, SayWhichTwoRunsStandForEachOther) {
  test::RandomBench made = designs(GetParam(), 3);
  std::swap(made.runs[1].recording, made.runs[8].recording);
  const std::vector<DataFault> found = found_in(made);
  ASSERT_EQ(found.size(), 1U) << said(found);
  EXPECT_EQ(found.front().kind, Kind::kSwappedRuns);
  EXPECT_THAT(found.front().files, testing::UnorderedElementsAre(made.runs[1].file, made.runs[8].file));
  for (bench::BenchRun& run : made.runs) {
    for (const bench::Correction& fix : found.front().fixes) bench::correct(run, fix);
  }
  EXPECT_TRUE(found_in(made).empty());
}

/// A cold joint is slower by friction, and so later; but a shift doesn't make it a repeat of warm ones.
TEST_P(Repeats, AColdRunIsNotALateOne) {
  const auto stiff = [](test::RandomBench& bench, std::mt19937&) {
    bench.truth.actuator.friction.viscous_Nm_s_per_rad *= 2.0;
    bench.truth.actuator.friction.coulomb_Nm *= 1.5;
  };
  const test::RandomBench warm = designs(GetParam(), 4), cold = designs(GetParam(), 4, stiff);
  test::RandomBench made = warm;
  made.runs[5].recording = cold.runs[5].recording;
  const std::vector<DataFault> found = found_in(made);
  EXPECT_TRUE(found.empty()) << said(found);
}

INSTANTIATE_TEST_SUITE_P(DataFaults, Repeats, testing::Range(1U, 9U));

/// Then they no longer had the same commands: the model tells.
TEST(RepeatsOfFour, DoNotHideThatTheCommandsOfOneOfThemAreLate) {
  test::RandomBench made = designs(3, 4);
  for (bench::BenchRun& run : made.runs) run.recording.dq_rad_s.clear();  // it would be said to be early, too
  bench::Recording& r = made.runs[5].recording;
  r.q_cmd_rad = bench::shifted(r.t_s, r.q_cmd_rad, -0.06);
  const std::vector<DataFault> found = find_data_faults(made.bench, made.runs, std::nullopt, {}, 1);
  ASSERT_EQ(found.size(), 1U) << said(found);
  EXPECT_EQ(found.front().kind, Kind::kTimeShift);
  EXPECT_EQ(found.front().files, std::vector<std::string>{made.runs[5].file});
}

TEST(RepeatsOfTwo, SayNothingOfWhichOfThemIsLate) {
  test::RandomBench made = designs(2, 2);
  late(made.runs[3], 0.05);
  EXPECT_TRUE(found_in(made).empty());
}

test::RandomBench with_bus(double supply_V) {
  test::RandomBench made = test::random_bench(3, {}, test::Kind::kServo);
  for (std::size_t i = 0; i < made.runs.size(); ++i)
    made.runs[i].recording.bus_V.assign(made.runs[i].recording.t_s.size(), supply_V + 0.1 * static_cast<double>(i));
  return made;
}

TEST(BusVoltage, InAnotherUnitIsNamedBesideTheNominalOne) {
  for (const auto& [factor, unit] : {std::pair{10.0, "tenths of a volt"}, {1000.0, "mV"}}) {
    test::RandomBench made = with_bus(12.1);
    made.bench.nominal_supply_V = 15.0;
    EXPECT_TRUE(supply_faults(made.bench, made.runs, {}).empty());
    for (bench::BenchRun& run : made.runs) bench::correct(run, {.columns = {Column::kBus}, .factor = factor});
    const std::vector<DataFault> found = supply_faults(made.bench, made.runs, {});
    ASSERT_EQ(found.size(), 1U);
    EXPECT_TRUE(found.front().files.empty());
    EXPECT_NE(found.front().correction.find(unit), std::string::npos) << found.front().correction;
    EXPECT_DOUBLE_EQ(found.front().fixes.front().factor, 1.0 / factor);
  }
}

TEST(BusVoltage, OfOneRunInAnotherUnitIsNamedBesideTheOthers) {
  test::RandomBench made = with_bus(12.1);
  bench::correct(made.runs[2], {.columns = {Column::kBus}, .factor = 10.0});
  const std::vector<DataFault> found = supply_faults(made.bench, made.runs, {});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found.front().files, std::vector<std::string>{made.runs[2].file});
}

/// Of a supply that nobody knows, all runs alike say nothing; half the voltage is another battery.
TEST(BusVoltage, ThatIsMerelyAnotherOneIsNoFault) {
  EXPECT_TRUE(supply_faults(with_bus(121.0).bench, with_bus(121.0).runs, {}).empty());
  test::RandomBench made = with_bus(12.1);
  bench::correct(made.runs[2], {.columns = {Column::kBus}, .factor = 0.5});
  EXPECT_TRUE(supply_faults(made.bench, made.runs, {}).empty());
  for (bench::BenchRun& run : made.runs) run.recording.bus_V.assign(run.recording.bus_V.size(), 0.0);
  EXPECT_TRUE(supply_faults(made.bench, made.runs, {}).empty());
}

}  // namespace
}  // namespace pmg::data_faults
