// The promises of `pmg_clips build` to its callers in a shell.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "apps/running_program.hpp"
#include "mocap/synthetic_gait.hpp"
#include "mocap/written_bvh.hpp"
#include "temporary_folder.hpp"

namespace pmg::retargeting {
namespace {

class PmgClipsBuild : public ::testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(folder_.file("walk.bvh")) << mocap::test::bvh_of(mocap::test::walk({.cycles = 4}));
    write_recipe("auto", "auto");
  }
  void write_recipe(const std::string& forward_frames, const std::string& lateral_frames) {
    std::ofstream(folder_.file("library.yaml")) << fmt::format(
        "source: a made-up person\npostures: synthesised\nclips:\n  forward: {{recording: walk.bvh, frames: {}}}\n"
        "  lateral: {{recording: walk.bvh, frames: {}}}\n  turn: {{recording: walk.bvh, frames: auto}}\n",
        forward_frames, lateral_frames);
  }
  pmg::test::Finished build(const std::string& options = "") {
    return pmg::test::run_in_shell(fmt::format("pmg_clips build '{}' --no-inverse --out '{}' {}",
                                               folder_.file("library.yaml").string(), out_.string(), options),
                                   folder_.path());
  }
  void expect_refused(const std::string& words) {
    const pmg::test::Finished outcome = build();
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_EQ(outcome.out, "");
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
  }
  pmg::test::TemporaryFolder folder_;
  std::filesystem::path out_ = folder_.file("clips");
};

TEST_F(PmgClipsBuild, RefusesABadRecipeAndWritesNothing) {
  write_recipe("some", "auto");
  expect_refused("library.yaml:4:");
  EXPECT_FALSE(std::filesystem::exists(out_));
}

TEST_F(PmgClipsBuild, RefusesABrokenRecordingAndWritesNothing) {
  std::ofstream(folder_.file("walk.bvh")) << "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0\n}\n";
  expect_refused("walk.bvh:");
  EXPECT_FALSE(std::filesystem::exists(out_));
}

/// The first clip is made, the second one has no cycle.
TEST_F(PmgClipsBuild, LeavesTheOldClipsWhereALaterClipCantBeMade) {
  std::filesystem::create_directory(out_);
  std::ofstream(out_ / "forward.yaml") << "old";
  write_recipe("auto", "[0, 3]");
  expect_refused("library.yaml:5:");
  EXPECT_EQ(pmg::test::text_of(out_ / "forward.yaml"), "old");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(out_), std::filesystem::directory_iterator()), 1);
}

TEST_F(PmgClipsBuild, RefusesAFolderWithClipsOfAnotherLibrary) {
  std::filesystem::create_directory(out_);
  std::ofstream(out_ / "backward.yaml") << "another's";
  expect_refused("backward.yaml: is no part of this library");
  EXPECT_EQ(pmg::test::text_of(out_ / "backward.yaml"), "another's");
}

TEST_F(PmgClipsBuild, RefusesAnOutputThatIsNoDirectoryBeforeItWorks) {
  std::ofstream(out_) << "mine";
  expect_refused("clips");
  EXPECT_EQ(pmg::test::text_of(out_), "mine");
}

}  // namespace
}  // namespace pmg::retargeting
