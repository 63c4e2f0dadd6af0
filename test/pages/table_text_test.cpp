// What a page says, for a terminal.
#include "pages/table_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pages/page.hpp"

namespace pmg::pages {
namespace {

using testing::ElementsAre;

TEST(TableText, NumbersStandRightWordsLeftAndALongHeaderBreaksBetweenItsWords) {
  const Table table{
      .header = {"policy", "mean error of roll [rad]", "falls", ""},
      .rows = {{"pmg", "0.10 +-0.02", "2", "ok"}, {"single gait", "-3", "-", "MISSED"}, {"käse", "", "10"}}};
  EXPECT_THAT(lines_of(table),
              ElementsAre("              mean error",  //
                          "                 of roll",  //
                          "policy             [rad]  falls", "pmg          0.10 +-0.02      2  ok",
                          "single gait           -3      -  MISSED", "käse                         10"));
}

TEST(PageText, SaysAllThatIsJudgedAndCountedOutsideFolds) {
  Page page("a walk");
  page.worth({work::Grade::kMissed, "it fell"});
  page.verdict({}, "it stood");
  page.note("one robot");
  page.heading("Pictures");
  page.paragraph("of it");
  page.heading("Errors");
  page.table({.header = {"a"}, .rows = {{"1"}}});
  page.table({.header = {"b"}, .rows = {{"2"}}});
  page.folded("every run", [&] {
    page.note("folded");
    page.table({.header = {"c"}, .rows = {{"3"}}});
  });
  EXPECT_THAT(page.lines(),
              ElementsAre("a walk", "MISSED: it fell", "it stood", "one robot", "", "Errors", "a", "1", "", "b", "2"));
}

}  // namespace
}  // namespace pmg::pages
