#include "sim/renderer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>

#include "robots.hpp"
#include "sim/video_writer.hpp"
#include "sim/world.hpp"
#include "temporary_folder.hpp"

namespace pmg {
namespace {

constexpr sim::RendererOptions kSmall{.width = 320, .height = 180};

using Rgb = std::vector<std::uint8_t>;

std::size_t differing_pixels(const Rgb& a, const Rgb& b, int first_row, int rows) {
  std::size_t count = 0;
  for (std::size_t i = 3 * 320 * static_cast<std::size_t>(first_row);
       i < 3 * 320 * static_cast<std::size_t>(first_row + rows); i += 3)
    count += !std::equal(a.begin() + static_cast<std::ptrdiff_t>(i), a.begin() + static_cast<std::ptrdiff_t>(i + 3),
                         b.begin() + static_cast<std::ptrdiff_t>(i));
  return count;
}

TEST(Renderer, ShowsTheRobotWithoutADisplay) {
  sim::World world(z1(), {});
  sim::Renderer renderer(world.mj_model(), kSmall);
  const Rgb picture = renderer.render(world.mj_data());
  ASSERT_EQ(picture.size(), 320U * 180U * 3U);
  std::set<std::array<std::uint8_t, 3>> colours;
  for (std::size_t i = 0; i < picture.size(); i += 3) colours.insert({picture[i], picture[i + 1], picture[i + 2]});
  EXPECT_GT(colours.size(), 200U) << "sky, floor and a shaded robot";
  // Software OpenGL rasterises in threads, which may round an edge differently.
  EXPECT_LT(differing_pixels(picture, renderer.render(world.mj_data()), 0, 180), 20U) << "one state, one picture";
}

TEST(Renderer, PicturesStandUpright) {
  sim::World world(z1(), {});
  sim::Renderer renderer(world.mj_model(), kSmall);
  const Rgb before = renderer.render(world.mj_data());
  const int head_yaw = mj_name2id(world.mj_model(), mjOBJ_JOINT, "head_yaw");
  world.mj_data()->qpos[world.mj_model()->jnt_qposadr[head_yaw]] = 0.8;
  mj_forward(world.mj_model(), world.mj_data());
  const Rgb after = renderer.render(world.mj_data());
  EXPECT_GT(differing_pixels(before, after, 0, 90), 10U) << "the head is in the upper half";
}

TEST(Renderer, LaysTextOverTheTopLeftCorner) {
  sim::World world(z1(), {});
  sim::Renderer renderer(world.mj_model(), kSmall);
  const Rgb plain = renderer.render(world.mj_data());
  const Rgb with_text = renderer.render(world.mj_data(), "Walk");
  EXPECT_GT(differing_pixels(plain, with_text, 0, 60), 20U);
  EXPECT_LT(differing_pixels(plain, with_text, 90, 90), 20U);
}

TEST(Renderer, TurnsSoftlyToWhereItIsToLookFrom) {
  sim::World world(z1(), {});
  sim::Renderer renderer(world.mj_model(), {.width = 320, .height = 180, .azimuth_deg = 180.0});
  const Rgb front = renderer.render(world.mj_data());
  renderer.look_from(270.0);
  world.mj_data()->time += 0.04;
  const Rgb begun = renderer.render(world.mj_data());
  world.mj_data()->time += 5.0;
  const Rgb left = renderer.render(world.mj_data());
  sim::Renderer from_left(world.mj_model(), {.width = 320, .height = 180, .azimuth_deg = 270.0});
  const Rgb expected = from_left.render(world.mj_data());
  EXPECT_LT(differing_pixels(left, expected, 0, 180), 50U) << "it has arrived";
  EXPECT_GT(differing_pixels(front, begun, 0, 180), 50U) << "it turns";
  EXPECT_GT(differing_pixels(begun, expected, 0, 180), 50U) << "and doesn't jump";
}

TEST(VideoWriter, WritesAnMp4) {
  const test::TemporaryFolder folder;
  const auto path = folder.file("pmg video 'quoted'.mp4");
  {
    sim::VideoWriter video(path, 64, 48);
    Rgb frame(64 * 48 * 3);
    for (int i = 0; i < 20; ++i) {
      for (std::size_t k = 0; k < frame.size(); ++k)
        frame[k] = static_cast<std::uint8_t>(k * 7 + static_cast<std::size_t>(i) * 5);
      video.write(frame);
    }
    video.close();
  }
  std::ifstream file(path, std::ios::binary);
  std::string head(12, '\0');
  file.read(head.data(), 12);
  EXPECT_EQ(head.substr(4, 4), "ftyp");
  EXPECT_GT(std::filesystem::file_size(path), 1000U);
  std::filesystem::remove(path);
}

/// What a program prints is for machines, too (--json).
TEST(VideoWriter, LooksForFfmpegWithoutAWordOnStandardOutput) {
  testing::internal::CaptureStdout();
  sim::expect_ffmpeg();
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

TEST(VideoWriter, SaysSoWhenFfmpegIsMissing) {
  const test::TemporaryFolder folder;
  const std::string path = std::getenv("PATH");
  setenv("PATH", folder.path().c_str(), 1);
  std::string message;
  try {
    sim::VideoWriter video(folder.file("none.mp4"), 64, 48);
  } catch (const std::runtime_error& error) {
    message = error.what();
  }
  setenv("PATH", path.c_str(), 1);
  EXPECT_THAT(message, testing::HasSubstr("ffmpeg"));
}

TEST(VideoWriter, SaysSoWhenTheFileCantBeWritten) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "no such folder" / "x.mp4";
  const auto write_and_close = [&path] {
    sim::VideoWriter video(path, 64, 48);
    const Rgb frame(64 * 48 * 3);
    for (int i = 0; i < 100; ++i) video.write(frame);
    video.close();
  };
  EXPECT_THROW(write_and_close(), std::runtime_error);
}

TEST(VideoWriter, RefusesAFrameOfAnotherSize) {
  const test::TemporaryFolder folder;
  sim::VideoWriter video(folder.file("size.mp4"), 64, 48);
  EXPECT_THROW(video.write(Rgb(100)), std::runtime_error);
}

}  // namespace
}  // namespace pmg
