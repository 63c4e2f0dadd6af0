#include "library_film/library_film.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "library_film/clip_player.hpp"
#include "sim/renderer.hpp"
#include "sim/scene.hpp"
#include "sim/video_writer.hpp"

namespace pmg::library_film {
namespace {
using retargeting::Figure;
using retargeting::ReviewedClip;

constexpr int kFramesPerSecond = 25;
constexpr double kBeside_m = 0.95;  // from the robot to the figure: an arm's swing of both

std::array<float, 4> colour_of(mocap::KeyBody body) {
  const std::string name = mocap::kKeyBodyNames[static_cast<std::size_t>(body)];
  if (name.starts_with("left_")) return {0.0F, 0.45F, 0.70F, 1.0F};
  return name.starts_with("right_") ? std::array{0.84F, 0.37F, 0.0F, 1.0F} : std::array{0.12F, 0.13F, 0.15F, 1.0F};
}

std::vector<sim::Bar> bars_of(const Figure& figure, const Eigen::Vector3d& where_W, double yaw_rad) {
  const Eigen::AngleAxisd turn(yaw_rad, Eigen::Vector3d::UnitZ());
  std::vector<sim::Bar> bars;
  for (const auto& [from, to] : retargeting::figure_bones()) {
    const auto &a = figure[static_cast<std::size_t>(from)], &b = figure[static_cast<std::size_t>(to)];
    if (a && b) bars.push_back({where_W + turn * *a, where_W + turn * *b, 0.018, colour_of(to)});
  }
  return bars;
}

/// Walks are seen from the right side, sidesteps from the front; the figure is beside the robot in the picture.
sim::RendererOptions camera_of(const ReviewedClip& clip) {
  return {.width = 960, .height = 540, .azimuth_deg = clip.recipe.channel == kVy ? 180.0 : 75.0};
}

Eigen::Vector3d beside(const ReviewedClip& clip) {
  return clip.recipe.channel == kVy ? Eigen::Vector3d(0.0, -kBeside_m, 0.0) : Eigen::Vector3d(kBeside_m, 0.0, 0.0);
}

void shoot(ClipPlayer& player, const ReviewedClip& clip, double seconds, sim::VideoWriter& writer,
           const work::Progress& progress) {
  sim::Renderer renderer(player.world().mj_model(), camera_of(clip));
  player.begin(clip.clip);
  const auto n = static_cast<double>(clip.clip.q.size());
  double played = 0.0;  // samples
  for (int picture = 0; picture < static_cast<int>(seconds * kFramesPerSecond); ++picture) {
    if (progress.interrupted_now()) throw work::Interrupted();
    for (const double until = picture / static_cast<double>(kFramesPerSecond) / clip.clip.period_s * n;
         played + 0.5 < until; ++played)
      player.step();
    const Eigen::Vector3d ground(player.base_W().x(), player.base_W().y(), 0.0);
    const std::vector<sim::Bar> bars = bars_of(clip.person[player.sample()], ground + beside(clip), player.yaw_rad());
    const std::string text = fmt::format("{}\nlines: the person of {}, scaled by leg length", clip.recipe.name,
                                         clip.recipe.recording.filename().string());
    writer.write(renderer.render(player.world().mj_data(), text, std::nullopt, bars));
  }
}

}  // namespace

void write_film(const model::RobotModel& robot, const retargeting::LibraryReview& review,
                const std::filesystem::path& file, double seconds_each, const work::Progress& progress) {
  const sim::RendererOptions size = {.width = 960, .height = 540};
  sim::VideoWriter writer(file, size.width, size.height, kFramesPerSecond);
  ClipPlayer player(robot);
  for (std::size_t i = 0; i < review.clips.size(); ++i) {
    if (progress.report)
      progress.report(static_cast<double>(i) / static_cast<double>(review.clips.size()),
                      "filming " + review.clips[i].recipe.name);
    shoot(player, review.clips[i], seconds_each, writer, progress);
  }
  writer.close();
}

}  // namespace pmg::library_film
