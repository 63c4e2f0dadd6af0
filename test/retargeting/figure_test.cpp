// The promises of stick figures: bodies where they are, on the ground, seen along the heading.
#include "retargeting/figure.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "made_up_people.hpp"
#include "model/clip_library_file.hpp"

namespace pmg::retargeting {
namespace {
using mocap::KeyBody;
using mocap::Side;

Eigen::Vector3d at(const Figure& figure, KeyBody key) { return figure[static_cast<std::size_t>(key)].value(); }

TEST(AFigureOfAPerson, WalksForwardOnTheGroundWhateverTheHeading) {
  for (const double heading : {0.0, 1.0, -2.5}) {
    const mocap::test::Walker walker{.leg_m = 0.9, .rate_hz = 120.0, .heading_rad = heading};
    const mocap::Recording recording = mocap::test::walk(walker);
    const HumanCycle human = human_cycle(recording, test::cycle_of(recording));
    const std::vector<Figure> figures = figures_of(recording, human);
    ASSERT_EQ(figures.size(), human.pose.size());
    for (std::size_t k = 0; k < figures.size(); ++k) {
      EXPECT_NEAR(at(figures[k], KeyBody::pelvis).head<2>().norm(), 0.0, 1e-9);
      for (const Side side : {Side::left, Side::right}) {
        const Eigen::Vector3d hip = at(figures[k], of_side(KeyBody::left_hip, side)),
                              knee = at(figures[k], of_side(KeyBody::left_knee, side));
        EXPECT_NEAR((knee - hip).norm(), 0.53 * walker.leg_m, 0.002) << k;
        EXPECT_NEAR(hip.y(), (side == Side::left ? 0.1 : -0.1) * walker.leg_m, 0.01) << k;
        // The figure's thigh points where the aligned cycle's does: within the smoothing of the cycle.
        EXPECT_GE((knee - hip).normalized().dot(human.pose[k].side[static_cast<std::size_t>(side)].thigh),
                  std::cos(0.05))
            << k;
        EXPECT_GE(at(figures[k], of_side(KeyBody::left_toe, side)).z(), -0.03) << k;
      }
    }
  }
}

TEST(AFigureOfARobot, HasItsLowestSoleOnTheGroundAndLimbsThatKeepTheirLengths) {
  const model::RobotModel robot = model::load_robot(model::find_robot("z1"));
  const ClipLibrary library = model::load_clip_library(robot.directory / "clips", robot);
  const std::vector<Figure> figures = figures_of(robot, *library.positive[kVx]);
  const auto length = [&](std::size_t k, KeyBody a, KeyBody b) {
    return (at(figures[k], a) - at(figures[k], b)).norm();
  };
  for (std::size_t k = 0; k < figures.size(); ++k) {
    for (const auto& [a, b] :
         {std::pair{KeyBody::left_hip, KeyBody::left_knee}, std::pair{KeyBody::left_knee, KeyBody::left_ankle},
          std::pair{KeyBody::left_heel, KeyBody::left_toe}, std::pair{KeyBody::left_shoulder, KeyBody::left_elbow},
          std::pair{KeyBody::right_elbow, KeyBody::right_wrist}})
      EXPECT_NEAR(length(k, a, b), length(0, a, b), 1e-9) << k;
    double lowest_m = 1.0;
    for (const KeyBody body : {KeyBody::left_heel, KeyBody::left_toe, KeyBody::right_heel, KeyBody::right_toe})
      lowest_m = std::min(lowest_m, at(figures[k], body).z());
    // On a corner the middles of the edges are higher, by less than half the width of the sole.
    EXPECT_GE(lowest_m, 0.0) << k;
    EXPECT_LE(lowest_m, robot.feet[kLeft].box_half_size_m.y()) << k;
    EXPECT_GT(at(figures[k], KeyBody::neck).z(), at(figures[k], KeyBody::pelvis).z());
    EXPECT_GT(at(figures[k], KeyBody::left_hip).y(), at(figures[k], KeyBody::right_hip).y());
  }
}

}  // namespace
}  // namespace pmg::retargeting
