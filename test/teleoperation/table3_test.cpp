// The table of teleoperation tasks: what is counted, what is asked, and that both tasks get to JSON and page.
#include "teleoperation/table3.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "temporary_folder.hpp"

namespace pmg::teleoperation {
namespace {

using testing::Contains;
using testing::ElementsAre;

TEST(Table3, ShareAndEndsCountTheTrialsThatTookPlace) {
  Table3 table;
  table.wiping.runs = {{.end = End::kDone}, {.end = End::kDone}, {.end = End::kFell}, {.end = End::kInterrupted}};
  EXPECT_DOUBLE_EQ(table.wiping.done().mean, 2.0 / 3.0);
  EXPECT_EQ(table.wiping.ends(), (std::map<std::string, int>{{"done", 2}, {"fell", 1}}));
  EXPECT_FALSE(table.wiping.reached());
}

TEST(Table3, EitherTaskBelowThePapersShareIsAMiss) {
  const TaskResult done{.end = End::kDone}, dropped{.end = End::kDropped};
  Table3 table;
  table.wiping.runs.assign(20, done);
  table.box_picking.runs.assign(20, done);
  for (std::size_t run = 0; run < 4; ++run) table.box_picking.runs[run] = dropped;  // 16 of 20: the paper's 0.8
  EXPECT_EQ(worth_of(table).exit_code(), 0);
  table.box_picking.runs[4] = dropped;
  EXPECT_EQ(worth_of(table).exit_code(), 1);
  table.box_picking.runs[4] = done;
  table.wiping.runs[0] = table.wiping.runs[1] = {.end = End::kFell};
  EXPECT_EQ(worth_of(table).exit_code(), 1);
}

TEST(Table3, BothTasksStandInTheJsonAndInTheTables) {
  Table3 table;
  table.trials = 1;
  table.wiping.runs = {{.end = End::kDone, .moved_m = 1.01}};
  table.box_picking.runs = {{.end = End::kDropped, .lifted_m = 0.31, .stage = "walk aside"}};
  const nlohmann::ordered_json json = to_json(table);
  ASSERT_EQ(json["tasks"].size(), 2U);
  EXPECT_EQ(json["tasks"][0]["task"], "wiping");
  EXPECT_EQ(json["tasks"][1]["task"], "box picking");
  EXPECT_EQ(json["tasks"][1]["success"]["share"], 0.0);
  EXPECT_EQ(json["tasks"][1]["runs"][0]["lifted_m"], 0.31);
  EXPECT_EQ(json["tasks"][1]["ends"]["box dropped"], 1);
  EXPECT_THAT(tables_of(table)[0].rows, Contains(ElementsAre("box picking", "0 [0, 79]", "80", "1")));
  EXPECT_THAT(tables_of(table)[1].rows, Contains(ElementsAre("box picking", "box dropped", "1")));
}

TEST(Table3, OfEachTaskTheFirstTrialOfEachEndIsFilmed) {
  Table3 table;
  table.wiping.runs = {{.end = End::kInterrupted}, {.end = End::kDone}, {.end = End::kDone}};
  table.box_picking.runs = {{.end = End::kDropped}, {.end = End::kDone}, {.end = End::kDropped}, {.end = End::kFell}};
  for (TaskTrials* task : {&table.wiping, &table.box_picking})
    for (std::size_t i = 0; i < task->runs.size(); ++i) task->runs[i].trial = 50 + i;
  std::vector<std::string> films;
  for (const FilmedTrial& one : trials_to_film(table)) films.push_back(one.file() + std::to_string(one.trial));
  EXPECT_THAT(films, ElementsAre("wiping_done.mp451", "box_picking_box_dropped.mp450", "box_picking_done.mp451",
                                 "box_picking_fell.mp453"));
}

/// Moments of them: as long as their robots hang.
TEST(Table3, AnEvaluationsFirstTrialMayBeAny) {
  Table3 table;
  table.first = 58;
  table.trials = 2;
  table.evaluated = {.name = "pmg", .candidate = {"pmg", {}}, .plants = {}};
  int asked = 0;
  run_table3(table, {.jobs = 1, .progress = {.report = {}, .interrupted = [&] { return ++asked > 40; }}});
  EXPECT_GT(table.wiping.runs[0].duration_s, 0.0);
  const nlohmann::ordered_json json = to_json(table);
  EXPECT_EQ(json["first_trial"], 58);
  for (const nlohmann::ordered_json& task : json["tasks"]) {
    EXPECT_EQ(task["runs"][0]["trial"], 58);
    EXPECT_EQ(task["runs"][1]["trial"], 59);
  }
}

/// A moment of a trial: as long as its robot hangs.
TEST(Table3, AFilmIsMadeOfATrialThatIsPlayedAgain) {
  const test::TemporaryFolder folder;
  Table3 table;
  table.evaluated = {.name = "pmg", .candidate = {"pmg", {}}, .plants = {}};
  int asked = 0;
  const evaluation::Supervision supervision{.jobs = 1,
                                            .progress = {.report = {}, .interrupted = [&] { return ++asked > 20; }}};
  const auto file = folder.path() / "wiping.mp4";
  EXPECT_EQ(film_trial(table, {.task = "wiping", .trial = 3, .end = End::kDone}, file, supervision), "");
  EXPECT_GT(std::filesystem::file_size(file), 1000U);
  asked = 0;
  EXPECT_NE(film_trial(table, {.task = "wiping", .trial = 3, .end = End::kDone}, folder.path() / "none" / "wiping.mp4",
                       supervision),
            "");
}

TEST(Table3, InterruptedBeforeItsFirstTrialItShowsNoShare) {
  Table3 table;
  table.trials = 1;
  table.complete = false;
  table.wiping.runs = table.box_picking.runs = {{.end = End::kInterrupted}};
  EXPECT_THAT(tables_of(table)[0].rows, Contains(ElementsAre("wiping", "-", "95", "1")));
}

}  // namespace
}  // namespace pmg::teleoperation
