// Damaged files end in one line, never in a crash: seeded mutations of the small files, through each reader and the
// recording made from it. `scripts/test asan` runs them under AddressSanitizer.
#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <regex>

#include "files/config_error.hpp"
#include "mocap_files/recording.hpp"
#include "small_files.hpp"

namespace pmg::mocap {
namespace {

/// One to four damages: a byte replaced, a stretch taken out, doubled or cut off, a number made huge.
std::string damaged(std::string bytes, std::mt19937& random) {
  const auto below = [&random](std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n > 0 ? n - 1 : 0)(random);
  };
  for (std::size_t i = 0, count = 1 + below(4); i < count && !bytes.empty(); ++i) {
    const std::size_t at = below(bytes.size()), length = below(std::min<std::size_t>(bytes.size() - at, 40) + 1);
    switch (below(6)) {
      case 0:
        bytes[at] = static_cast<char>(below(256));
        break;
      case 1:
        bytes[at] = static_cast<char>(bytes[at] ^ 1 << below(8));
        break;
      case 2:
        bytes.erase(at, length);
        break;
      case 3:
        bytes.insert(at, bytes.substr(at, length));
        break;
      case 4:
        bytes.resize(at);
        break;
      default:
        bytes.replace(at, length, below(2) == 0 ? "99999999999" : "-1e308");
        break;
    }
  }
  return bytes;
}

/// "FILE:LINE: ...", "FILE: byte N: ..."; what a file lacks as a whole has the name of that in place of a line.
void expect_place(const std::string& message) {
  static const std::regex kPlace(R"((x|rest)\.[a-z0-9]+(:[1-9][0-9]*(:[1-9][0-9]*)?|: byte [0-9]+|: [a-z0-9_]+): .*)");
  ASSERT_TRUE(std::regex_match(message, kPlace)) << message;
}

/// Every outcome is a motion or one line of text, which says where.
void fuzz(const std::string& good, const std::function<Motion(const std::string&)>& read, unsigned seed) {
  SCOPED_TRACE(fmt::format("seed {}", seed));
  const NameTable names = read_name_table(default_name_table());
  std::mt19937 random(seed);
  int refused = 0;
  for (int i = 0; i < 4000; ++i) {
    const std::string bytes = damaged(good, random);
    bool parsed = false;
    try {
      const Motion motion = read(bytes);
      parsed = true;
      for (const Point& point : motion.points) {
        ASSERT_EQ(point.position.size(), motion.frames);
        ASSERT_LT(point.parent, static_cast<int>(motion.points.size()));
      }
      const Recording recording = make_recording("damaged", motion, names);
      ASSERT_EQ(recording.frames, motion.frames);
    } catch (const files::ConfigError& error) {
      const std::string line = error.what();
      ASSERT_EQ(line.find('\n'), std::string::npos) << line;
      ASSERT_NE(line.find("; expected "), std::string::npos) << line;
      if (!parsed) expect_place(line);
      if (::testing::Test::HasFatalFailure()) return;
      ++refused;
    }
  }
  EXPECT_GT(refused, 200);  // else the damage does no harm and the test shows nothing
}

TEST(DamagedFiles, BvhEndsInALine) {
  fuzz(
      test::small_bvh(), [](const std::string& text) { return parse_bvh("x.bvh", text); }, 1);
}
TEST(DamagedFiles, AsfAndAmcEndInALine) {
  fuzz(
      test::small_asf(),
      [](const std::string& text) { return parse_asf_amc("x.asf", text, "x.amc", test::small_amc()); }, 2);
  fuzz(
      test::small_amc(),
      [](const std::string& text) { return parse_asf_amc("x.asf", test::small_asf(), "x.amc", text); }, 3);
}
TEST(DamagedFiles, TrcEndsInALine) {
  fuzz(
      test::small_trc(), [](const std::string& text) { return parse_trc("x.trc", text); }, 4);
}
TEST(DamagedFiles, C3dEndsInALine) {
  fuzz(
      test::small_c3d(test::C3dProcessor::kIntel, -1.0F),
      [](const std::string& bytes) { return parse_c3d("x.c3d", bytes); }, 5);
  fuzz(
      test::small_c3d(test::C3dProcessor::kMips, 0.1F),
      [](const std::string& bytes) { return parse_c3d("x.c3d", bytes); }, 6);
}
TEST(DamagedFiles, NpzEndsInALine) {
  for (const bool deflated : {true, false}) {
    fuzz(
        test::small_npz(deflated),
        [](const std::string& bytes) { return parse_amass("x.npz", bytes, "rest.csv", test::small_rest_pose()); }, 7);
  }
  fuzz(
      test::small_rest_pose(),
      [](const std::string& text) { return parse_amass("x.npz", test::small_npz(true), "rest.csv", text); }, 8);
}
TEST(DamagedFiles, RobotCsvEndsInALine) {
  fuzz(
      test::robot_csv(), [](const std::string& text) { return parse_robot_csv("x.csv", text); }, 9);
}

}  // namespace
}  // namespace pmg::mocap
