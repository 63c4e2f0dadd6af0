// What a camera on the robot's head sees, and its pictures as files.
#include "sim/head_camera.hpp"

#include <gtest/gtest.h>
#include <turbojpeg.h>

#include <array>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "robots.hpp"
#include "sim/jpeg.hpp"
#include "sim/world.hpp"

namespace pmg::sim {
namespace {

constexpr int kWidth = 160, kHeight = 120;

/// How many pixels of a red box's picture are in each quarter: top left, top right, bottom left, bottom right.
std::array<int, 4> red_pixels(const Eigen::Vector3d& box_m) {
  WorldOptions options;
  options.props = {{.name = "box", .half_size_m = {0.1, 0.1, 0.1}, .p_WP_m = box_m, .colour = {1.0, 0.0, 0.0, 1.0}}};
  World world(z1(), options);
  Renderer renderer(
      world.mj_model(),
      {.width = kWidth, .height = kHeight, .mounted = mounted(HeadCamera(), z1().torso_link, kWidth, kHeight)});
  const std::vector<std::uint8_t>& rgb = renderer.render(world.mj_data());
  std::array<int, 4> count{};
  for (std::size_t i = 0; i < rgb.size() / 3; ++i) {
    const std::size_t x = i % kWidth, y = i / kWidth;
    const bool red = rgb[3 * i] > 100 && rgb[3 * i + 1] < 60 && rgb[3 * i + 2] < 60;
    if (red) ++count.at((y < kHeight / 2 ? 0 : 2) + (x < kWidth / 2 ? 0 : 1));
  }
  return count;
}

TEST(HeadCamera, SeesWhatIsAheadOnItsOwnSideAndNothingBehind) {
  const auto left = red_pixels({0.8, 0.5, 0.1}), right = red_pixels({0.8, -0.5, 0.1}),
             behind = red_pixels({-0.8, 0.0, 0.1});
  EXPECT_GT(left[2], 20) << "on the floor, to the left";
  EXPECT_EQ(left[1] + left[3], 0);
  EXPECT_GT(right[3], 20);
  EXPECT_EQ(right[0] + right[2], 0);
  EXPECT_EQ(behind, (std::array<int, 4>{}));
}

TEST(HeadCamera, WhatIsHigherIsHigherInThePicture) {
  const auto far = red_pixels({2.0, 0.0, 0.5});
  EXPECT_GT(far[0] + far[1], 5);
  EXPECT_EQ(far[2] + far[3], 0);
}

TEST(HeadCamera, ARobotWithoutThatBodyIsRefused) {
  const World world(z1(), {});
  EXPECT_THROW(Renderer(world.mj_model(),
                        {.width = kWidth, .height = kHeight, .mounted = mounted(HeadCamera(), "no_such_link", 4, 3)}),
               std::runtime_error);
}

TEST(Jpeg, APictureThatDoesNotFitIsMadeCoarserAndOneThatNeverFitsIsRefused) {
  constexpr int kSide = 128;
  constexpr std::size_t kFine = 1'000'000, kFew = 9000;
  std::mt19937 random(7);
  std::vector<std::uint8_t> noise(std::size_t{3} * kSide * kSide);
  for (std::uint8_t& value : noise) value = static_cast<std::uint8_t>(random());
  JpegEncoder encoder;
  const std::size_t fine = encoder.encode(noise, kSide, kSide, kFine).size();
  const std::vector<std::uint8_t> coarse = encoder.encode(noise, kSide, kSide, kFew);
  EXPECT_GT(fine, kFew);
  EXPECT_LE(coarse.size(), kFew);
  tjhandle reader = tjInitDecompress();
  int width = 0, height = 0, sampling = 0, colours = 0;
  EXPECT_EQ(tjDecompressHeader3(reader, coarse.data(), coarse.size(), &width, &height, &sampling, &colours), 0);
  tjDestroy(reader);
  EXPECT_EQ(width, kSide);
  EXPECT_EQ(height, kSide);
  EXPECT_THROW(encoder.encode(noise, kSide, kSide, 100), std::runtime_error);
  EXPECT_THROW(encoder.encode(noise, kSide, kSide + 1, kFine), std::runtime_error);
}

}  // namespace
}  // namespace pmg::sim
