#include "assembly/columns.hpp"

#include <gtest/gtest.h>

#include "assembled_bench.hpp"

namespace pmg::assembly {
namespace {

Groupings of(const AssembledBench& made) { return groupings(made.bench(), made.bench_runs(), 2, 30); }

std::string why_unused(const Groupings& found, const std::string& column) {
  for (const UnusedColumn& one : found.unused) {
    if (one.column == column) return one.why;
  }
  return "";
}

TEST(Columns, AColumnWithTwoRunsAValueGroupsThem) {
  AssembledBench made({"arm"}, 1);
  for (int i = 0; i < 6; ++i) made.add({healthy(), i / 2, 1.5, 1.0, {i % 2 == 0 ? "left" : "right"}});
  const Groupings found = of(made);
  ASSERT_EQ(found.usable.size(), 1U);
  EXPECT_EQ(found.usable[0].columns, std::vector<std::string>{"arm"});
  EXPECT_EQ(found.usable[0].levels, (std::vector<std::string>{"left", "right"}));
  EXPECT_EQ(found.usable[0].level_of_run, (std::vector<int>{0, 1, 0, 1, 0, 1}));
  EXPECT_FALSE(found.usable[0].follows_load);
}

TEST(Columns, AValueWithASingleRunIsNoLevel) {
  AssembledBench made({"arm"}, 1);
  for (int i = 0; i < 5; ++i) made.add({healthy(), i % 2, 1.5, 1.0, {i == 4 ? "c" : i < 2 ? "a" : "b"}});
  const Groupings found = of(made);
  ASSERT_EQ(found.usable.size(), 1U);
  EXPECT_EQ(found.usable[0].levels, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(found.usable[0].level_of_run.back(), -1);
}

TEST(Columns, SingleRunsOfEachValueGroupNothing) {
  AssembledBench made({"servo"}, 1);
  for (int i = 0; i < 4; ++i) made.add({healthy(), i % 2, 1.5, 1.0, {std::to_string(i)}});
  EXPECT_TRUE(of(made).usable.empty());
  EXPECT_NE(why_unused(of(made), "servo").find("fewer than two values"), std::string::npos);
}

TEST(Columns, ThatFollowTheTrajectoryOrTheGainsAreNoAssembly) {
  AssembledBench made({"amplitude", "arm"}, 1);
  for (int i = 0; i < 8; ++i)
    made.add({healthy(), i % 4, 1.5, 1.0, {i % 4 < 2 ? "small" : "large", i % 2 == 0 ? "a" : "b"}});
  const Groupings found = of(made);  // the arm follows the gains: even trajectories have the lower one
  EXPECT_TRUE(found.usable.empty());
  EXPECT_NE(why_unused(found, "amplitude").find("follows the trajectory"), std::string::npos);
  EXPECT_NE(why_unused(found, "arm").find("follows"), std::string::npos);
}

TEST(Columns, ThatChangeTogetherAreOneGrouping) {
  AssembledBench made({"arm", "day", "servo"}, 1);
  for (int i = 0; i < 8; ++i) {
    const bool first = i < 4;
    made.add({healthy(),
              i % 4,
              1.5,
              1.0,
              {first ? "a" : "b", first ? "Monday" : "Friday", (i % 4 < 2) == first ? "1" : "2"}});
  }
  const Groupings found = of(made);
  ASSERT_EQ(found.usable.size(), 2U);
  EXPECT_EQ(found.usable[0].columns, (std::vector<std::string>{"arm", "day"}));
  EXPECT_EQ(found.usable[1].columns, std::vector<std::string>{"servo"});
}

TEST(Columns, ThatFollowTheLoadSaySoAndMassAndLengthMakeTheWholeLoad) {
  AssembledBench made({"load_mass_kg", "load_length_m", "arm"}, 1);
  for (int i = 0; i < 16; ++i) {
    const bool heavy = i % 4 < 2, lengthy = i % 2 == 0;
    made.add({healthy(),
              i / 4,
              (heavy ? 2.0 : 1.0) * (lengthy ? 1.5 : 1.0),
              1.0,
              {heavy ? "2" : "1", lengthy ? "0.15" : "0.1", (i / 8 + i) % 2 == 0 ? "a" : "b"}});
  }
  const Groupings found = of(made);
  ASSERT_EQ(found.usable.size(), 4U);
  EXPECT_TRUE(found.usable[0].follows_load);
  EXPECT_TRUE(found.usable[1].follows_load);
  EXPECT_FALSE(found.usable[2].follows_load) << "each arm had each load";
  EXPECT_EQ(found.usable[3].columns, std::vector<std::string>{"load_mass_kg and load_length_m"});
  EXPECT_EQ(found.usable[3].levels, (std::vector<std::string>{"2, 0.15", "2, 0.1", "1, 0.15", "1, 0.1"}));
  EXPECT_EQ(level_name(made.bench(), made.runs()[0].run(), found.usable[3].from), "2, 0.15");
}

}  // namespace
}  // namespace pmg::assembly
