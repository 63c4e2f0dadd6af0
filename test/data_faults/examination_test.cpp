// What the diagnosis goes on with, and how it is told.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "calib/synthetic_bench.hpp"
#include "data_faults/data_faults_report.hpp"
#include "data_faults/examine.hpp"
#include "files/config_error.hpp"
#include "temporary_folder.hpp"

namespace pmg::data_faults {
namespace {

using testing::HasSubstr;

std::vector<bench::BenchRun> ten_runs() {
  std::vector<bench::BenchRun> runs(10);
  for (std::size_t i = 0; i < runs.size(); ++i) runs[i].file = "run" + std::to_string(i) + ".csv";
  return runs;
}

DataFault turned(const std::vector<std::string>& files) {
  return {.kind = Kind::kSign,
          .where = "column q_rad",
          .correction = "turn it",
          .evidence = {"it goes the other way"},
          .fixes = {{.files = files, .columns = {bench::Column::kPosition}, .factor = -1.0}},
          .files = files};
}

TEST(Examination, LeavesOutAFaultyRunAndSaysSo) {
  const Examination found = examination({turned({"run3.csv"})}, ten_runs(), Handling::kLeaveOut);
  EXPECT_EQ(found.left_out, std::vector<std::string>{"run3.csv"});
  EXPECT_TRUE(found.corrected.empty());
  EXPECT_FALSE(found.uncorrected());
  EXPECT_THAT(faults_text(found), HasSubstr("leaves out 1 run: run3.csv"));
  EXPECT_EQ(examined_bench({}, found).left_out, found.left_out);
  EXPECT_TRUE(examined_bench({}, found).corrections.empty());
}

TEST(Examination, CorrectsWhatCannotBeLeftOut) {
  for (const Handling handling : {Handling::kLeaveOut, Handling::kCorrect}) {
    const Examination found = examination({turned({})}, ten_runs(), handling);
    EXPECT_EQ(examined_bench({}, found).corrections.size(), 1U);
    EXPECT_TRUE(found.left_out.empty()) << "all runs can't be left out";
    EXPECT_FALSE(found.uncorrected());
    EXPECT_THAT(faults_text(found), HasSubstr("of the corrected data"));
  }
}

TEST(Examination, KeepsFaultyDataOnlyIfTold) {
  const Examination kept = examination({turned({}), turned({"run3.csv"})}, ten_runs(), Handling::kKeep);
  EXPECT_TRUE(examined_bench({}, kept).corrections.empty());
  EXPECT_TRUE(kept.left_out.empty());
  EXPECT_TRUE(kept.uncorrected());
  EXPECT_THAT(faults_text(kept), HasSubstr("don't trust it"));
}

TEST(Examination, KeepsHalfOfTheRuns) {
  const DataFault many = turned({"run0.csv", "run1.csv", "run2.csv", "run3.csv", "run4.csv", "run5.csv"});
  const Examination found = examination({many, turned({"run9.csv"})}, ten_runs(), Handling::kLeaveOut);
  EXPECT_EQ(found.left_out, std::vector<std::string>{"run9.csv"});
  EXPECT_EQ(found.corrected, std::vector<std::size_t>{0});
  EXPECT_EQ(examined_bench({}, found).corrections.front().files, many.files);
  EXPECT_THAT(faults_text(found), testing::AllOf(HasSubstr("leaves out 1 run"), HasSubstr("of the corrected data")));
}

TEST(Examination, LeavesARunOfEveryGroup) {
  const std::vector<std::vector<std::string>> groups = {{"run0.csv", "run1.csv"}, {"run3.csv"}};
  const Examination found = examination({turned({"run3.csv"})}, ten_runs(), Handling::kLeaveOut, groups);
  EXPECT_TRUE(found.left_out.empty()) << "nothing would be left to score";
  EXPECT_EQ(found.corrected, std::vector<std::size_t>{0});
  const Examination fitted = examination({turned({"run1.csv"})}, ten_runs(), Handling::kLeaveOut, groups);
  EXPECT_EQ(fitted.left_out, std::vector<std::string>{"run1.csv"});
}

TEST(Examination, SaysNothingOfSoundData) {
  const Examination sound = examination({}, ten_runs(), Handling::kCorrect);
  EXPECT_EQ(faults_text(sound), "");
  EXPECT_TRUE(sound.corrected.empty());
  nlohmann::ordered_json json;
  add_to(json, sound);
  EXPECT_TRUE(json.at("data_faults").empty());
}

TEST(Examination, SaysInJsonWhatTheFormatAsksFor) {
  nlohmann::ordered_json json;
  add_to(json, examination({turned({"run3.csv"})}, ten_runs(), Handling::kLeaveOut));
  const auto& fault = json.at("data_faults").at(0);
  EXPECT_EQ(fault.at("kind"), "sign");
  EXPECT_EQ(fault.at("where"), "column q_rad");
  EXPECT_EQ(fault.at("correction"), "turn it");
  EXPECT_EQ(fault.at("evidence").size(), 1U);
  EXPECT_EQ(fault.at("factor"), -1.0);
  EXPECT_EQ(fault.at("runs").at(0), "run3.csv");
  EXPECT_EQ(json.at("data_faults_handled").at("by"), "leave-out");
  EXPECT_EQ(json.at("data_faults_handled").at("verdict_of_faulty_data"), false);
}

TEST(Examination, WhatIsWrongInAnUnusedColumnAloneCostsNoRun) {
  using bench::Column;
  const auto fault = [](std::vector<Column> columns) {
    return DataFault{
        .kind = Kind::kSign, .where = "a column", .correction = "turn it", .fixes = {{.columns = columns}}};
  };
  const DataFault of_a_row{.kind = Kind::kUnit, .where = "a row", .correction = "another mass"};
  const std::vector<DataFault> all = {fault({Column::kTorque}), fault({Column::kTorque, Column::kPosition}), of_a_row};
  EXPECT_EQ(of_used_columns(all, {}).size(), 3U);
  const std::vector<DataFault> used = of_used_columns(all, {Column::kTorque});
  ASSERT_EQ(used.size(), 2U);
  EXPECT_EQ(used[0].fixes.front().columns.size(), 2U);
  EXPECT_EQ(used[1].where, "a row");
}

TEST(Examination, RefusesAnUnknownHandling) { EXPECT_THROW(handling_of("ignore"), std::invalid_argument); }

/// Four runs of a pendulum that moves up to 2.2 rad either way: 124 degrees, more than a reader takes for radians.
std::vector<calib::SingleJoint> far_swings() {
  const bench::Bench bench = test::pd_bench(true);
  calib::JointModel truth;
  truth.actuator.friction.viscous_Nm_s_per_rad = 0.1;
  std::vector<calib::SingleJoint> swings;
  for (const calib::SingleJoint& joint : test::record(bench, truth, 4)) {
    bench::BenchRun run = joint.run();
    for (double& q_rad : run.recording.q_cmd_rad) q_rad *= 1.8;
    run.recording.q_rad = calib::SingleJoint(bench, run, joint.step_s()).rollout(truth);
    swings.emplace_back(bench, run, joint.step_s());
  }
  return swings;
}

std::vector<calib::SingleJoint> with_readings(const std::vector<calib::SingleJoint>& joints, double factor,
                                              std::size_t first, std::size_t last) {
  std::vector<calib::SingleJoint> changed;
  for (const calib::SingleJoint& joint : joints) {
    bench::BenchRun run = joint.run();
    for (std::size_t k = first; k < std::min(last, run.recording.q_rad.size()); ++k) run.recording.q_rad[k] *= factor;
    changed.emplace_back(test::pd_bench(true), run, joint.step_s());
  }
  return changed;
}

TEST(Examination, DegreesTooLargeForRadiansAreNamedAndNotRefused) {
  const test::TemporaryFolder folder;
  test::write_bench(folder.path(), with_readings(far_swings(), 57.29577951308232, 0, 1000));
  const bench::Bench bench = bench::read_bench(folder.path());
  ASSERT_THROW(bench.read_runs(bench::RowFilter("")), files::ConfigError);
  for (const Handling handling : {Handling::kCorrect, Handling::kLeaveOut, Handling::kKeep}) {
    const Examination found = examine(bench, {""}, std::nullopt, {.handling = handling}, 1);
    ASSERT_EQ(found.faults.size(), 1U);
    EXPECT_EQ(found.faults.front().kind, Kind::kUnit);
    EXPECT_THAT(found.faults.front().correction, HasSubstr("degrees"));
    const std::vector<bench::BenchRun> runs = examined_bench(bench, found).read_runs(bench::RowFilter(""));
    const bool plausible = std::ranges::all_of(
        runs, [](const bench::BenchRun& run) { return bench::plausible_positions(run.recording, false); });
    EXPECT_EQ(plausible, handling != Handling::kKeep);
  }
}

TEST(Examination, PositionsThatNoFaultExplainsAreRefused) {
  const test::TemporaryFolder folder;
  test::write_bench(folder.path(), with_readings(far_swings(), 300.0, 140, 150));
  EXPECT_THROW(examine(bench::read_bench(folder.path()), {""}, std::nullopt, {}, 1), files::ConfigError);
}

}  // namespace
}  // namespace pmg::data_faults
