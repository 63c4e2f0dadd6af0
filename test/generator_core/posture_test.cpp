#include "pmg/posture.hpp"

#include <gtest/gtest.h>

#include "generator_core/synthetic_library.hpp"

namespace pmg::test {
namespace {

StaticClip two_rows() {  // no row at 0: the straight line gives 0.2 there, the robot stands at 0.1
  return {{-0.1, 0.2}, {JointVector::Constant(1, 0.0), JointVector::Constant(1, 0.6)}};
}

double offset(const PostureCurve& curve, double command) {
  JointVector q_s = JointVector::Zero(1);
  curve.add(command, q_s);
  return q_s[0];
}

TEST(PostureCurve, IsLinearBetweenRowsClampedOutsideAndZeroAtTheStand) {
  const PostureCurve curve(two_rows(), JointVector::Constant(1, 0.1));
  EXPECT_NEAR(offset(curve, 0.2), 0.5, 1e-15);
  EXPECT_NEAR(offset(curve, 0.1), 0.25, 1e-15);
  EXPECT_NEAR(offset(curve, -0.05), -0.05, 1e-15);
  EXPECT_NEAR(offset(curve, -0.1), -0.1, 1e-15);
  EXPECT_NEAR(offset(curve, 7.0), 0.5, 1e-15);
  EXPECT_NEAR(offset(curve, -7.0), -0.1, 1e-15);
  EXPECT_EQ(offset(curve, 0.0), 0.0);
  EXPECT_NEAR(offset(curve, 1e-9), 2.5e-9, 1e-15);
}

TEST(PostureCurve, RowAtZeroIsTheStandItself) {
  // 0.004 rad of measurement noise in row 0 does not change the stand.
  const StaticClip clip{
      {-0.1, 0.0, 0.2},
      {JointVector::Constant(1, 0.0), JointVector::Constant(1, 0.104), JointVector::Constant(1, 0.6)}};
  const PostureCurve curve(clip, JointVector::Constant(1, 0.1));
  EXPECT_NEAR(offset(curve, 0.2), 0.5, 1e-15);
  EXPECT_NEAR(offset(curve, -0.1), -0.1, 1e-15);
  EXPECT_NEAR(offset(curve, 1e-6), 2.5e-6, 1e-12);
}

TEST(PostureCurve, OneSidedAndEmptyClipsGiveNoOffsetWhereTheyHaveNoRows) {
  const StaticClip down{{-0.1, 0.0}, {JointVector::Constant(1, 0.0), JointVector::Constant(1, 0.1)}};
  EXPECT_EQ(offset(PostureCurve(down, JointVector::Constant(1, 0.1)), 0.3), 0.0);
  EXPECT_EQ(offset(PostureCurve(StaticClip{}, JointVector::Constant(1, 0.1)), 0.3), 0.0);
}

TEST(Posture, ChannelsAddUpOnTheStandAndOnTheGait) {
  const ClipLibrary library = make_library(31);
  const Command posture = make_command(0, 0, 0, 0.21, -0.11, -0.07);
  JointVector expected = JointVector::Zero(31);
  for (std::size_t i = 0; i < kPostureChannels; ++i) {
    PostureCurve(library.posture[i], library.q_stand).add(posture.u[kVelocityChannels + i], expected);
  }
  ASSERT_GT(expected.cwiseAbs().maxCoeff(), 0.05);
  Generator standing(library, make_options());
  EXPECT_LT((run(standing, posture, 3.0).q - library.q_stand - expected).cwiseAbs().maxCoeff(), 1e-12);

  Generator upright(library, make_options()), bent(library, make_options());
  Command walking = posture;
  walking[kVx] = 0.6;
  const JointVector difference = run(bent, walking, 3.0).q - run(upright, make_command(0.6, 0, 0), 3.0).q;
  EXPECT_LT((difference - expected).cwiseAbs().maxCoeff(), 1e-12);
}

}  // namespace
}  // namespace pmg::test
