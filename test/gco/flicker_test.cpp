// A command that flickers reaches the policy smoothed: the bound on u' from one tick to the next.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "gco/motion_composition.hpp"
#include "model/clip_library_file.hpp"
#include "model/robots.hpp"

namespace pmg::gco {
namespace {

constexpr double kDt_s = 0.01;
constexpr int kBegin = 200;  // ticks of steady walking

/// Largest change of u'x from one tick to the next over eight seconds of walking, while all channels alternate between
/// the ends of their ranges, height between highest_m and its lower end [m/s]. The first turn, from rest, is left out:
/// so much begins at once. Ticks in which a foot takes or loses weight are left out: there u' jumps for every command.
double largest_jump_m_s(int ticks_each, double turn_s, double highest_m) {
  const model::RobotModel& robot = test::z1();
  GeneratorOptions options = generator_options(robot);
  options.turn_s = turn_s;
  MotionComposition motion(robot, model::load_clip_library(robot.directory / "clips", robot), Variant::kPmg, options);
  Command high{robot.command_limits.upper}, low{robot.command_limits.lower};
  high[kHeight] = highest_m;
  double previous_m_s = 0.0, most_m_s = 0.0;
  PerFoot<double> weight{};
  for (int k = 0; k < 1000; ++k) {
    const bool up = k < kBegin || (k / ticks_each) % 2 == 0;
    const Reference& reference = motion.advance(up ? high : low, kDt_s);
    const bool same_feet = reference.contact_weight == weight;
    weight = reference.contact_weight;
    const double now_m_s = motion.ground().command[kVx];
    if (k > kBegin + 30 && same_feet) most_m_s = std::max(most_m_s, std::abs(now_m_s - previous_m_s));
    previous_m_s = now_m_s;
  }
  return most_m_s;
}

TEST(Flicker, OfTheCommandHardlyReachesTheObservedCommand) {
  constexpr double kBentKnees_m = -0.03;
  for (const int ticks : {1, 2}) {
    const double before_m_s = largest_jump_m_s(ticks, 0.0, kBentKnees_m),
                 now_m_s = largest_jump_m_s(ticks, GeneratorOptions{}.turn_s, kBentKnees_m);
    RecordProperty("jump_m_s_" + std::to_string(ticks), std::to_string(now_m_s));
    EXPECT_GT(before_m_s, 0.20) << "the command bites";
    // turn_s lets a rate change by dt / turn_s, a tenth of its limit, for each tick since the turn; a step of steady
    // walking changes u' by up to 0.02 m/s a tick.
    EXPECT_LT(now_m_s, 0.02 + 0.15 * ticks * before_m_s) << ticks << " ticks";
  }
}

// Where the knees are nearly straight, a height of 0.15 mm is 5 mrad of knee, and the base goes along.
TEST(Flicker, OfAHeightAtItsUpperEndReachesTheObservedCommandNoMoreThanThat) {
  for (const int ticks : {1, 2}) {
    const double now_m_s = largest_jump_m_s(ticks, GeneratorOptions{}.turn_s, test::z1().command_limits.upper[kHeight]);
    RecordProperty("jump_m_s_" + std::to_string(ticks), std::to_string(now_m_s));
    EXPECT_LT(now_m_s, 0.10) << ticks << " ticks";
  }
}

}  // namespace
}  // namespace pmg::gco
