#include "gco/contact_point.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <random>

namespace pmg::gco {
namespace {

const std::array<Eigen::Vector3d, 4> kSole = {Eigen::Vector3d(0.15, 0.045, -0.7), Eigen::Vector3d(0.15, -0.045, -0.7),
                                              Eigen::Vector3d(-0.08, 0.045, -0.7),
                                              Eigen::Vector3d(-0.08, -0.045, -0.7)};

std::array<Eigen::Vector3d, 4> tilted(double roll_rad, double pitch_rad) {
  const Eigen::Matrix3d R =
      (Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitY()) * Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  std::array<Eigen::Vector3d, 4> sole = kSole;
  for (Eigen::Vector3d& corner : sole)
    corner = R * (corner - Eigen::Vector3d(0, 0, -0.7)) + Eigen::Vector3d(0, 0, -0.7);
  return sole;
}

TEST(ContactPoint, OfAFlatSoleIsItsCentre) {
  const ContactPoint point = contact_point(kSole, Eigen::Matrix3d::Identity());
  EXPECT_NEAR((point.p_BC - Eigen::Vector3d(0.035, 0.0, -0.7)).norm(), 0.0, 1e-15);
  EXPECT_DOUBLE_EQ(point.height_m, -0.7);
  EXPECT_DOUBLE_EQ(point.lowest_corner_m, -0.7);
}

TEST(ContactPoint, OfATiltedSoleIsItsLowEdgeOrCorner) {
  // 0.1 rad raises the other end by 2 cm, which is e^-70 in the softmin.
  const auto toes_down = tilted(0.0, 0.1);
  EXPECT_NEAR((contact_point(toes_down, Eigen::Matrix3d::Identity()).p_BC - 0.5 * (toes_down[0] + toes_down[1])).norm(),
              0.0, 1e-12);
  const auto corner_down = tilted(0.1, 0.1);
  EXPECT_NEAR((contact_point(corner_down, Eigen::Matrix3d::Identity()).p_BC - corner_down[1]).norm(), 0.0, 1e-12);
}

TEST(ContactPoint, SeesTheTiltOfTheBaseAsThatOfTheSole) {
  const Eigen::Matrix3d R_HB = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const ContactPoint point = contact_point(kSole, R_HB);
  EXPECT_NEAR((point.p_BC - 0.5 * (kSole[0] + kSole[1])).norm(), 0.0, 1e-12);
  EXPECT_NEAR(point.height_m, (R_HB * kSole[0]).z(), 1e-12);
}

TEST(ContactPoint, IsContinuousAndNeverFarAboveTheLowestCorner) {
  // From heel over flat to toe in steps of 1e-5 rad. The point crosses half the sole (0.115 m) within a few times 0.3
  // mm / 0.23 m = 1.3e-3 rad.
  const Eigen::Matrix3d level = Eigen::Matrix3d::Identity();
  Eigen::Vector3d last = contact_point(tilted(-0.006, -0.02), level).p_BC;
  for (int i = -2000; i <= 2000; ++i) {
    const auto sole = tilted(0.3e-5 * i, 1e-5 * i);
    const ContactPoint point = contact_point(sole, level);
    EXPECT_LT((point.p_BC - last).norm(), 1.5e-3) << i;
    EXPECT_GE(point.height_m - point.lowest_corner_m, -1e-15);
    EXPECT_LT(point.height_m - point.lowest_corner_m, 2e-4);
    EXPECT_NEAR(point.height_m, point.p_BC.z(), 1e-12);
    last = point.p_BC;
  }
}

TEST(HeightShares, GoToTheLowerOfTwoFeetInContact) {
  const auto shares = height_shares({-0.705, -0.7}, {1.0, 1.0});
  EXPECT_NEAR(shares[kLeft], 1.0, 1e-4);  // e^-10
  EXPECT_NEAR(shares[kRight], 0.0, 1e-4);
  EXPECT_NEAR(height_shares({-0.705, -0.7}, {1e-3, 1.0})[kLeft], 1.0, 1e-4) << "however little it is loaded";
  EXPECT_DOUBLE_EQ(height_shares({-0.7, -0.7}, {1.0, 1.0})[kLeft], 0.5);
}

TEST(HeightShares, LeaveAFootThatIsOffTheGroundNothing) {
  const auto shares = height_shares({-0.75, -0.7}, {0.0, 1.0});
  EXPECT_EQ(shares[kLeft], 0.0);
  EXPECT_EQ(shares[kRight], 1.0);
  EXPECT_EQ(height_shares({-0.7, -0.75}, {0.2, 0.0})[kLeft], 1.0);
}

TEST(HeightShares, SumToOneAndMoveNoFasterThanTheFeet) {
  std::mt19937 random(20261121);
  const auto unit = [&] { return static_cast<double>(random()) / static_cast<double>(std::mt19937::max()); };
  constexpr double kStep_m = 1e-6;
  constexpr double kSteepest_per_m = 0.25 / 0.5e-3;  // of a softmin with scale 0.5 mm
  for (int i = 0; i < 1000; ++i) {
    const PerFoot<double> height = {-0.7 + 0.002 * unit(), -0.7 + 0.002 * unit()};
    const PerFoot<double> weight = {0.01 + 0.99 * unit(), 1.0};
    const auto before = height_shares(height, weight);
    const auto after = height_shares({height[kLeft] + kStep_m, height[kRight]}, weight);
    EXPECT_NEAR(before[kLeft] + before[kRight], 1.0, 1e-12);
    EXPECT_LE(std::abs(after[kLeft] - before[kLeft]), kSteepest_per_m * kStep_m * (1.0 + 1e-3));
  }
}

}  // namespace
}  // namespace pmg::gco
