// A damaged recording ends in one line or in figures, never in a crash: from the file's text to the closed cycle.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "files/config_error.hpp"
#include "mocap/activities.hpp"
#include "mocap/gait_cycle.hpp"
#include "synthetic_gait.hpp"
#include "written_bvh.hpp"

namespace pmg::mocap {
namespace {

/// Some numbers of the motion, or the time of a frame, become others, very large ones too.
std::string damaged(std::string text, std::mt19937& random) {
  const std::size_t motion = text.find("Frame Time: ") + 12;
  const auto below = [&random](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
  for (std::size_t i = 0, count = 1 + below(5); i < count; ++i) {
    const std::size_t at = text.find_first_of(" \n", motion + below(text.size() - motion - 20)) + 1;
    const std::size_t stop = std::min(text.find_first_of(" \n", at), text.size());
    const char* const kNumbers[] = {"1e300", "-1e308", "1e9", "9e5", "0", "-300", "1e-300"};
    text.replace(at, stop - at, kNumbers[below(std::size(kNumbers))]);
  }
  if (below(4) == 0) {
    const char* const kTimes[] = {"10", "1", "0.2", "0.0001"};
    text.replace(motion, text.find('\n', motion) - motion, kTimes[below(std::size(kTimes))]);
  }
  return text;
}

TEST(DamagedRecordings, EndInALineOrInFigures) {
  test::Walker walker;
  walker.rate_hz = 30.0;
  walker.cycles = 3;
  const std::string good = test::bvh_of(test::walk(walker));
  const NameTable names = read_name_table(default_name_table());
  std::mt19937 random(1);
  int refused = 0, walked = 0;
  for (int i = 0; i < 150; ++i) {
    try {
      const Recording recording = make_recording("x.bvh", parse_bvh("x.bvh", damaged(good, random)), names);
      const std::vector<Step> steps = find_steps(recording);
      for (const Activity& a : find_activities(recording, course_of(recording), steps)) {
        ASSERT_TRUE(std::isfinite(a.vx_m_s) && std::isfinite(a.yaw_rad) && std::isfinite(a.pitch_rad));
        ASSERT_LE(a.from_s, a.to_s);
      }
      const auto cycle = best_cycle(recording, steps, 0.0, 1e9);
      if (!cycle) continue;
      const ClosedCycle closed = close_cycle(human_angles(recording), *cycle);
      ASSERT_TRUE(std::isfinite(closed.moved_rad));
      ++walked;
    } catch (const files::ConfigError& error) {
      const std::string line = error.what();
      ASSERT_EQ(line.find('\n'), std::string::npos) << line;
      ++refused;
    }
  }
  EXPECT_GT(refused, 20);
  EXPECT_GT(walked, 20);
}

TEST(DamagedRecordings, APlaceFarAwayIsRefusedWithBodyAndFrame) {
  Recording good = test::walk({});
  good.bodies[static_cast<std::size_t>(KeyBody::left_toe)].position_m[6].x() = 1e200;
  try {
    make_recording("x.bvh", parse_bvh("x.bvh", test::bvh_of(good)), read_name_table(default_name_table()));
    FAIL();
  } catch (const files::ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("x.bvh: left_toe: is 1e+200 m away in frame 7"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace pmg::mocap
