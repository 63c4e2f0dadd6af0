// Key bodies, unit and axes of skeletons that nobody described.
#include "mocap_files/recording.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <tuple>

#include "files/config_error.hpp"
#include "small_files.hpp"

namespace pmg::mocap {
namespace {

using Eigen::Vector3d;

const NameTable& names() {
  static const NameTable table = read_name_table(default_name_table());
  return table;
}

/// A person with legs of 0.4 m and 0.45 m, standing for two frames, in any unit and any axes, under any names.
Motion standing(double unit_m, const Eigen::Matrix3d& file_axes, const std::vector<std::string>& point_names) {
  const std::vector<Vector3d> body = {{0, 0, 0.95},      {0, 0, 1.5},       {0, 0.1, 0.9},  {0, -0.1, 0.9},
                                      {0, 0.1, 0.5},     {0, -0.1, 0.5},    {0, 0.1, 0.05}, {0, -0.1, 0.05},
                                      {0.15, 0.1, 0.02}, {0.15, -0.1, 0.02}};
  Motion motion;
  motion.format = "BVH";
  motion.rate_hz = 100.0;
  motion.frames = 2;
  for (std::size_t i = 0; i < body.size(); ++i) {
    motion.points.push_back({point_names[i], -1, std::vector<Vector3d>(2, file_axes * body[i] / unit_m), {}});
  }
  return motion;
}

const std::vector<std::string> kMixamo = {"mixamorig:Hips",        "mixamorig:Neck",      "mixamorig:LeftUpLeg",
                                          "mixamorig:RightUpLeg",  "mixamorig:LeftLeg",   "mixamorig:RightLeg",
                                          "mixamorig:LeftFoot",    "mixamorig:RightFoot", "mixamorig:LeftToeBase",
                                          "mixamorig:RightToeBase"};
const std::vector<std::string> kBiped = {"Bip01 Pelvis", "Bip01 Neck",   "Bip01 L Thigh", "Bip01 R Thigh",
                                         "Bip01 L Calf", "Bip01 R Calf", "Bip01 L Foot",  "Bip01 R Foot",
                                         "Bip01 L Toe0", "Bip01 R Toe0"};
const std::vector<std::string> kSmpl = {"pelvis",     "neck",       "left_hip",    "right_hip", "left_knee",
                                        "right_knee", "left_ankle", "right_ankle", "left_foot", "right_foot"};

TEST(Recordings, FindUnitAxesAndBodiesOfEverySkeleton) {
  Eigen::Matrix3d y_up, z_down;
  y_up << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  z_down << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  for (const auto& point_names : {kMixamo, kBiped, kSmpl}) {
    for (const double unit_m : {1.0, 0.01, 0.001, 0.0254, 0.0254 / 0.45}) {
      for (const Eigen::Matrix3d& axes : {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), y_up, z_down}) {
        const Recording recording = make_recording("x", standing(unit_m, axes, point_names), names());
        SCOPED_TRACE(fmt::format("{} {} {} {}", point_names[0], unit_m, recording.up, recording.unit_from));
        EXPECT_NEAR(recording.unit_m, unit_m, 1e-12);
        EXPECT_NEAR(recording.leg_length_m, 0.85, 1e-9);
        EXPECT_NEAR(
            recording.body(KeyBody::neck).position_m[0].z() - recording.body(KeyBody::left_toe).position_m[0].z(), 1.48,
            1e-9);
        EXPECT_TRUE(recording.notes.empty()) << recording.notes[0];
      }
    }
  }
}

TEST(Recordings, SayThatLeftAndRightAreExchanged) {
  std::vector<std::string> exchanged = kSmpl;
  for (std::size_t i = 2; i + 1 < exchanged.size(); i += 2) std::swap(exchanged[i], exchanged[i + 1]);
  const Recording recording = make_recording("x", standing(1.0, Eigen::Matrix3d::Identity(), exchanged), names());
  ASSERT_EQ(recording.notes.size(), 1U);
  EXPECT_NE(recording.notes[0].find("left and right are exchanged"), std::string::npos);
}

TEST(Recordings, TellOfAUnitThatMakesNoLeg) {
  Motion motion = standing(0.01, Eigen::Matrix3d::Identity(), kSmpl);
  motion.unit_m = 0.1;  // the file says dm and means cm
  const Recording recording = make_recording("x", std::move(motion), names());
  ASSERT_EQ(recording.notes.size(), 1U);
  EXPECT_NE(recording.notes[0].find("is the unit right?"), std::string::npos);
}

TEST(Recordings, TakeWhatTheUserKnows) {
  RecordingOptions options;
  options.unit_m = 0.02;
  options.up = "+x";
  options.rate_hz = 25.0;
  const Recording recording = make_recording("x", standing(0.01, Eigen::Matrix3d::Identity(), kSmpl), names(), options);
  EXPECT_NEAR(recording.unit_m, 0.02, 1e-12);
  EXPECT_EQ(recording.up, "+x");
  EXPECT_NEAR(recording.rate_hz, 25.0, 1e-12);
}

TEST(Recordings, BridgeAMarkersGapByAStraightLineAndSaySo) {
  const Recording recording = make_recording("x.trc", parse_trc("x.trc", test::small_trc()), names());
  const Body& heel = recording.body(KeyBody::left_heel);
  EXPECT_TRUE(((heel.position_m[0] + heel.position_m[2]) / 2.0).isApprox(heel.position_m[1], 1e-12));
  EXPECT_NE(recording.notes[0].find("left_heel was not seen in 1 of 3 frames"), std::string::npos);
}

TEST(Recordings, HoldAMarkersNearestPlaceBeforeAndAfterItWasSeen) {
  Motion motion = standing(1.0, Eigen::Matrix3d::Identity(), kSmpl);
  motion.frames = 4;
  const double none = std::numeric_limits<double>::quiet_NaN();
  for (Point& point : motion.points) point.position.resize(4, point.position[0]);
  motion.points[1].position = {Vector3d::Constant(none), Vector3d(0, 0, 1.5), Vector3d(0.2, 0, 1.5),
                               Vector3d::Constant(none)};
  const Recording recording = make_recording("x", motion, names());
  const auto& neck = recording.body(KeyBody::neck).position_m;
  EXPECT_EQ(neck[0], neck[1]);
  EXPECT_EQ(neck[3], neck[2]);
  ASSERT_EQ(recording.notes.size(), 1U);
  EXPECT_NE(recording.notes[0].find("neck was not seen in 2 of 4 frames, 0.01 s at a time"), std::string::npos);
}

TEST(Recordings, PlaceHipCentresByTheSpinesOfThePelvis) {
  Motion motion;
  motion.format = "TRC";
  motion.markers = true;
  motion.rate_hz = 100.0;
  motion.frames = 1;
  motion.unit_m = 0.001;
  motion.unit_name = "mm";
  // A pelvis of 150 mm depth and 240 mm width, x forward, z up.
  for (const auto& [name, x, y, z] :
       {std::tuple{"L.ASIS", 150.0, 120.0, 950.0}, std::tuple{"R.ASIS", 150.0, -120.0, 950.0},
        std::tuple{"L.PSIS", 0.0, 50.0, 950.0}, std::tuple{"R.PSIS", 0.0, -50.0, 950.0},
        std::tuple{"L.Ankle", 50.0, 100.0, 80.0}, std::tuple{"R.Ankle", 50.0, -100.0, 80.0}})
    motion.points.push_back({name, -1, {Vector3d(x, y, z)}, {}});
  const Recording recording = make_recording("x", motion, names());
  ASSERT_TRUE(recording.body(KeyBody::left_hip).known());
  // Harrington 2007 [mm]: 0.24 depth + 9.9 behind, 0.30 width + 10.9 below, 0.33 width + 7.3 beside.
  const Vector3d left = recording.body(KeyBody::left_hip).position_m[0],
                 right = recording.body(KeyBody::right_hip).position_m[0];
  EXPECT_TRUE(left.isApprox(Vector3d(0.150 - 0.0459, 0.0865, 0.950 - 0.0829), 1e-9)) << left.transpose();
  EXPECT_TRUE(right.isApprox(Vector3d(0.150 - 0.0459, -0.0865, 0.950 - 0.0829), 1e-9)) << right.transpose();
  EXPECT_TRUE(recording.body(KeyBody::pelvis).position_m[0].isApprox(Vector3d(0.075, 0.0, 0.950), 1e-9));
}

TEST(Recordings, OfUnknownNamesAreRefusedWithSomeOfThem) {
  Motion motion = standing(1.0, Eigen::Matrix3d::Identity(), kSmpl);
  for (std::size_t i = 0; i < motion.points.size(); ++i) motion.points[i].name = fmt::format("thing{}", i);
  try {
    make_recording("x.bvh", std::move(motion), names());
    FAIL();
  } catch (const files::ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("thing0"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace pmg::mocap
