// Readings that stand still while the joint moves are named and left out; whatever else repeats a reading isn't.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "bench/correction.hpp"
#include "data_faults/benches.hpp"
#include "data_faults/effects.hpp"
#include "data_faults/examine.hpp"
#include "data_faults/frozen.hpp"
#include "data_faults/frozen_readings_check.hpp"
#include "recorded_benches.hpp"

namespace pmg::data_faults {
namespace {

using Runs = std::vector<bench::BenchRun>;

constexpr double kShare = 0.25, kPeriod_s = 0.4;
constexpr double kCoarse_rad = 2.0 * std::numbers::pi / 512.0;

test::RandomBench bench_of(unsigned seed, double quantum_rad = 0.0) {
  return test::random_bench(
      seed, [&](test::RandomBench& made, std::mt19937&) { made.truth.actuator.sensor.quantum_rad = quantum_rad; });
}

/// Without noise.
test::RandomBench sticking(unsigned seed, double quantum_rad) {
  test::RandomBench made = test::random_bench(seed, [](test::RandomBench& bench, std::mt19937&) {
    model::ActuatorParameters& p = bench.truth.actuator;
    p.friction.coulomb_Nm *= 4.0;
    p.friction.stribeck_Nm = 2.0 * p.friction.coulomb_Nm;
  });
  for (bench::BenchRun& run : made.runs) {
    run.recording.q_rad = calib::SingleJoint(made.bench, run, 0.001).rollout(made.truth);
    for (double& q_rad : run.recording.q_rad) q_rad = quantum_rad * std::round(q_rad / quantum_rad);
  }
  return made;
}

Runs frozen(Runs runs) {
  for (bench::BenchRun& run : runs) test::freeze(run, kShare, kPeriod_s);
  return runs;
}

Runs corrected(Runs runs, const DataFault& fault) {
  for (bench::BenchRun& run : runs) {
    for (const bench::Correction& fix : fault.fixes) bench::correct(run, fix);
  }
  return runs;
}

/// How many adjacent readings are the same, as three at least.
std::size_t repeats(const Runs& runs) {
  std::size_t found = 0;
  for (const bench::BenchRun& run : runs) {
    const std::vector<double>& q_rad = run.recording.q_rad;
    for (std::size_t k = 2; k < q_rad.size(); ++k)
      if (q_rad[k] == q_rad[k - 1] && q_rad[k] == q_rad[k - 2]) ++found;
  }
  return found;
}

void expect_none(const Runs& runs, std::size_t at_least_repeats) {
  EXPECT_GE(repeats(runs), at_least_repeats) << "nothing to be misled by";
  EXPECT_EQ(test::text(frozen_readings(runs, false, {})), "");
}

TEST(FrozenReadings, OfAMovingJointAreNamedAndAllOfThemAreLeftOut) {
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    for (const double quantum_rad : {0.0, 2.0 * std::numbers::pi / 4096.0}) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", quantum " << quantum_rad);
      const Runs sound = bench_of(seed, quantum_rad).runs, lost = frozen(sound);
      const std::vector<DataFault> found = frozen_readings(lost, false, {});
      ASSERT_EQ(found.size(), 1U);
      EXPECT_EQ(found.front().kind, Kind::kFrozenReadings);
      EXPECT_TRUE(found.front().files.empty()) << "all runs";
      EXPECT_THAT(found.front().evidence.front(), testing::HasSubstr("stands still"));
      const Runs rest = corrected(lost, found.front());
      constexpr double kFar_rad = 0.01;
      std::size_t wrong = 0, missed = 0, accused = 0;
      for (std::size_t i = 0; i < rest.size(); ++i) {
        for (std::size_t k = 0; k < rest[i].recording.t_s.size(); ++k) {
          const double apart_rad = std::abs(lost[i].recording.q_rad[k] - sound[i].recording.q_rad[k]);
          const bool repeats = k > 0 && lost[i].recording.q_rad[k] == lost[i].recording.q_rad[k - 1];
          if (apart_rad > kFar_rad) ++wrong;
          if (apart_rad > kFar_rad && rest[i].recording.valid[k]) ++missed;
          if (!repeats && !rest[i].recording.valid[k]) ++accused;
        }
      }
      EXPECT_GT(wrong, 500U);
      EXPECT_LT(missed, wrong / 50);
      EXPECT_EQ(accused, 0U) << "readings that repeat nothing";
    }
  }
}

TEST(FrozenReadings, OfOneRunAreNamedWithThisRun) {
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    Runs runs = bench_of(seed).runs;
    test::freeze(runs[5], kShare, kPeriod_s);
    const std::vector<DataFault> found = frozen_readings(runs, false, {});
    ASSERT_EQ(found.size(), 1U) << "seed " << seed;
    EXPECT_EQ(found.front().files, std::vector<std::string>{"run5.csv"});
    ASSERT_EQ(found.front().fixes.size(), 1U);
    EXPECT_THAT(found.front().where, testing::HasSubstr("run5.csv"));
  }
}

