#include <gtest/gtest.h>

#include "policy/policy.hpp"

namespace pmg::policy {
namespace {

TEST(ReferencePolicy, AsksForTheReferenceWhateverTheState) {
  Reference reference;
  reference.q = JointVector::LinSpaced(5, -1.0, 1.0);
  model::RobotState state;
  state.q = JointVector::Constant(5, 9.0);
  JointVector q_des;
  EXPECT_EQ(ReferencePolicy().act(state, reference, Command{}, q_des), Status::kOk);
  EXPECT_EQ(q_des, reference.q);
}

}  // namespace
}  // namespace pmg::policy
