// Take-over, hold and hand-back.
#include "arms/arm_world.hpp"
#include "generator_core/allocation_count.hpp"

namespace pmg::test {
namespace {

class BothArms : public testing::Test {
 protected:
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      const JointVector before = q_;
      q_ = z1().q_stand();
      dq_.setZero(q_.size());
      arms_.step(q_, dq_);
      largest_step_ = std::max(largest_step_, (q_ - before).cwiseAbs().maxCoeff());
    }
  }
  arms::PalmPose ahead(Foot side) const {
    arms::PalmPose pose = palm_pose(z1().q_stand(), side);
    pose.p_m += Eigen::Vector3d(0.2, 0.0, 0.15);
    return pose;
  }
  arms::Arms arms_{z1(), z1_arms(), kTick_s};
  JointVector q_ = z1().q_stand(), dq_ = JointVector::Zero(q_.size());
  double largest_step_ = 0.0;
};

TEST_F(BothArms, LeaveTheReferenceAloneUntilTheyAreAimed) {
  run(10);
  EXPECT_EQ(q_, z1().q_stand());
  arms_.hold(kLeft);
  arms_.hand_back(kRight);
  run(10);
  EXPECT_EQ(q_, z1().q_stand());
  EXPECT_FALSE(arms_.active());
}

TEST_F(BothArms, GoToTheirTargetsAndOneAloneLeavesTheOtherAlone) {
  arms_.aim(kLeft, ahead(kLeft));
  run(200);
  EXPECT_EQ(arms_.report(kLeft).activity, arms::ArmActivity::kFollowing);
  EXPECT_LT((palm_pose(q_, kLeft).p_m - ahead(kLeft).p_m).norm(), 0.001);
  for (const int joint : arms_.joints(kRight)) EXPECT_EQ(q_[joint], z1().q_stand()[joint]);
}

TEST_F(BothArms, LeaveWhereTheyAreTowardsTheirTargetNoFasterThanTheFilter) {
  arms_.aim(kLeft, ahead(kLeft));
  double before_m = (palm_pose(q_, kLeft).p_m - ahead(kLeft).p_m).norm();
  for (int tick = 0; tick < 30; ++tick) {
    run(1);
    const double now_m = (palm_pose(q_, kLeft).p_m - ahead(kLeft).p_m).norm();
    EXPECT_LT(now_m, before_m);
    EXPECT_GT(now_m, before_m - 1.5 * arms::PoseFilterOptions{}.speed_m_s * kTick_s);  // half as much to catch up
    before_m = now_m;
  }
}

TEST_F(BothArms, HoldWhereTheyAreInMidWay) {
  arms_.aim(kLeft, ahead(kLeft));
  run(10);
  const JointVector there = q_;
  arms_.hold(kLeft);
  run(100);
  EXPECT_EQ(q_, there);
  EXPECT_EQ(arms_.report(kLeft).activity, arms::ArmActivity::kHeld);
  EXPECT_EQ(dq_.cwiseAbs().maxCoeff(), 0.0);
}

TEST_F(BothArms, ReturnToTheReferenceWithoutAJump) {
  for (const Foot side : {kLeft, kRight}) arms_.aim(side, ahead(side));
  run(200);
  for (const Foot side : {kLeft, kRight}) arms_.hand_back(side);
  run(1);
  EXPECT_EQ(arms_.report(kLeft).activity, arms::ArmActivity::kReturning);
  run(200);
  EXPECT_FALSE(arms_.active());
  EXPECT_EQ(q_, z1().q_stand());
  EXPECT_LE(largest_step_, z1_arms().speed_rad_s * kTick_s + 1e-9);
}

TEST_F(BothArms, UseNoHeapInATick) {
  for (const Foot side : {kLeft, kRight}) arms_.aim(side, ahead(side));
  const long before = allocation_count();
  run(100);
  EXPECT_EQ(allocation_count(), before);
}

}  // namespace
}  // namespace pmg::test
