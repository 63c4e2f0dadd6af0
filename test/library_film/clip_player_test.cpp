// The promises of a clip played kinematically: the robot goes where its feet take it, and links that touch are found.
#include "library_film/clip_player.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "library_film/library_film.hpp"
#include "model/clip_library_file.hpp"
#include "sim/video_writer.hpp"
#include "temporary_folder.hpp"

namespace pmg::library_film {
namespace {

const model::RobotModel& z1() {
  static const model::RobotModel robot = model::load_robot(model::find_robot("z1"));
  return robot;
}
const ClipLibrary& clips() {
  static const ClipLibrary library = model::load_clip_library(z1().directory / "clips", z1());
  return library;
}

/// The clips' tolerance (generator/clip_report.hpp), over one cycle.
constexpr double kTolerance = 0.05;

TEST(APlayedClip, MovesAtItsMeanVelocityWithItsLowestSoleOnTheGround) {
  ClipPlayer player(z1());
  for (const auto& clip :
       {clips().positive[kVx], clips().negative[kVx], clips().positive[kVy], clips().positive[kOmega]}) {
    ASSERT_TRUE(clip.has_value());
    player.begin(*clip);
    Eigen::Vector3d expected = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < clip->q.size(); ++k) {
      player.step();
      EXPECT_GT(player.base_W().z(), 0.5 * z1().standing_height_m);
    }
    EXPECT_EQ(player.sample(), 0U);
    EXPECT_NEAR(player.yaw_rad(), clip->mean_velocity[kOmega] * clip->period_s, 1e-9);
    if (std::abs(clip->mean_velocity[kOmega]) > 0.1) continue;  // a circle's chord isn't the arc
    expected.x() = clip->mean_velocity[kVx] * clip->period_s;
    expected.y() = clip->mean_velocity[kVy] * clip->period_s;
    EXPECT_NEAR(player.base_W().x(), expected.x(), kTolerance * clip->period_s);
    EXPECT_NEAR(player.base_W().y(), expected.y(), kTolerance * clip->period_s);
  }
}

TEST(APlayedClip, FindsLinksInEachOther) {
  ClipPlayer player(z1());
  DynamicClip still = *clips().positive[kVx];
  for (std::size_t k = 0; k < still.q.size(); ++k) {
    still.q[k] = z1().q_stand();
    still.dq_dphi[k].setZero();
  }
  EXPECT_EQ(player.self_collision(still).depth_m, 0.0);
  // Crossed legs in one sample alone.
  const int roll = z1().joint_index.at("left_hip_roll");
  const model::Joint& joint = z1().joints[static_cast<std::size_t>(roll)];
  still.q[40][roll] = std::abs(joint.lower_rad) < std::abs(joint.upper_rad) ? joint.lower_rad : joint.upper_rad;
  const int yaw = z1().joint_index.at("left_hip_yaw");
  still.q[40][yaw] = z1().joints[static_cast<std::size_t>(yaw)].lower_rad;
  const Touch touch = player.self_collision(still);
  EXPECT_GT(touch.depth_m, 0.0);
  EXPECT_NE(touch.links.find(" and "), std::string::npos) << touch.links;
}

TEST(LibraryFilm, ShowsEachClip) {
  sim::expect_ffmpeg();
  retargeting::ReviewedClip clip;
  clip.recipe.name = "forward";
  clip.recipe.recording = "walk.bvh";
  clip.clip = *clips().positive[kVx];
  clip.robot = clip.person = retargeting::figures_of(z1(), clip.clip);
  const pmg::test::TemporaryFolder folder;
  const std::filesystem::path file = folder.file("film.mp4");
  write_film(z1(), {.source = "", .robot = "z1", .clips = {clip}}, file, 0.2);
  EXPECT_GT(std::filesystem::file_size(file), 1000U);
}

}  // namespace
}  // namespace pmg::library_film
