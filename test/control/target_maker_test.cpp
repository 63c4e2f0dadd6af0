// Who drives: the table of docs/reference/safety.md, row by row.
#include "control/target_maker.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "model/robots.hpp"

namespace pmg::control {
namespace {

using Row = std::tuple<std::string, std::string, std::string>;  // maker, event, next maker

/// The rows of the table under this heading; a maker's cell may name several, separated by "; ".
std::set<Row> documented() {
  std::ifstream file(std::filesystem::path(pmg::test::project_folder()) / "docs/reference/safety.md");
  std::set<Row> rows;
  bool here = false;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("#")) here = line == "## Who makes the targets";
    if (!here || !line.starts_with("| ") || line.starts_with("| maker |")) continue;
    std::vector<std::string> cells;
    std::stringstream stream(line.substr(2));
    for (std::string cell; std::getline(stream, cell, '|');) {
      cell = cell.substr(cell.find_first_not_of(' '));
      cells.push_back(cell.substr(0, cell.find_last_not_of(' ') + 1));
    }
    if (cells.size() != 3) {
      ADD_FAILURE() << line;
      continue;
    }
    std::stringstream makers(cells[0]);
    for (std::string maker; std::getline(makers, maker, ';');) {
      rows.insert({maker.substr(maker.find_first_not_of(' ')), cells[1], cells[2]});
    }
  }
  return rows;
}

TEST(TargetMaker, ChangesAsThePageSaysAndInNoOtherWay) {
  std::set<Row> rows;
  for (std::size_t d = 0; d < kTargetMakers; ++d) {
    for (std::size_t e = 0; e < kTargetEvents; ++e) {
      const auto now = static_cast<TargetMaker>(d);
      const auto event = static_cast<TargetEvent>(e);
      if (next(now, event) != now) rows.insert({to_string(now), to_string(event), to_string(next(now, event))});
    }
  }
  EXPECT_EQ(rows, documented());
}

TEST(TargetMaker, OnlyTheFeetsWordAndThenAKnownPolicyPutItInForce) {
  for (std::size_t e = 0; e < kTargetEvents; ++e) {
    const auto event = static_cast<TargetEvent>(e);
    for (const TargetMaker waits : {TargetMaker::kReferenceUnjudged, TargetMaker::kReferenceHanging}) {
      EXPECT_FALSE(runs_policy(next(waits, event))) << to_string(event);
      EXPECT_EQ(next(waits, event) == TargetMaker::kReferenceRehearsed, event == TargetEvent::kFeetCarry);
    }
    EXPECT_EQ(runs_policy(next(TargetMaker::kReferenceRehearsed, event)), event == TargetEvent::kPolicyIsKnown);
  }
}

TEST(TargetMaker, WhoSitsDownNeverStandsUpWithoutARelease) {
  for (std::size_t d = 0; d < kTargetMakers; ++d) {
    for (std::size_t e = 0; e < kTargetEvents; ++e) {
      const TargetMaker now = static_cast<TargetMaker>(d), then = next(now, static_cast<TargetEvent>(e));
      if (!sitting_down(now)) continue;
      EXPECT_TRUE(sitting_down(then) || then == TargetMaker::kNobody);
    }
  }
}

}  // namespace
}  // namespace pmg::control
