#include "diagnosis/next_excitation.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <random>

#include "bench/excitation.hpp"
#include "calib/synthetic_bench.hpp"
#include "calib/unknown.hpp"
#include "diagnosis/next_excitation_files.hpp"
#include "effects/folds.hpp"

namespace pmg::diagnosis {
namespace {

namespace fs = std::filesystem;

constexpr double kNoise_rad = 1e-3;
const SeparationWanted kWanted{.noise_squares = kNoise_rad * kNoise_rad};

calib::JointModel healthy_joint() { return test::plain_joint(0.2); }

effects::NestedModel held(const calib::JointModel& model) {
  effects::NestedModel held;
  held.model = model;
  return held;
}

effects::NestedModel with(const char* parameter, double value, calib::JointModel model = healthy_joint()) {
  calib::set(model, parameter, value);
  return held(model);
}

/// What is asked for to tell two models apart.
AskedFor asked(const bench::Bench& bench, const effects::NestedModel& one, const effects::NestedModel& other,
               const std::vector<std::string>& names = {"one", "other"}) {
  return next_excitation(bench, test::record(bench, one.model, 2), {{{one, other}, names}}, kWanted);
}

TEST(NextExcitation, AsksForNothingWhereTwoModelsAreTheSame) {
  EXPECT_FALSE(asked(test::pd_bench(true), held(healthy_joint()), held(healthy_joint())).next);
}

// c (1 + a) one way and c (1 - a) the other is c both ways and a constant torque.
TEST(NextExcitation, FrictionThatDiffersByDirectionIsAConstantTorqueUnlessItVaries) {
  const auto pair = [](double stribeck_Nm) {
    calib::JointModel base = healthy_joint();
    base.actuator.friction.stribeck_Nm = stribeck_Nm;
    base.actuator.friction.stribeck_rad_s = 0.5;
    return asked(test::pd_bench(true), with("friction.asymmetry", -0.4, base), with("ripple.offset_Nm", 0.08, base),
                 {"direction_friction", "offset"});
  };
  EXPECT_FALSE(pair(0.0).next);
  EXPECT_EQ(pair(0.0).same_here.size(), 1U);
  EXPECT_TRUE(pair(0.2).next);
}

// It acts through gravity only: offset * gravity * cos(q) beside a constant.
TEST(NextExcitation, ZeroOffsetAndConstantTorquePartByGravity) {
  const AskedFor found =
      asked(test::pd_bench(true), with("sensor.zero_offset_rad", 0.05), with("ripple.offset_Nm", -0.05));
  ASSERT_TRUE(found.next);
  EXPECT_GE(found.next->pairs.front().deviations, 2.0);
}

TEST(NextExcitation, ExpectsNothingOfWhatARivalCouldAbsorb) {
  const bench::Bench bench = test::pd_bench(true);
  effects::NestedModel one = held(healthy_joint()), other = with("drive.kp_scale", 1.01);
  const AskedFor fixed = asked(bench, one, other);
  const effects::NestedFit fit(test::record(bench, one.model, 2), 1);
  const calib::Unknown gain =
      effects::unknown("drive.kp_scale", bench, effects::scale_of(bench, fit.runs(), one.model));
  one.unknowns = other.unknowns = {gain};
  one.ranges = other.ranges = {gain.range()};
  one.coordinates = Eigen::VectorXd::Constant(1, gain.coordinate(1.0));
  other.coordinates = Eigen::VectorXd::Constant(1, gain.coordinate(1.01));
  const AskedFor freed = asked(bench, one, other);
  ASSERT_TRUE(fixed.next);
  EXPECT_GE(fixed.next->pairs.front().deviations, 2.0);
  // Along its linearisation: of a gain that is 1 % higher the square of that is left.
  EXPECT_LT(freed.next ? freed.next->pairs.front().deviations : 0.0, 0.5);
}

/// Recordings of what was asked for, by a joint like the model.
std::vector<calib::SingleJoint> recorded(const bench::Bench& bench, const std::vector<NextRun>& asked,
                                         const calib::JointModel& truth, std::mt19937& random) {
  std::normal_distribution<double> noise_rad(0.0, kNoise_rad);
  std::vector<calib::SingleJoint> joints;
  for (const NextRun& one : asked) {
    bench::BenchRun run;
    run.trajectory = one.name;
    run.kp = one.kp;
    run.kd = one.kd;
    run.load = one.load;
    run.recording.t_s = one.t_s;
    run.recording.q_cmd_rad = one.q_cmd_rad;
    run.recording.q_rad.assign(one.t_s.size(), one.q_cmd_rad.front());
    run.recording.valid.assign(one.t_s.size(), true);
    const std::vector<double> played_rad = calib::SingleJoint(bench, run, 2e-3).rollout(truth);
    for (int time = 0; time < one.times; ++time) {
      run.recording.q_rad = played_rad;
      for (double& q_rad : run.recording.q_rad) q_rad += noise_rad(random);
      joints.emplace_back(bench, run, 2e-3);
    }
  }
  return joints;
}

// Noise that is independent from sample to sample strays less than the block's one number that is reckoned with, so
// what comes out is at least what was expected.
TEST(NextExcitation, PartsModelsAsSurelyAsItSays) {
  const bench::Bench bench = test::pd_bench(true);
  const effects::NestedModel one = with("command.delay_s", 0.003), other = with("sensor.lag_s", 0.003);
  const AskedFor found = asked(bench, one, other);
  ASSERT_TRUE(found.next);
  std::mt19937 random(7);
  const effects::NestedFit fit(recorded(bench, found.next->runs, one.model, random), 1);
  const fitting::BlockComparison compare(fit.blocks(), folds(fit), kWanted.noise_squares);
  const fitting::Comparison apart =
      compare(fit.blocks().squares(fit.residuals(other.model)), fit.blocks().squares(fit.residuals(one.model)));
  EXPECT_GE(found.next->pairs.front().deviations, 2.0);
  EXPECT_GE(apart.deviations, 0.9 * found.next->pairs.front().deviations);
}

TEST(NextExcitation, StaysWithinTheCommandsThatWereRecorded) {
  const bench::Bench bench = test::pd_bench(true);
  const effects::NestedModel one = with("command.delay_s", 0.01), other = with("command.rate_limit_rad_s", 2.0);
  double most_rad = 0.0;
  for (const calib::SingleJoint& joint : test::record(bench, one.model, 2)) {
    for (const double q_rad : joint.run().recording.q_cmd_rad) most_rad = std::max(most_rad, std::abs(q_rad));
  }
  const AskedFor found = asked(bench, one, other);
  ASSERT_TRUE(found.next);
  for (const NextRun& run : found.next->runs) {
    EXPECT_DOUBLE_EQ(run.q_cmd_rad.front(), 0.0);  // where the recorded ones begin
    for (const double q_rad : run.q_cmd_rad) EXPECT_LE(std::abs(q_rad), most_rad);
  }
}

TEST(NextExcitation, PartsTheRivalsOfEveryCause) {
  const bench::Bench bench = test::pd_bench(true);
  const effects::NestedModel model = held(healthy_joint());
  const Rivals first{{model, with("command.delay_s", 0.01)}, {"a", "delay"}};
  const Rivals second{{model, with("sensor.zero_offset_rad", 0.02)}, {"b", "zero_offset"}};
  const AskedFor found = next_excitation(bench, test::record(bench, model.model, 2), {first, second}, kWanted);
  ASSERT_TRUE(found.next);
  ASSERT_EQ(found.next->pairs.size(), 2U);
  for (const ExpectedPair& pair : found.next->pairs) EXPECT_GE(pair.deviations, 2.0) << pair.second;
}

TEST(NextExcitation, IsWrittenAsWhatCanBePlayedAndAppended) {
  const fs::path folder = fs::temp_directory_path() / ("pmg_next_excitation_" + std::to_string(getpid()));
  const effects::NestedModel one = held(healthy_joint());
  test::write_bench(folder / "bench", test::record(test::pd_bench(true), one.model, 2));
  const bench::Bench bench = bench::read_bench(folder / "bench");
  std::vector<calib::SingleJoint> runs;
  for (bench::BenchRun& run : bench.read_runs(bench::RowFilter(""))) runs.emplace_back(bench, std::move(run), 2e-3);
  const AskedFor found =
      next_excitation(bench, runs, {{{one, with("command.delay_s", 0.01)}, {"one", "other"}}}, kWanted);
  ASSERT_TRUE(found.next);
  write_next_excitation(folder / "next", bench, *found.next);
  const bench::Excitation played = bench::read_excitation(folder / "next");
  std::size_t recordings = 0;
  for (const NextRun& run : found.next->runs) recordings += static_cast<std::size_t>(run.times);
  ASSERT_EQ(played.rows.size(), recordings);
  EXPECT_EQ(played.rows.front().gains.kp_Nm_per_rad, found.next->runs.front().kp);
  EXPECT_EQ(played.trajectory(played.rows.front().trajectory).q_cmd_rad.size(), found.next->runs.front().t_s.size());
  EXPECT_EQ(bench::read_bench(folder / "next").runs.header, bench.runs.header);
  fs::create_directories(folder / "next" / "runs");
  EXPECT_THROW(write_next_excitation(folder / "next", bench, *found.next), std::runtime_error);
  EXPECT_THROW(expect_no_recordings(folder / "next"), std::runtime_error);
  EXPECT_THROW(remove_next_excitation(folder / "next"), std::runtime_error);
  EXPECT_TRUE(fs::exists(folder / "next" / "runs.csv")) << "somebody's recordings keep what they were asked by";
  fs::remove(folder / "next" / "runs");
  fs::create_directories(folder / "next" / "photos");
  remove_next_excitation(folder / "next");
  EXPECT_FALSE(fs::exists(folder / "next" / "runs.csv"));
  EXPECT_TRUE(fs::exists(folder / "next" / "photos")) << "what pmg_diagnose didn't write stays";
  fs::remove(folder / "next" / "photos");
  remove_next_excitation(folder / "next");
  EXPECT_FALSE(fs::exists(folder / "next"));
  fs::remove_all(folder);
}

}  // namespace
}  // namespace pmg::diagnosis
