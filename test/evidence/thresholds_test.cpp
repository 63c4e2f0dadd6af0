#include "evidence/thresholds.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "data_faults/options.hpp"
#include "diagnosis/options.hpp"
#include "files/config_error.hpp"
#include "temporary_folder.hpp"

namespace pmg::evidence {
namespace {

struct Inner {
  work::CountThreshold most{6, "", "at most so many", "assumed"};
  work::Threshold window_s{0.2, "s", "a window", "plants"};

  PMG_THRESHOLDS(most, window_s)
};
struct Outer {
  work::Threshold share{0.5, "", "a share", "assumed"};
  Inner inner;

  PMG_THRESHOLDS(share, inner)
};

/// The message of the exception that setting this throws.
std::string refused(const ThresholdRows& rows, const std::string& setting) {
  try {
    set(rows, setting);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(Thresholds, AreListedInOrderAndByTheirPath) {
  const nlohmann::ordered_json json = thresholds_json(Outer{});
  ASSERT_EQ(json.size(), 3U);
  EXPECT_EQ(json[0]["name"], "share");
  EXPECT_EQ(json[1]["name"], "inner.most");
  EXPECT_EQ(json[1].dump(),
            R"({"name":"inner.most","value":6,"unit":"","reason":"at most so many","set_on":"assumed"})");
  EXPECT_EQ(json[2]["unit"], "s");
}

TEST(Thresholds, SetByHandKeepWhatTheyMeanAndSaySo) {
  Outer outer;
  const ThresholdRows all = rows(outer);
  EXPECT_TRUE(set_by_hand(all).empty());
  set(all, "inner.window_s=0.35");
  set(all, "inner.most=3");
  EXPECT_EQ(outer.inner.window_s, 0.35);
  EXPECT_EQ(outer.inner.most, 3);
  EXPECT_EQ(outer.inner.window_s.reason, "a window");
  EXPECT_EQ(outer.inner.window_s.unit, "s");
  EXPECT_EQ(outer.share.set_on, "assumed");
  EXPECT_EQ(set_by_hand(all), (std::vector<std::string>{"inner.most", "inner.window_s"}));
}

TEST(Thresholds, WhatCantBeSetIsRefusedWithTheNearestName) {
  Outer outer;
  const ThresholdRows all = rows(outer);
  EXPECT_EQ(refused(all, "inner.windw_s=1"), "'inner.windw_s' isn't a threshold; did you mean inner.window_s?");
  EXPECT_EQ(refused(all, "zzz=1"), "'zzz' isn't a threshold; diagnosis.json lists them under options");
  EXPECT_EQ(refused(all, "inner.most=2.5"),
            "'2.5' for the threshold inner.most; expected a whole number of at least 0");
  for (const char* setting : {"share", "share=", "share=-1", "share=nan", "share=inf", "share=1x", "share= 1"})
    EXPECT_NE(refused(all, setting).find("expected a number of at least 0"), std::string::npos) << setting;
  EXPECT_TRUE(set_by_hand(all).empty());
}

TEST(Thresholds, AFileSetsThemAndItsErrorsNameTheLine) {
  const test::TemporaryFolder folder;
  const auto written = [&](const char* text) {
    std::ofstream(folder.file("set.yaml")) << text;
    return folder.file("set.yaml");
  };
  Outer outer;
  set_from_file(rows(outer), written("share: 0.25\ninner.most: 2\n"));
  EXPECT_EQ(outer.share, 0.25);
  EXPECT_EQ(outer.inner.most, 2);
  EXPECT_EQ(set_by_hand(rows(outer)).size(), 2U);
  const auto error = [&](const char* text) -> std::string {
    try {
      set_from_file(rows(outer), written(text));
    } catch (const files::ConfigError& found) {
      return found.what();
    }
    return "";
  };
  EXPECT_NE(error("share: 0.1\nshre: 1\n").find("set.yaml:2"), std::string::npos);
  EXPECT_NE(error("shre: 1\n").find("did you mean share?"), std::string::npos);
  EXPECT_NE(error("inner.most: 2.5\n").find("inner.most"), std::string::npos);
  EXPECT_NE(error("share: -1\n").find("share"), std::string::npos);
}

template <typename Thresholds>
void expect_reasons(Thresholds thresholds) {
  std::set<std::string> names;
  for (const nlohmann::ordered_json& row : thresholds_json(thresholds)) {
    EXPECT_TRUE(names.insert(row["name"]).second) << row["name"];
    EXPECT_FALSE(row["reason"].get<std::string>().empty()) << row["name"];
    const std::string set_on = row["set_on"];
    EXPECT_FALSE(set_on.empty()) << row["name"];
    EXPECT_NE(set_on, "assumed") << row["name"] << ": what would settle it?";
  }
}

TEST(Thresholds, EachOfAJointsDiagnosisHasAReasonAndTheDataThatItWasSetOn) {
  expect_reasons(diagnosis::JointDiagnosisOptions{});
  expect_reasons(data_faults::DataFaultOptions{});
}

}  // namespace
}  // namespace pmg::evidence
