// Each reader gives the positions that its small file means.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "mocap_files/motion.hpp"
#include "small_files.hpp"
#include "temporary_folder.hpp"

namespace pmg::mocap {
namespace {

using Eigen::Vector3d;

const Point& named(const Motion& motion, const std::string& name) {
  for (const Point& point : motion.points) {
    if (point.name == name) return point;
  }
  ADD_FAILURE() << "no point " << name;
  return motion.points.front();
}

constexpr double kExact = 1e-9;           // of numbers that a text holds in full
constexpr double kFloat_rounding = 1e-4;  // of floats up to 100

TEST(Bvh, TurnsTheBonesOfTheHierarchy) {
  const Motion motion = parse_bvh("x.bvh", test::small_bvh());
  EXPECT_EQ(motion.frames, 2U);
  EXPECT_NEAR(*motion.rate_hz, 100.0, kExact);
  EXPECT_TRUE(named(motion, "LeftFoot").position[0].isApprox(Vector3d(10, 15, 0), kExact));
  EXPECT_TRUE(
      named(motion, "LeftLeg").position[1].isApprox(Vector3d(11, 100, 42), kExact));  // -y turned by -90 about x is +z
  EXPECT_TRUE(named(motion, "LeftFoot").position[1].isApprox(Vector3d(11, 100, 87), kExact));
  EXPECT_TRUE(named(motion, "LeftFoot.end").position[1].isApprox(Vector3d(11, 115, 92), kExact));
}

TEST(Bvh, TakesChannelsInTheFilesOrder) {
  const std::string zx =
      "HIERARCHY\nROOT a {\nOFFSET 0 0 0\nCHANNELS 2 Zrotation Xrotation\nEnd Site\n{\nOFFSET 0 0 "
      "1\n}\n}\nMOTION\nFrames: 1\nFrame Time: 1\n90 90\n";
  // R = Rz(90) Rx(90): z goes to -y by Rx, and -y to +x by Rz.
  EXPECT_TRUE(parse_bvh("x.bvh", zx).points[1].position[0].isApprox(Vector3d(1, 0, 0), kExact));
}

TEST(AsfAmc, TurnsABoneAboutItsOwnAxes) {
  const Motion motion = parse_asf_amc("x.asf", test::small_asf(), "x.amc", test::small_amc());
  EXPECT_EQ(motion.frames, 2U);
  EXPECT_NEAR(*motion.unit_m, 0.0254 / 0.45, kExact);
  EXPECT_TRUE(named(motion, "lfemur").position[0].isApprox(Vector3d(1, 0, 3), kExact));
  // The bone's x axis is (cos 20, sin 20, 0). Turning -y by -90 degrees about it: v = -y has the part -sin 20 along the
  // axis, the rest cos 20 goes to the axis cross v, negated: (x cross -y) = -z, so +z. Then the root turns by 90 about
  // y.
  const double c = std::cos(20.0 * std::numbers::pi / 180.0), s = std::sin(20.0 * std::numbers::pi / 180.0);
  const Vector3d local = -s * Vector3d(c, s, 0.0) + Vector3d(0.0, 0.0, c);
  const Vector3d turned(local.z(), local.y(), -local.x());
  EXPECT_TRUE(named(motion, "lfemur").position[1].isApprox(Vector3d(1, 2, 3) + 2.0 * turned, kExact));
}

TEST(Trc, ReadsMarkersAndGaps) {
  const Motion motion = parse_trc("x.trc", test::small_trc());
  EXPECT_EQ(motion.frames, 3U);
  EXPECT_TRUE(motion.markers);
  EXPECT_NEAR(*motion.unit_m, 0.001, kExact);
  EXPECT_TRUE(named(motion, "L.Toe").position[1].isApprox(Vector3d(4.5, 5, 6), kExact));
  EXPECT_TRUE(std::isnan(named(motion, "L.Heel").position[1].x()));
}

TEST(C3d, ReadsEveryProcessorsNumbers) {
  for (const auto processor : {test::C3dProcessor::kIntel, test::C3dProcessor::kDec, test::C3dProcessor::kMips}) {
    for (const float scale : {-0.1F, 0.5F}) {
      const Motion motion = parse_c3d("x.c3d", test::small_c3d(processor, scale));
      SCOPED_TRACE(fmt::format("processor {}, scale {}", static_cast<int>(processor), scale));
      ASSERT_EQ(motion.frames, 3U);
      EXPECT_NEAR(*motion.rate_hz, 50.0, kFloat_rounding);
      EXPECT_NEAR(*motion.unit_m, 0.001, kExact);
      EXPECT_TRUE(named(motion, "LHEE").position[2].isApprox(Vector3d(2, 0, 100), kFloat_rounding));
      EXPECT_TRUE(named(motion, "LTOE").position[2].isApprox(Vector3d(2, 10, 100), kFloat_rounding));
      EXPECT_TRUE(std::isnan(named(motion, "LTOE").position[1].x()));
    }
  }
}

TEST(Amass, PlacesTheBodyFromItsRestPose) {
  for (const bool deflated : {false, true}) {
    const Motion motion = parse_amass("x.npz", test::small_npz(deflated), "rest.csv", test::small_rest_pose());
    EXPECT_EQ(motion.frames, 2U);
    EXPECT_NEAR(*motion.rate_hz, 60.0, kExact);
    EXPECT_TRUE(named(motion, "left_ankle").position[0].isApprox(Vector3d(0.1, -0.8, 0), kExact));
    EXPECT_TRUE(named(motion, "left_ankle").position[1].isApprox(Vector3d(0.1, 1.0, 0.8), kExact));
    EXPECT_TRUE(named(motion, "right_ankle").position[1].isApprox(Vector3d(-0.1, 0.2, 0), kExact));
  }
}

TEST(Amass, GivesTheAnglesAloneWithoutARestPose) {
  const Motion motion = parse_amass("x.npz", test::small_npz(true), "", "");
  ASSERT_EQ(motion.points.size(), 1U);
  EXPECT_TRUE(motion.points[0].position[1].isApprox(Vector3d(0, 1, 0), kExact));
  ASSERT_EQ(motion.joints.size(), 63U);
  EXPECT_EQ(motion.joints[0], "left_hip.x");
  EXPECT_NEAR(motion.joint_rad[1][0], -std::numbers::pi / 2.0, kExact);
}

TEST(RobotCsv, ReadsTheRootAndTheJointsByName) {
  const Motion motion = parse_robot_csv("x.csv", test::robot_csv());
  EXPECT_EQ(motion.frames, 2U);
  ASSERT_EQ(motion.joints, (std::vector<std::string>{"left_knee", "right_knee"}));
  EXPECT_NEAR(motion.joint_rad[1][1], 0.4, kExact);
  EXPECT_TRUE((motion.points[0].orientation[1] * Vector3d::UnitX()).isApprox(Vector3d::UnitY(), 1e-6));
}

TEST(RobotCsv, FindsTheQuaternionsOrderWithoutAHeader) {
  const double s = std::sqrt(0.5);  // a yaw of 90 degrees
  for (const bool w_last : {true, false}) {
    const std::string q = w_last ? fmt::format("0,0,{},{}", s, s) : fmt::format("{},0,0,{}", s, s);
    const std::string row = std::string("1,2,0.8,").append(q).append(",0.1,0.2\n");
    const Motion motion = parse_robot_csv("x.csv", row + row);
    EXPECT_TRUE((motion.points[0].orientation[0] * Vector3d::UnitX()).isApprox(Vector3d::UnitY(), 1e-6))
        << motion.notes[0];
    EXPECT_EQ(motion.joints.size(), 2U);
  }
}

/// Programs on Windows write UTF-8's mark in front, and two characters at a line's end.
TEST(TextFiles, AreReadAsWindowsWritesThem) {
  const pmg::test::TemporaryFolder folder;
  for (const auto& [name, text] : {std::pair{"a.bvh", test::small_bvh()}, std::pair{"b.trc", test::small_trc()},
                                   std::pair{"c.csv", test::robot_csv()}, std::pair{"d.asf", test::small_asf()},
                                   std::pair{"d.amc", test::small_amc()}}) {
    std::ofstream file(folder.file(name), std::ios::binary);
    file << "\xEF\xBB\xBF";
    for (const char c : text) file << (c == '\n' ? "\r" : "") << c;
  }
  EXPECT_EQ(read_motion(folder.file("a.bvh")).frames, 2U);
  EXPECT_EQ(read_motion(folder.file("b.trc")).frames, 3U);
  EXPECT_EQ(read_motion(folder.file("b.trc")).points[1].name, "L.Toe");
  EXPECT_EQ(read_motion(folder.file("c.csv")).joints, (std::vector<std::string>{"left_knee", "right_knee"}));
  EXPECT_EQ(read_motion(folder.file("d.amc")).frames, 2U);
}

}  // namespace
}  // namespace pmg::mocap