/// The others creep, stick and slip beside them. Without noise a rest repeats its reading exactly.
TEST(FrozenReadings, OfSomeRunsAreNamedWithTheseAlone) {
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    for (const double quantum_rad : {1e-4, kCoarse_rad / 4.0}) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", quantum " << quantum_rad);
      Runs runs = sticking(seed, quantum_rad).runs;
      for (const std::size_t run : {1U, 5U, 9U}) test::freeze(runs[run], kShare, kPeriod_s);  // sines
      const std::vector<DataFault> found = frozen_readings(runs, false, {});
      ASSERT_EQ(found.size(), 1U);
      EXPECT_THAT(found.front().files, testing::ElementsAre("run1.csv", "run5.csv", "run9.csv"));
    }
  }
}

/// A joint that moves only while its readings stand still: by themselves these runs show nothing.
TEST(FrozenReadings, OfStepsAreLeftOutBesideOtherRunsThatShowThem) {
  const Runs sound = bench_of(1).runs;
  Runs runs = sound;
  for (const std::size_t run : {0U, 1U, 4U, 5U, 8U}) {
    std::vector<double>& q_rad = runs[run].recording.q_rad;
    for (std::size_t k = 0; k < q_rad.size(); ++k) {
      const double periods = runs[run].recording.t_s[k] / kPeriod_s, into = periods - std::floor(periods);
      const double moved = std::clamp((into - (1.0 - kShare)) / (0.8 * kShare), 0.0, 1.0);
      q_rad[k] = 0.05 * (std::floor(periods) + moved) + 1e-4 * std::sin(1000.0 * into);
    }
  }
  const std::vector<DataFault> found = frozen_readings(frozen(runs), false, {});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(found.front().files.empty()) << "all runs";
  EXPECT_EQ(found.front().fixes.size(), runs.size());
}

TEST(FrozenReadings, OfALinearAxisAreNamedInMillimetres) {
  Runs runs = frozen(bench_of(1).runs);
  for (bench::BenchRun& run : runs) {
    for (double& q_m : run.recording.q_rad) q_m *= 0.02;
  }
  const std::vector<DataFault> found = frozen_readings(runs, true, {});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_THAT(found.front().where, testing::HasSubstr("q_m"));
  EXPECT_THAT(found.front().evidence.back(), testing::HasSubstr(" mm,"));
}

TEST(FrozenReadings, HideNoOtherFaultAndAreNone) {
  const test::RandomBench made = test::random_bench(3);
  Runs lost = made.runs;
  test::freeze(lost[1], 0.5, 0.4);
  test::freeze(lost[6], 0.5, 0.4);
  const std::vector<DataFault> alone = find_data_faults(made.bench, lost, std::nullopt, {}, 1);
  ASSERT_EQ(alone.size(), 1U) << test::text(alone);
  for (bench::BenchRun& run : lost) bench::correct(run, {.columns = {bench::Column::kPositionCommand}, .factor = -1.0});
  const std::vector<DataFault> both = find_data_faults(made.bench, lost, std::nullopt, {}, 1);
  ASSERT_EQ(both.size(), 2U) << test::text(both);
  EXPECT_EQ(both.front().kind, Kind::kFrozenReadings);
  EXPECT_EQ(both.back().kind, Kind::kSign);
}

TEST(FrozenReadings, AreNotThoseOfACoarseSensor) {
  for (const unsigned seed : {1U, 2U, 3U, 4U}) expect_none(bench_of(seed, kCoarse_rad).runs, 500);
}

/// Without noise whatever rests repeats its reading exactly: between two motions, and after the drive was switched off.
TEST(FrozenReadings, AreNotThoseOfAJointThatSticksOrRests) {
  for (const unsigned seed : {1U, 2U, 3U, 4U}) expect_none(sticking(seed, 1e-4).runs, 500);
}

/// A stiff drive goes most of each step of a staircase within a sample.
TEST(FrozenReadings, AreNotThoseOfAStaircaseOfCommands) {
  for (const std::size_t samples : {4U, 6U, 10U, 16U, 60U}) {
    Runs runs(1);
    bench::Recording& r = runs.front().recording;
    double q_rad = 0.0;
    for (std::size_t k = 0; k < 500; ++k) {
      r.t_s.push_back(0.01 * static_cast<double>(k));
      const std::size_t step = k / samples;
      q_rad += 0.7 * (0.1 * static_cast<double>(step) - q_rad);
      r.q_rad.push_back(1e-3 * std::round(1e3 * q_rad));
      r.valid.push_back(true);
    }
    SCOPED_TRACE(samples);
    expect_none(runs, samples < 10 ? 0 : 100);
  }
}

/// A magnet that slips on its shaft: no motion explains how far the reading goes.
TEST(FrozenReadings, AreNotThoseOfASensorThatSlips) {
  Runs runs(1);
  bench::Recording& r = runs.front().recording;
  for (std::size_t k = 0; k < 500; ++k) {
    r.t_s.push_back(0.01 * static_cast<double>(k));
    const double slipped_rad = k / 50 % 2 == 0 ? 0.0 : 1.0;
    r.q_rad.push_back(k % 50 > 46 ? r.q_rad.back() : 0.5 * r.t_s.back() + slipped_rad);
    r.valid.push_back(true);
  }
  expect_none(runs, 10);
}

