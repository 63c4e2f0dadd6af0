// What is wrong with a file is said with its line or byte, and what was expected.
#include <gtest/gtest.h>

#include <functional>

#include "files/config_error.hpp"
#include "mocap_files/motion.hpp"
#include "small_files.hpp"

namespace pmg::mocap {
namespace {

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), with);
}

std::string refusal(const std::function<void()>& read) {
  try {
    read();
  } catch (const files::ConfigError& error) {
    return error.what();
  }
  return "no refusal";
}

std::string of_bvh(const std::string& text) {
  return refusal([&] { parse_bvh("x.bvh", text); });
}

TEST(BadFiles, BvhNamesLineAndWhatWasExpected) {
  EXPECT_EQ(of_bvh(replaced(test::small_bvh(), "Frames: 2", "Frames: two")),
            "x.bvh:27: is 'two'; expected the number of frames, 1 to 10000000");
  EXPECT_EQ(of_bvh(replaced(test::small_bvh(), "0 100 0", "0 1OO 0")),
            "x.bvh:29: is '1OO'; expected number 2 of the 15 of frame 1");
  EXPECT_EQ(of_bvh(replaced(test::small_bvh(), "Frames: 2", "Frames: 3")),
            "x.bvh:31: the file ends here; expected number 1 of the 15 of frame 3");
  EXPECT_EQ(of_bvh(replaced(test::small_bvh(), "Frames: 2", "Frames: 1")),
            "x.bvh:30: the file goes on; expected 1 frames of 15 numbers and then its end");
  EXPECT_NE(of_bvh(replaced(test::small_bvh(), "Xposition", "Wposition")).find("x.bvh:5: is an unknown channel"),
            std::string::npos);
}

TEST(BadFiles, AmcNamesTheBoneThatTheSkeletonLacks) {
  const std::string amc = replaced(test::small_amc(), "lfemur 0", "lfibula 0");
  EXPECT_EQ(refusal([&] { parse_asf_amc("x.asf", test::small_asf(), "x.amc", amc); }),
            "x.amc:6: 'lfibula' is no bone of x.asf; expected a bone's name");
}

TEST(BadFiles, TrcNamesTheMarkerWhoseCoordinateIsNoNumber) {
  const std::string text = replaced(test::small_trc(), "4.5", "4,5");
  EXPECT_EQ(refusal([&] { parse_trc("x.trc", text); }), "x.trc:8: is '4,5'; expected a coordinate of L.Toe");
}

TEST(BadFiles, C3dAndNpzNameTheByte) {
  std::string c3d = test::small_c3d(test::C3dProcessor::kIntel, -1.0F);
  c3d.resize(1024);
  EXPECT_EQ(refusal([&] { parse_c3d("x.c3d", c3d); }),
            "x.c3d: byte 1024: the file ends at byte 1024; expected the first frame");
  EXPECT_EQ(refusal([] { parse_c3d("x.c3d", "12"); }), "x.c3d: byte 1: is 0x32; expected 0x50, the mark of a C3D file");
  std::string npz = test::small_npz(false);
  npz[200] = static_cast<char>(npz[200] ^ 1);  // in the numbers of poses
  EXPECT_NE(refusal([&] { parse_amass("x.npz", npz, "", ""); }).find("does not fit its checksum"), std::string::npos);
}

TEST(BadFiles, ARootQuaternionOfAnotherLengthIsRefused) {
  const std::string text = replaced(test::robot_csv(), "0,0,0,1,", "0,0,0,2,");
  EXPECT_EQ(refusal([&] { parse_robot_csv("x.csv", text); }),
            "x.csv:2: the root's quaternion: has the length 2; expected 1");
}

TEST(BadFiles, AFileThatEndsTooSoonNamesTheLineThatIsMissing) {
  const std::string csv = test::robot_csv();
  EXPECT_EQ(refusal([&] { parse_robot_csv("x.csv", csv.substr(0, csv.find('\n') + 1)); }),
            "x.csv:2: has no frames; expected a row for each frame");
  EXPECT_EQ(refusal([] { parse_trc("x.trc", ""); }), "x.trc:1: the file ends here; expected PathFileType");
  EXPECT_EQ(refusal([&] { parse_robot_csv("x.csv", "\n" + replaced(csv, "root_qw", "knee")); }),
            "x.csv:2: qw: is missing; expected columns of the root's position x, y, z and quaternion qw, qx, qy, qz, "
            "then joints");
}

TEST(BadFiles, AnUnknownEndingNamesThoseThatAreRead) {
  EXPECT_NE(refusal([] {
              read_motion("walk.fbx");
            }).find("expected a file that ends in .bvh, .amc, .trc, .c3d, .npz or .csv"),
            std::string::npos);
}

}  // namespace
}  // namespace pmg::mocap
