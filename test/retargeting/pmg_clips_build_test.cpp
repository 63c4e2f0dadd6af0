// The promises of `pmg_clips build` to its callers in a shell.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "folders.hpp"
#include "mocap/synthetic_gait.hpp"
#include "mocap/written_bvh.hpp"
#include "temporary_folder.hpp"

namespace pmg::retargeting {
namespace {

struct Outcome {
  int exit_code = -1;
  std::string output, errors;
};

std::string content(const std::filesystem::path& file) {
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

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
  Outcome build(const std::string& options = "") {
    const auto out = folder_.file("stdout.txt"), errors = folder_.file("stderr.txt");
    const int status = std::system(fmt::format("{}/pmg_clips build '{}' --no-inverse --out '{}' {} > '{}' 2> '{}'",
                                               pmg::test::program_folder(), folder_.file("library.yaml").string(),
                                               out_.string(), options, out.string(), errors.string())
                                       .c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content(out), content(errors)};
  }
  void expect_refused(const std::string& words) {
    const Outcome outcome = build();
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_EQ(outcome.output, "");
    EXPECT_NE(outcome.errors.find(words), std::string::npos) << outcome.errors;
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
  EXPECT_EQ(content(out_ / "forward.yaml"), "old");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(out_), std::filesystem::directory_iterator()), 1);
}

TEST_F(PmgClipsBuild, RefusesAFolderWithClipsOfAnotherLibrary) {
  std::filesystem::create_directory(out_);
  std::ofstream(out_ / "backward.yaml") << "another's";
  expect_refused("backward.yaml: is no part of this library");
  EXPECT_EQ(content(out_ / "backward.yaml"), "another's");
}

TEST_F(PmgClipsBuild, RefusesAnOutputThatIsNoDirectoryBeforeItWorks) {
  std::ofstream(out_) << "mine";
  expect_refused("clips");
  EXPECT_EQ(content(out_), "mine");
}

}  // namespace
}  // namespace pmg::retargeting
