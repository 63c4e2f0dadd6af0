#include "arms/clearance.hpp"

#include <gtest/gtest.h>

#include <random>

namespace pmg::arms {
namespace {

class Clearances : public testing::Test {
 protected:
  std::mt19937 random_{3};
  Eigen::Vector3d point() {
    std::uniform_real_distribution<double> any(-0.5, 0.5);
    return {any(random_), any(random_), any(random_)};
  }
  static Eigen::Vector3d on(const Capsule& c, int i) { return c.a + (c.b - c.a) * i / 200.0; }
};

// 200 steps along an axis of at most 1.8 m: a sample is within 4.5 mm of the nearest point, along the axis.
constexpr double kSampling_m = 0.005;

TEST_F(Clearances, OfTwoCapsulesAreTheNearestOfSamples) {
  for (int n = 0; n < 200; ++n) {
    const Capsule one{point(), n % 5 == 0 ? point() : point(), 0.03}, two{point(), point(), 0.05};
    double least = 1e9;
    for (int i = 0; i <= 200; ++i) {
      for (int k = 0; k <= 200; ++k) least = std::min(least, (on(one, i) - on(two, k)).norm());
    }
    const double found = clearance(one, two).distance_m + 0.08;
    EXPECT_LE(found, least + 1e-12);
    EXPECT_GE(found, least - 2.0 * kSampling_m);
  }
}

TEST_F(Clearances, ToABoxAreTheNearestOfSamplesAndTheNormalPointsAway) {
  for (int n = 0; n < 2000; ++n) {
    Box box;
    box.half_m = Eigen::Vector3d(0.1, 0.2, 0.05);
    box.pose.linear() = Eigen::AngleAxisd(point().x() * 6.0, point().normalized()).toRotationMatrix();
    box.pose.translation() = point();
    const Capsule arm{point(), point(), 0.03};
    double least = 1e9;
    for (int i = 0; i <= 200; ++i) {
      const Eigen::Vector3d p = box.pose.inverse() * on(arm, i);
      least = std::min(least, (p - p.cwiseMax(-box.half_m).cwiseMin(box.half_m)).norm());
    }
    const Clearance found = clearance(arm, box);
    EXPECT_LE(found.distance_m + 0.03, least + 1e-12);
    EXPECT_GE(found.distance_m + 0.03, least - kSampling_m);
    if (least < 1e-3) continue;
    Capsule away = arm;
    away.a += 1e-4 * found.normal;
    away.b += 1e-4 * found.normal;
    EXPECT_NEAR(clearance(away, box).distance_m, found.distance_m + 1e-4, 1e-6);
  }
}

}  // namespace
}  // namespace pmg::arms
