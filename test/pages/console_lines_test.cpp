// A page's table on a console.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pages/text.hpp"

namespace pmg::pages {
namespace {

using testing::ElementsAre;

TEST(ConsoleLines, StandInColumnsWithUnitsBelowTheirNames) {
  EXPECT_THAT(console_lines({.header = {"policy", "roll [rad]", "falls"},
                             .rows = {{"pmg", "0.0390 +-0.0022", "0 of 20"}, {"pmg, paper", "0.08", ""}}}),
              ElementsAre("policy                 roll    falls",  //
                          "                      [rad]",           //
                          "pmg         0.0390 +-0.0022  0 of 20",  //
                          "pmg, paper             0.08", ""));
}

TEST(ConsoleLines, CountALetterOnceWhateverItsBytes) {
  EXPECT_THAT(console_lines({.header = {"Gelenk", "q"}, .rows = {{"Hüfte", "1"}, {"Schenkel", "12"}}}),
              ElementsAre("Gelenk     q", "Hüfte      1", "Schenkel  12", ""));
}

TEST(ConsoleLines, ARowMayBeLongerThanItsHeader) {
  EXPECT_THAT(console_lines({.header = {"a"}, .rows = {{"1", "22"}, {"3", "4"}}}),
              ElementsAre("a", "1  22", "3   4", ""));
}

TEST(ConsoleLines, ARowMayBeShorterThanItsHeader) {
  EXPECT_THAT(console_lines({.header = {"a", "b"}, .rows = {{"1"}, {}}}), ElementsAre("a  b", "1", "", ""));
}

}  // namespace
}  // namespace pmg::pages
