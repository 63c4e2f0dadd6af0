// The gantry takes a robot up, sets it down, and steadies one that carries itself.
#include "sil/hoist.hpp"

#include <gtest/gtest.h>

#include "control/fixtures.hpp"

namespace pmg::sil {
namespace {

using test::kTick_s;

void run(Hoist& hoist, Support support, double seconds) {
  for (double t_s = 0.0; t_s < seconds; t_s += kTick_s) hoist.step(support, kTick_s);
}

TEST(Hoist, LiftsWithTightStrapsAndLetsGoOnTheGround) {
  Hoist hoist;
  run(hoist, Support::kLifted, 0.4);
  EXPECT_GT(hoist.engaged(), 0.5);
  EXPECT_EQ(hoist.lift_m(), 0.0) << "the straps are tightened first";
  run(hoist, Support::kLifted, 2.0);
  EXPECT_DOUBLE_EQ(hoist.lift_m(), Hoist::kLift_m);
  run(hoist, Support::kNone, 2.1);
  EXPECT_FALSE(hoist.carrying());
  EXPECT_EQ(hoist.engaged(), 0.0);
}

TEST(Hoist, ASteadiedRobotHasTightStrapsAndASlackRope) {
  Hoist hoist;
  run(hoist, Support::kLifted, 2.1);
  run(hoist, Support::kSteady, 1.4);
  EXPECT_GE(hoist.lift_m(), 0.0) << "set down before the rope gets slack";
  run(hoist, Support::kSteady, 2.3);
  EXPECT_EQ(hoist.engaged(), 1.0);
  EXPECT_DOUBLE_EQ(hoist.lift_m(), -Hoist::kSlack_m);
}

TEST(Hoist, TheRopeNeverJumps) {
  Hoist hoist;
  double before_m = 0.0;
  for (const Support support :
       {Support::kSteady, Support::kLifted, Support::kSteady, Support::kNone, Support::kLifted}) {
    for (int tick = 0; tick < 170; ++tick) {
      hoist.step(support, kTick_s);
      EXPECT_LT(std::abs(hoist.lift_m() - before_m), 0.005) << "half a metre a second at most";
      before_m = hoist.lift_m();
    }
  }
}

}  // namespace
}  // namespace pmg::sil
