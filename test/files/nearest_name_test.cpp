// Proposals for unknown names.
#include "files/nearest_name.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "temporary_folder.hpp"

namespace pmg::files {
namespace {

TEST(EditDistance, CountsLettersInsertedLeftOutReplacedAndSwapped) {
  EXPECT_EQ(edit_distance("", ""), 0u);
  EXPECT_EQ(edit_distance("", "abc"), 3u);
  EXPECT_EQ(edit_distance("abc", ""), 3u);
  EXPECT_EQ(edit_distance("info", "info"), 0u);
  EXPECT_EQ(edit_distance("inof", "info"), 1u) << "neighbours swapped";
  EXPECT_EQ(edit_distance("polcy", "policy"), 1u);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
  EXPECT_EQ(edit_distance("ca", "abc"), 3u) << "the restricted distance: a swapped pair is not edited again";
  EXPECT_EQ(edit_distance("Z1", "z1"), 0u);
}

TEST(NearestName, IsTheOneWithTheFewestEdits) {
  const std::vector<std::string> joints = {"left_knee", "right_knee", "left_hip_yaw", "waist_yaw"};
  EXPECT_EQ(nearest_name("left_kne", joints), "left_knee");
  EXPECT_EQ(nearest_name("lfet_knee", joints), "left_knee");
  EXPECT_EQ(nearest_name("rigth_knee", joints), "right_knee");
  EXPECT_EQ(nearest_name("WAIST_YAW", joints), "waist_yaw");
}

TEST(NearestName, IsNoneWhenNothingIsNear) {
  EXPECT_EQ(nearest_name("elbow", {"left_knee", "waist_yaw"}), "");
  EXPECT_EQ(nearest_name("", {"a", "b"}), "");
  EXPECT_EQ(nearest_name("a", {"b"}), "") << "every letter replaced is another name";
  EXPECT_EQ(nearest_name("x", {}), "");
}

TEST(NearestName, TheSamePartsInAnotherOrderAreNear) {
  const std::vector<std::string> joints = {"left_knee", "right_knee", "left_hip_yaw"};
  EXPECT_EQ(nearest_name("knee_left", joints), "left_knee");
  EXPECT_EQ(nearest_name("Hip-Yaw-Left", joints), "left_hip_yaw");
  EXPECT_EQ(nearest_name("knee_middle", joints), "");
}

TEST(NearestName, ABeginningOfOneNameAloneIsNear) {
  EXPECT_EQ(nearest_name("calib", {"calibration", "clips"}), "calibration");
  EXPECT_EQ(nearest_name("left", {"left_knee", "left_ankle_pitch"}), "");
}

TEST(ExpectedName, SaysWhatIsThereWhenNothingIsNear) {
  EXPECT_EQ(expected_name("inof", {"info", "export"}), "did you mean info?");
  EXPECT_EQ(expected_name("zzz", {"info", "export"}), "expected one of info, export");
  EXPECT_EQ(expected_name("zzz", {"info"}), "expected info");
}

TEST(ExpectedName, WhatHasTheWordIsProposedWhereThatIsFew) {
  const std::vector<std::string> joints = {"left_knee", "right_knee", "left_hip_yaw", "waist_yaw"};
  EXPECT_EQ(expected_name("knee", joints), "did you mean left_knee or right_knee?");
  EXPECT_EQ(expected_name("armature", {"transmission.armature_kg_m2", "drive.limit"}),
            "did you mean transmission.armature_kg_m2?");
  EXPECT_EQ(expected_name("kne", {"left_knee_a", "b"}), "expected one of left_knee_a, b") << "a part of a word is none";
  EXPECT_EQ(expected_name("an", {"an_arm_b", "an_arm_c"}), "expected one of an_arm_b, an_arm_c") << "too short";
  EXPECT_EQ(expected_name("tau", {"aa_tau", "bb_tau", "cc_tau", "dd_tau", "ee_tau"}),
            "expected one of aa_tau, bb_tau, cc_tau, dd_tau, ee_tau")
      << "too many";
}

TEST(NearestFile, LooksInTheSameFolderAtTheSameEnding) {
  const test::TemporaryFolder own;
  const std::filesystem::path& folder = own.path();
  std::ofstream(folder / "tour.yaml") << "x";
  std::ofstream(folder / "tuor.txt") << "x";
  EXPECT_EQ(nearest_file(folder / "tuor.yaml"), folder / "tour.yaml");
  EXPECT_EQ(nearest_file(folder / "stand.yaml"), "");
  EXPECT_EQ(nearest_file(folder / "walk.yaml"), "") << "an ending in common is nothing in common";
  EXPECT_EQ(nearest_file(folder / "absent" / "tour.yaml"), "");
}

}  // namespace
}  // namespace pmg::files
