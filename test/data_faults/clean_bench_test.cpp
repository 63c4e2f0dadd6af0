// Whatever a joint's physics do, sound data have no faults.
#include <gtest/gtest.h>

#include <ctime>
#include <filesystem>

#include "data_faults/benches.hpp"
#include "data_faults/effects.hpp"
#include "data_faults/examine.hpp"
#include "fitting/statistics.hpp"
#include "folders.hpp"

namespace pmg::data_faults {
namespace {

namespace fs = std::filesystem;
using test::text;

class SoundData : public testing::TestWithParam<test::Effect> {};

TEST_P(SoundData, HaveNoFaultsHoweverStrongTheEffect) {
  constexpr unsigned kSeed = 21;
  const test::RandomBench made = test::random_bench(
      kSeed,
      [](test::RandomBench& bench, std::mt19937&) {
        auto& p = bench.truth.actuator;
        GetParam().set(p, p.transmission.armature_kg_m2 / 0.006);  // its armature is 0.2 to 1 % of its torque
      },
      GetParam().kind);
  EXPECT_EQ(text(find_data_faults(made.bench, made.runs, std::nullopt, {}, 1)), "");
}

INSTANTIATE_TEST_SUITE_P(DataFaults, SoundData, testing::ValuesIn(test::effects()),
                         [](const auto& effect) { return std::string(effect.param.name); });

TEST(SoundData, HaveNoFaultsWithFeedForwardAndSpeeds) {
  const test::RandomBench made = test::cascade_bench(31);
  EXPECT_EQ(text(find_data_faults(made.bench, made.runs, std::nullopt, {}, 1)), "");
}

TEST(SoundData, HaveNoFaultsUnderTorqueCommandsAndWithRepeats) {
  const test::RandomBench told = test::torque_bench(32), repeated = test::repeated_bench(33);
  EXPECT_EQ(text(find_data_faults(told.bench, told.runs, std::nullopt, {}, 1)), "");
  EXPECT_EQ(text(find_data_faults(repeated.bench, repeated.runs, std::nullopt, {}, 1)), "");
}

/// Where a profile limits the speed of commands, a gain of any size hides it best.
TEST(SoundData, HaveNoWrongGainWhereCommandsAreSlow) {
  for (const double rate_rad_s : {0.5, 1.0, 1.5}) {
    test::RandomBench made = test::repeated_bench(33);
    made.truth.actuator.command.rate_limit_rad_s = rate_rad_s;
    test::play(made, 33, 1e-3);
    EXPECT_EQ(text(find_data_faults(made.bench, made.runs, std::nullopt, {}, 1)), "") << rate_rad_s << " rad/s";
  }
}

/// A feed-forward that is too large in a run and in its repeat is the joint's: a slip of one recording doesn't repeat.
TEST(SoundData, HaveNoOtherUnitInARunAndItsRepeat) {
  test::RandomBench made = test::with_repeats(test::cascade_bench(6), 6);
  const std::string motion = made.runs.front().trajectory;
  bench::correct(made.runs.front(), {.columns = {bench::Column::kFeedForward}, .factor = 4.0});
  EXPECT_NE(text(find_data_faults(made.bench, made.runs, std::nullopt, {}, 1)), "");
  for (bench::BenchRun& run : made.runs) {
    if (run.trajectory == motion && run.file != made.runs.front().file)
      bench::correct(run, {.columns = {bench::Column::kFeedForward}, .factor = 4.0});
  }
  EXPECT_EQ(text(find_data_faults(made.bench, made.runs, std::nullopt, {}, 1)), "");
}

/// A joint that sticks in most runs and moves in a few, as one does that sticks harder the longer it rests.
test::RandomBench sticking_bench(unsigned seed) {
  test::RandomBench made = test::torque_bench(seed), stuck = made;
  stuck.truth.actuator.friction.coulomb_Nm = 20.0 * made.runs.front().load.gravity_Nm;
  test::play(stuck, seed);
  for (std::size_t i = 0; i < made.runs.size(); ++i) {
    if (i % 4 != 0) made.runs[i].recording.q_rad = stuck.runs[i].recording.q_rad;
  }
  return made;
}

TEST(SoundData, HaveNoFaultsWhereTheJointSticks) {
  for (const unsigned seed : {34U, 35U, 36U}) {
    const test::RandomBench made = sticking_bench(seed);
    EXPECT_EQ(text(find_data_faults(made.bench, made.runs, std::nullopt, {}, 1)), "") << "seed " << seed;
  }
}

TEST(SoundData, OfMeasuredJointsHaveNoFaults) {
  const fs::path data = fs::path(pmg::test::project_folder()) / "../shared/data/bench";
  if (!fs::exists(data)) GTEST_SKIP() << "no measured recordings in " << data;
  for (const auto& [folder, filter] :
       {std::pair{"emps", ""}, {"sts3215", "kp_firmware in 4,16 and repeat == 0"}, {"xl330", ""}}) {
    const Examination found = examine(bench::read_bench(data / folder), {filter}, std::nullopt, {}, 1);
    EXPECT_EQ(text(found.faults), "") << folder;
  }
}

}  // namespace
}  // namespace pmg::data_faults
