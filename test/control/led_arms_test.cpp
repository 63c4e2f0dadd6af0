// The promises of a tick to whoever stands beside led arms: they move by their steps, and stay where they are when the
// operator's word ends.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "arms/arm_chain.hpp"
#include "control/control_rig.hpp"
#include "control/fixtures.hpp"
#include "generator_core/allocation_count.hpp"

namespace pmg::control {
namespace {

using arms::ArmActivity;
using test::kTick_s;

/// Of Z1's arms: the least of arms.speed_rad_s and every arm joint's own limit is their speed.
const double kStep_rad = kTick_s * arms::read_arm_setup(test::z1())->speed_rad_s;

class LedArmsTest : public testing::Test {
 protected:
  LedArmsTest() {
    const arms::ArmSetup setup = *arms::read_arm_setup(test::z1());
    for (const arms::PalmSetup& palm : setup.palm)
      joints_.insert(joints_.end(), palm.joints.begin(), palm.joints.end());
  }
  void walk() {
    driven_.request.mode = Mode::kWalk;
    driven_.run(3.0);
    ASSERT_EQ(result().mode, Mode::kWalk);
    driven_.asking = false;
  }
  /// Both palms so far forward and up from where they are [m].
  void aim(double forward_m, double up_m) {
    driven_.leading = true;
    for (const Foot arm : {kLeft, kRight}) {
      arms::PalmPose palm = result().arms.arm[arm].palm;
      palm.p_m += Eigen::Vector3d(forward_m, 0.0, up_m);
      driven_.arms.arm[arm] = {.wish = ArmWish::kAim, .palm = palm};
    }
  }
  void walk_and_reach() {
    walk();
    aim(0.10, 0.15);
    driven_.run(2.0);
    for (const Foot arm : {kLeft, kRight}) ASSERT_TRUE(result().arms.arm[arm].reached) << arm;
  }
  const TickResult& result() const { return driven_.tick.result(); }
  ArmActivity activity(Foot arm = kLeft) const { return result().arms.arm[arm].activity; }
  std::vector<double> arm_targets() const {
    std::vector<double> q;
    for (const int joint : joints_) q.push_back(result().command.q[joint]);
    return q;
  }
  /// Largest move of an arm joint's target in each of these ticks [rad].
  double largest_step(int ticks, bool speaking = true) {
    double largest = 0.0;
    std::vector<double> before = arm_targets();
    for (int k = 0; k < ticks; ++k) {
      driven_.step(speaking);
      const std::vector<double> now = arm_targets();
      for (std::size_t i = 0; i < now.size(); ++i) largest = std::max(largest, std::abs(now[i] - before[i]));
      before = now;
    }
    return largest;
  }