/// A sensor's clock that is a tenth slower than the recording's.
TEST(FrozenReadings, AreNotSingleRepeats) {
  Runs runs(1);
  bench::Recording& r = runs.front().recording;
  for (std::size_t k = 0; k < 500; ++k) {
    r.t_s.push_back(0.01 * static_cast<double>(k));
    r.q_rad.push_back(k % 10 == 9 ? r.q_rad.back() : std::sin(7.0 * r.t_s.back()));
    r.valid.push_back(true);
  }
  expect_none(runs, 0);
}

/// The effect `hold` in its form of readings: all of them, regularly.
TEST(FrozenReadings, AreNotThoseOfASensorThatHoldsEachReading) {
  for (const double samples : {1.1, 1.5, 2.5, 3.0, 4.0, 5.0, 8.0}) {
    Runs runs = bench_of(1).runs;
    for (bench::BenchRun& run : runs) {
      const std::vector<double> before = run.recording.q_rad;
      for (std::size_t k = 0; k < before.size(); ++k) {
        const double held = samples * std::floor(static_cast<double>(k) / samples);
        run.recording.q_rad[k] = before[static_cast<std::size_t>(std::ceil(held))];
      }
    }
    SCOPED_TRACE(samples);
    expect_none(runs, samples < 2.5 ? 0 : 500);
  }
}

TEST(FrozenReadings, AreNotDropoutsAndGoOnAcrossThem) {
  constexpr double kDropout_rad = 1.5;
  const Runs sound = bench_of(2).runs;
  Runs runs = sound, lost = frozen(sound);
  const auto drop_out = [](Runs& of) {
    for (bench::BenchRun& run : of) {
      for (std::size_t k = 20; k < run.recording.t_s.size(); k += 37)
        run.recording.q_rad[k] += kDropout_rad, run.recording.valid[k] = false;
    }
  };
  drop_out(runs);
  drop_out(lost);
  expect_none(runs, 0);
  const std::vector<DataFault> found = frozen_readings(lost, false, {});
  ASSERT_EQ(found.size(), 1U);
  const Runs rest = corrected(lost, found.front());
  for (std::size_t i = 0; i < rest.size(); ++i) {
    for (std::size_t k = 21; k < rest[i].recording.t_s.size(); k += 37)
      EXPECT_NEAR(rest[i].recording.q_rad[k], sound[i].recording.q_rad[k], 0.5 * kDropout_rad)
          << rest[i].file << ", " << k;
  }
}

/// A joint at rest at a run's end: a rest is longer than any stretch in which the joint demonstrably moved.
TEST(FrozenReadings, LeaveALongRestOfACoarseSensorAsItIs) {
  Runs runs = bench_of(1, kCoarse_rad / 8.0).runs;
  for (bench::BenchRun& run : runs) {
    std::vector<double>& q_rad = run.recording.q_rad;
    const std::size_t stops = q_rad.size() * 4 / 5;
    for (std::size_t k = stops; k < q_rad.size(); ++k) q_rad[k] = q_rad[stops];
  }
  const Runs lost = frozen(runs);
  const std::vector<DataFault> found = frozen_readings(lost, false, {});
  ASSERT_EQ(found.size(), 1U);
  for (const bench::BenchRun& run : corrected(lost, found.front())) EXPECT_TRUE(run.recording.valid.back()) << run.file;
}

TEST(FrozenReadings, AreLeftOutAndTheirRunsAreNot) {
  const Runs sound = bench_of(3).runs;
  Runs lost = sound;
  test::freeze(lost[5], kShare, kPeriod_s);
  const std::vector<DataFault> faults = frozen_readings(lost, false, {});
  ASSERT_EQ(faults.size(), 1U);
  for (const Handling handling : {Handling::kLeaveOut, Handling::kCorrect}) {
    const Examination found = examination(faults, lost, handling);
    EXPECT_TRUE(found.left_out.empty());
    EXPECT_TRUE(found.corrected.empty());
    EXPECT_EQ(found.readings_left_out, std::vector<std::size_t>{0});
    const bench::Bench bench = examined_bench({}, found);
    ASSERT_EQ(bench.corrections.size(), 1U);
    EXPECT_FALSE(bench.corrections.front().unknown_readings.empty());
    EXPECT_FALSE(found.uncorrected());
  }
  const Examination kept = examination(faults, lost, Handling::kKeep);
  EXPECT_TRUE(examined_bench({}, kept).corrections.empty());
  EXPECT_TRUE(kept.uncorrected());
}

TEST(FrozenReadings, OfMeasuredJointsThereAreNone) {
  PMG_NEEDS_BENCH("sts3215");
  for (const char* name : {"emps", "sts3215", "xl330"}) {
    PMG_NEEDS_BENCH(name);
    const bench::Bench bench = bench::read_bench(test::recorded_bench(name));
    const Runs runs = bench.read_runs(bench::RowFilter(""));
    EXPECT_EQ(test::text(frozen_readings(runs, bench.rig == bench::Rig::kLinear, {})), "") << name;
  }
}

}  // namespace
}  // namespace pmg::data_faults
