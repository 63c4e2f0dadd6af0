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
/// the ends of their ranges [m/s]. The first turn, from rest, is left out: a height that rested at its upper end begins
/// to fall with its full rate, 0.15 m/s, where the knees are nearly straight; the squat's joints then start with 3.3
/// rad/s and take the base along, 0.13 of the 0.15 m/s by which u'x changes. The ground-aware optimisation reports that
/// motion as it is. Ticks in which a foot takes or loses weight
/// are left out: there u' jumps for every command.
double largest_jump_m_s(int ticks_each, double turn_s) {
  const model::RobotModel& robot = test::z1();
  GeneratorOptions options = generator_options(robot);
  options.turn_s = turn_s;
  MotionComposition motion(robot, model::load_clip_library(robot.directory / "clips", robot), Variant::kPmg, options);
  const Command high{robot.command_limits.upper}, low{robot.command_limits.lower};
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
  for (const int ticks : {1, 2}) {
    const double before_m_s = largest_jump_m_s(ticks, 0.0),
                 now_m_s = largest_jump_m_s(ticks, GeneratorOptions{}.turn_s);
    RecordProperty("jump_m_s_" + std::to_string(ticks), std::to_string(now_m_s));
    EXPECT_GT(before_m_s, 0.25) << "the command bites";
    // turn_s lets a rate change by dt / turn_s, a tenth of its limit, for each tick since the turn; a step of steady
    // walking changes u' by up to 0.02 m/s a tick.
    EXPECT_LT(now_m_s, 0.02 + 0.15 * ticks * before_m_s) << ticks << " ticks";
  }
}

}  // namespace
}  // namespace pmg::gco
