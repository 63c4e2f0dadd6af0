// The promises of LIBRARY.yaml: every key is checked, every error says where and what was expected.
#include "retargeting/library_recipe.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "made_up_people.hpp"
#include "retargeting/build_library.hpp"
#include "temporary_folder.hpp"

namespace pmg::retargeting {
namespace {

class Recipe : public ::testing::Test {
 protected:
  void SetUp() override { std::ofstream(folder_.file("walk.bvh")) << "HIERARCHY\n"; }
  std::filesystem::path written(const std::string& text) {
    std::ofstream(folder_.file("library.yaml"), std::ios::binary) << text;
    return folder_.file("library.yaml");
  }
  void expect_refused(const std::string& text, const std::string& place, const std::string& words) {
    try {
      read_library_recipe(written(text));
      FAIL() << "no error: " << text;
    } catch (const files::ConfigError& error) {
      const std::string what = error.what();
      EXPECT_NE(what.find("library.yaml" + place), std::string::npos) << what;
      EXPECT_NE(what.find(words), std::string::npos) << what;
    }
  }
  static std::string with_forward(const std::string& forward) {
    return "source: me\npostures: synthesised\nclips:\n  forward: " + forward +
           "\n  lateral: {recording: walk.bvh, frames: auto}\n  turn: {recording: walk.bvh, frames: auto}\n";
  }
  pmg::test::TemporaryFolder folder_;
};

TEST_F(Recipe, NamesRecordingFramesAndMirroringOfEachClip) {
  const LibraryRecipe recipe = read_library_recipe(
      written("source: me\npostures: synthesised\nclips:\n  forward: {recording: walk.bvh, frames: [10, 90]}\n"
              "  lateral: {recording: walk.bvh, frames: auto}\n"
              "  lateral_right: {recording: walk.bvh, frames: auto, mirrored: true}\n"
              "  turn: {recording: walk.bvh, frames: auto, rate_hz: 30, unit_m: 0.01, up: +y}\n"));
  ASSERT_EQ(recipe.clips.size(), 4U);
  EXPECT_EQ(recipe.source, "me");
  EXPECT_EQ(recipe.clips[0].name, "forward");
  EXPECT_EQ(recipe.clips[0].recording, folder_.file("walk.bvh"));
  EXPECT_EQ(recipe.clips[0].frames, std::pair(10.0, 90.0));
  EXPECT_FALSE(recipe.clips[1].frames.has_value());
  EXPECT_EQ(recipe.clips[2].name, "lateral_right");
  EXPECT_TRUE(recipe.clips[2].mirrored);
  EXPECT_EQ(recipe.clips[2].sign, -1.0);
  EXPECT_EQ(recipe.clips[3].options.rate_hz, 30.0);
  EXPECT_EQ(recipe.clips[3].options.up, "+y");
}

TEST_F(Recipe, MayStateTheDutyFactorOfAWalk) {
  const std::string clips = with_forward("{recording: walk.bvh, frames: auto}");
  EXPECT_FALSE(read_library_recipe(written(clips)).duty_factor.has_value());
  EXPECT_EQ(read_library_recipe(written("duty_factor: 0.6277327719748981\n" + clips)).duty_factor, 0.6277327719748981);
  // Below a half no instant has both feet on the ground; near 1 a foot has no time to swing.
  for (const char* r : {"0.5", "0.96", "-0.6", "walk"})
    expect_refused(std::string("duty_factor: ") + r + "\n" + clips, ":1:", "expected a number");
}

TEST_F(Recipe, FindsRecordingsInAnotherFolderThanItsOwn) {
  const std::filesystem::path recordings = folder_.file("recordings");
  std::filesystem::create_directory(recordings);
  const std::filesystem::path recipe = written(with_forward("{recording: walk.bvh, frames: auto}"));
  EXPECT_THROW(read_library_recipe(recipe, recordings), files::ConfigError) << "walk.bvh is beside the recipe";
  std::filesystem::rename(folder_.file("walk.bvh"), recordings / "walk.bvh");
  EXPECT_EQ(read_library_recipe(recipe, recordings).clips[0].recording, recordings / "walk.bvh");
}

TEST_F(Recipe, RefusesFramesThatAreNoRange) {
  expect_refused(with_forward("{recording: walk.bvh, frames: all}"), ":4:", "expected auto, or [first frame");
  expect_refused(with_forward("{recording: walk.bvh, frames: [90, 10]}"), ":4:", "expected auto, or [first frame");
  expect_refused(with_forward("{recording: walk.bvh, frames: [1, 2, 3]}"), ":4:", "frames");
  expect_refused(with_forward("{recording: walk.bvh}"), ":4:", "frames");
}

TEST_F(Recipe, RefusesARecordingThatIsNotThere) {
  expect_refused(with_forward("{recording: run.bvh, frames: auto}"), ":4:", "doesn't exist; expected a motion file");
}

TEST_F(Recipe, RefusesUnknownKeysAndClips) {
  expect_refused(with_forward("{recording: walk.bvh, frames: auto, speed: 2}"), ":4:", "speed");
  expect_refused(
      "source: me\npostures: synthesised\nclips:\n  forward: {recording: walk.bvh, frames: auto}\n"
      "  lateral: {recording: walk.bvh, frames: auto}\n  turn: {recording: walk.bvh, frames: auto}\n"
      "  squat: {recording: walk.bvh, frames: auto}\n",
      ":7:", "squat");
}

TEST_F(Recipe, RefusesALibraryThatTheGeneratorCouldNotLoad) {
  expect_refused("source: me\npostures: synthesised\nclips:\n  forward: {recording: walk.bvh, frames: auto}\n", ":",
                 "lateral");
}

TEST_F(Recipe, RefusesPosturesOfRecordedPeopleWhichArentMadeYet) {
  expect_refused("source: me\npostures: recorded\nclips: {}\n", ":2:", "synthesised");
  expect_refused("source: me\nclips: {}\n", ":", "postures");
}

TEST_F(Recipe, RefusesAClipForWhichTheRecordingHasNoCycle) {
  const mocap::Recording recording = mocap::test::walk({});
  ClipRecipe clip;
  clip.name = "backward";
  clip.channel = kVx;
  clip.sign = -1.0;
  clip.recording = "walk.bvh";
  clip.frames_place = {"library.yaml", 7, 3};
  for (const auto& frames : {std::optional<std::pair<double, double>>(), std::optional(std::pair(0.0, 20.0))}) {
    clip.frames = frames;
    try {
      chosen_cycle(clip, recording);
      FAIL() << "no error";
    } catch (const files::ConfigError& error) {
      EXPECT_NE(std::string(error.what()).find("library.yaml:7:3: clips.backward.frames: "), std::string::npos)
          << error.what();
    }
  }
}

TEST_F(Recipe, AutoChoosesTheWalkInTheClipsDirection) {
  const mocap::Recording recording = mocap::test::walk({});
  ClipRecipe clip;
  clip.name = "forward";
  const mocap::GaitCycle cycle = chosen_cycle(clip, recording);
  EXPECT_NEAR(cycle.period_s(), 1.1, 0.03);
  EXPECT_LT(cycle.loop_error_m, 0.01);
}

}  // namespace
}  // namespace pmg::retargeting