  test::DrivenTick driven_{test::z1()};
  std::vector<int> joints_;
};

TEST_F(LedArmsTest, WhereThePalmsAreIsToldInEveryMode) {
  const auto palm_is_at = [&](const JointVector& q) {
    arms::ArmChain chain(arms::read_arm_setup(test::z1())->palm[kLeft], arms::link_shapes(test::z1()));
    arms::ArmVector mine(static_cast<Eigen::Index>(chain.joints().size()));
    for (Eigen::Index i = 0; i < mine.size(); ++i) mine[i] = q[chain.joints()[static_cast<std::size_t>(i)]];
    chain.compute(mine);
    return (chain.palm().p_m - result().arms.arm[kLeft].palm.p_m).norm() < 1e-12;
  };
  driven_.state.q[joints_.front()] -= 0.5;
  driven_.step(false);
  EXPECT_TRUE(palm_is_at(driven_.state.q)) << "limp: as measured";
  walk();
  EXPECT_TRUE(palm_is_at(result().reference.q));
  aim(0.10, 0.15);
  driven_.run(1.0);
  EXPECT_TRUE(palm_is_at(result().reference.q));
}

TEST_F(LedArmsTest, PalmsGoToTheirTargetsWithinTheirStepsAndReportIt) {
  walk();
  EXPECT_TRUE(result().arms.there);
  EXPECT_EQ(activity(), ArmActivity::kReference);
  aim(0.10, 0.15);
  driven_.step();
  EXPECT_EQ(result().arms.order, ArmsOrder::kInForce);
  EXPECT_EQ(activity(), ArmActivity::kFollowing);
  EXPECT_FALSE(result().arms.arm[kLeft].reached) << "not at once";
  EXPECT_LE(largest_step(200), kStep_rad + 1e-12);
  for (const Foot arm : {kLeft, kRight}) {
    EXPECT_TRUE(result().arms.arm[arm].reached);
    EXPECT_LT((result().arms.arm[arm].palm.p_m - driven_.arms.arm[arm].palm.p_m).norm(), 0.005);
  }
}

TEST_F(LedArmsTest, ALeaseThatEndsHoldsTheArmsWhereTheyAre) {
  walk();
  aim(0.10, 0.15);
  driven_.arms.lease_s = 0.1;
  driven_.run(0.2);  // on the way
  ASSERT_FALSE(result().arms.arm[kLeft].reached);
  driven_.leading = false;
  driven_.run(0.12);
  EXPECT_EQ(result().mode, Mode::kWalk) << "the robot is driven on";
  EXPECT_EQ(result().arms.order, ArmsOrder::kLeaseOver);
  EXPECT_EQ(activity(), ArmActivity::kHeld);
  const std::vector<double> held = arm_targets();
  driven_.run(5.0);
  EXPECT_EQ(arm_targets(), held) << "it never returns by itself";
  driven_.leading = true;
  driven_.step();
  EXPECT_EQ(activity(), ArmActivity::kFollowing) << "and goes on when the operator is heard again";
  EXPECT_LE(largest_step(200), kStep_rad + 1e-12);
  EXPECT_TRUE(result().arms.arm[kLeft].reached);
}

TEST_F(LedArmsTest, AnotherSourcesTargetsChangeNothingAndAreCounted) {
  walk_and_reach();
  const std::vector<double> before = arm_targets();
  driven_.arms.source = Source::make("second", 1);
  driven_.arms.arm[kLeft].palm.p_m.z() -= 0.2;
  driven_.run(0.3);
  EXPECT_EQ(arm_targets(), before);
  EXPECT_EQ(result().arms.refused, 30);
  EXPECT_EQ(result().arms.refusal, CommandIntake::DriveVerdict::kOtherSourceDrives);
  EXPECT_EQ(result().ignored.other_source, 30);
}

TEST_F(LedArmsTest, OnlyWalkMovesThemAndStandKeepsThem) {
  driven_.request.mode = Mode::kStand;
  driven_.run(2.0);
  aim(0.10, 0.15);
  driven_.run(0.5);
  EXPECT_EQ(result().arms.order, ArmsOrder::kNotWalking);
  EXPECT_EQ(activity(), ArmActivity::kReference) << "a target that comes in Stand takes no arm over";
  driven_.leading = false;
  walk_and_reach();
  driven_.asking = true;
  driven_.request.mode = Mode::kStand;
  aim(-0.10, -0.10);
  EXPECT_LE(largest_step(300), kStep_rad + 1e-12);
  ASSERT_EQ(result().mode, Mode::kStand);
  EXPECT_EQ(activity(), ArmActivity::kHeld);
  const std::vector<double> held = arm_targets();
  driven_.run(1.0);
  EXPECT_EQ(arm_targets(), held);
}

TEST_F(LedArmsTest, ARobotThatBeginsToHangKeepsThemWithoutAJump) {
  walk_and_reach();
  const std::vector<double> reached = arm_targets();
  driven_.carried = {0.0, 0.0};
  for (int k = 0; k < 300 && !hanging(result().maker); ++k) EXPECT_LE(largest_step(1), kStep_rad + 1e-12);
  ASSERT_TRUE(hanging(result().maker));
  for (const Foot arm : {kLeft, kRight}) driven_.arms.arm[arm].wish = ArmWish::kHandBack;
  EXPECT_LE(largest_step(300), kStep_rad + 1e-12);
  EXPECT_EQ(activity(), ArmActivity::kHeld);
  const std::vector<double> now = arm_targets();
  for (std::size_t i = 0; i < now.size(); ++i) EXPECT_NEAR(now[i], reached[i], 1e-9) << i;
  driven_.carried = {0.5, 0.5};
  EXPECT_LE(largest_step(300), kStep_rad + 1e-12);
  EXPECT_FALSE(hanging(result().maker));
  ASSERT_EQ(result().mode, Mode::kStand);
  EXPECT_EQ(activity(), ArmActivity::kHeld);
}

TEST_F(LedArmsTest, HandedBackTheyReturnWithinTheirStepsAndTheReferenceMovesThemAgain) {
  walk_and_reach();
  for (const Foot arm : {kLeft, kRight}) driven_.arms.arm[arm].wish = ArmWish::kHandBack;
  driven_.step();
  EXPECT_EQ(activity(), ArmActivity::kReturning);
  EXPECT_LE(largest_step(400), kStep_rad + 1e-12);
  EXPECT_EQ(activity(), ArmActivity::kReference);
  EXPECT_EQ(activity(kRight), ArmActivity::kReference);
}

TEST_F(LedArmsTest, AStopDampsInItsTickWhateverTheArmsAreTold) {
  walk();
  aim(0.10, 0.15);
  driven_.run(0.1);
  driven_.asking = true;
  driven_.request.mode = Mode::kDamping;
  driven_.request.source = Source::make("bystander", 9);
  driven_.step();
  EXPECT_EQ(result().mode, Mode::kDamping);
  EXPECT_EQ(result().command.kp.sum(), 0.0);
  EXPECT_EQ(result().arms.order, ArmsOrder::kNotWalking);
  EXPECT_EQ(activity(), ArmActivity::kReference);
  driven_.run(0.5);
  EXPECT_EQ(result().mode, Mode::kDamping) << "arms' messages raise nobody";
}

TEST_F(LedArmsTest, StandIsEnteredAnewWithArmsThatTheReferenceMoves) {
  walk_and_reach();
  driven_.leading = false;
  driven_.asking = true;
  driven_.request.mode = Mode::kDamping;
  driven_.run(0.1);
  driven_.request.mode = Mode::kStand;
  driven_.step();
  ASSERT_EQ(result().mode, Mode::kStand);
  EXPECT_EQ(activity(), ArmActivity::kReference);
  EXPECT_LE(largest_step(300), 0.75 * kTick_s + 1e-9) << "by Stand's own ramp: 0.5 rad/s, 1.5 times that in its middle";
  for (const int joint : joints_) EXPECT_NEAR(result().command.q[joint], test::z1().q_stand()[joint], 1e-9);
}

TEST_F(LedArmsTest, ASitDownKeepsTheArmsWhereTheyAre) {
  for (const auto how : {test::BreakablePolicy::Break::kNone, test::BreakablePolicy::Break::kNotANumber}) {
    for (const double vx_m_s : {0.0, 0.4}) {
      test::DrivenTick driven(test::z1());
      driven.drive.command[kVx] = vx_m_s;
      driven.request.mode = Mode::kWalk;
      driven.run(4.0);
      driven.asking = false;
      driven.leading = true;
      for (const Foot arm : {kLeft, kRight}) {
        arms::PalmPose palm = driven.tick.result().arms.arm[arm].palm;
        palm.p_m += Eigen::Vector3d(0.10, 0.0, 0.15);
        driven.arms.arm[arm] = {.wish = ArmWish::kAim, .palm = palm};
      }
      driven.run(2.0);
      ASSERT_TRUE(driven.tick.result().arms.arm[kLeft].reached);
      JointVector before = driven.tick.result().command.q;
      if (how == test::BreakablePolicy::Break::kNone) {
        driven.state.temperature_degC[3] = 120.0;
      } else {
        driven.policy->how = how;
      }
      int sitting = 0;
      while (!sitting_down(driven.step().maker) && sitting < 50) ++sitting;
      ASSERT_TRUE(sitting_down(driven.tick.result().maker));
      for (sitting = 0; sitting_down(driven.tick.result().maker); ++sitting) {
        for (const int joint : joints_)
          ASSERT_LE(std::abs(driven.tick.result().command.q[joint] - before[joint]), kStep_rad + 1e-12) << sitting;
        EXPECT_EQ(driven.tick.result().arms.arm[kLeft].activity, ArmActivity::kHeld);
        before = driven.tick.result().command.q;
        driven.step();
      }
      EXPECT_GT(sitting, 50) << "half a second at the least";
      EXPECT_EQ(driven.tick.result().arms.arm[kLeft].activity, ArmActivity::kReference) << "damped";
    }
  }
}

TEST_F(LedArmsTest, TheirTicksTakeNoHeap) {
  walk();
  aim(0.10, 0.15);
  const long before = test::allocation_count();
  driven_.run(0.5);
  driven_.arms.arm[kLeft].wish = ArmWish::kHold;
  driven_.arms.arm[kRight].wish = ArmWish::kHandBack;
  driven_.run(0.5);
  driven_.arms.arm[kLeft].palm.p_m[0] = test::kNan;
  driven_.arms.arm[kLeft].wish = ArmWish::kAim;
  driven_.run(0.1);
  driven_.run(1.0, false);
  EXPECT_EQ(test::allocation_count(), before);
}

TEST(LedArms, ARobotWithoutArmsCountsWhatItIsTold) {
  test::DrivenTick driven(test::biped());
  driven.leading = true;
  driven.run(0.3);
  EXPECT_FALSE(driven.tick.result().arms.there);
  EXPECT_EQ(driven.tick.result().ignored.no_arms, 30);
}

TEST(LedArms, ATickWithoutMessagesIsTheSameWithAndWithoutArms) {
  const model::RobotModel& robot = test::z1();
  TickOptions without = tick_options(robot);
  without.arms.reset();
  test::ControlRig with_arms(robot), without_arms(robot, test::clips(robot), without);
  for (test::ControlRig* rig : {&with_arms, &without_arms}) {
    rig->drive.command[kVx] = 0.5;
    rig->reach_walk();
  }
  for (int k = 0; k < 500; ++k) {
    with_arms.cycle();
    without_arms.cycle();
    ASSERT_EQ(with_arms.bus.last_command.q, without_arms.bus.last_command.q) << "old logs must be replayed bit for bit";
  }
}

}  // namespace
}  // namespace pmg::control
