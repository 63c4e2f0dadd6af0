// Another project's policy as the tick asks it.
#include "policy/velocity_policy.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>

#include "model/robots.hpp"
#include "policy/descriptor_file.hpp"
#include "refusal.hpp"

namespace pmg::policy {
namespace {

using test::DescriptorFile;
using test::z1;
using testing::HasSubstr;

class AForeignPolicy : public ::testing::Test {
 protected:
  AForeignPolicy() {
    state_.q = z1().q_stand();
    state_.dq = JointVector::Constant(z1().joint_index.size(), 0.3);
    state_.gyro_rad_s = {0.1, -0.2, 0.3};
    reference_.q = z1().q_stand();
    reference_.dq = JointVector::Zero(reference_.q.size());
  }
  JointVector act(VelocityPolicy& policy) {
    JointVector q_des;
    EXPECT_EQ(policy.act(state_, reference_, {}, q_des), Status::kOk);
    return q_des;
  }
  DescriptorFile file_;
  model::RobotState state_;
  Reference reference_;
};

TEST_F(AForeignPolicy, CommandsItsJointsAloneAroundItsOwnPosture) {
  VelocityPolicy policy(file_.file(), z1());
  const JointVector q_des = act(policy);
  const PolicyDescriptor& told = policy.descriptor();
  double largest = 0.0;
  for (std::size_t i = 0; i < told.joints.size(); ++i)
    largest = std::max(largest, std::abs(q_des[told.joints[i]] - told.default_rad[i]));
  EXPECT_GT(largest, 0.01) << "the network says something";
  for (int i = 0; i < z1().joint_index.size(); ++i) {
    if (z1().joints[static_cast<std::size_t>(i)].policy) continue;
    EXPECT_EQ(q_des[i], reference_.q[i]) << z1().joint_index.name(i);
    EXPECT_EQ(policy.stand_rad()[i], z1().q_stand()[i]) << z1().joint_index.name(i);
  }
  EXPECT_EQ(policy.stand_rad()[z1().joint_index.at("right_knee")], 0.4);
}

TEST_F(AForeignPolicy, HoldsItsTargetBetweenInferences) {
  VelocityPolicy policy(file_.file(), z1());  // 50 Hz in a loop of 100 Hz
  const JointVector first = act(policy);
  state_.q.array() += 0.1;
  EXPECT_EQ(act(policy), first);
  EXPECT_NE(act(policy), first);
}

TEST_F(AForeignPolicy, SeesItsLastActionOnlyIfItWasSent) {
  VelocityPolicy sent(file_.file(), z1()), unsent(file_.file(), z1()), fresh(file_.file(), z1());
  for (int k = 0; k < 2; ++k) {
    act(sent);
    act(unsent);
    unsent.unsent();
  }
  EXPECT_NE(act(sent), act(unsent));
  // Its state has not changed, so without a last action its frames are all alike: as at the beginning.
  unsent.unsent();
  EXPECT_EQ(act(unsent), act(fresh));
  sent.reset();
  EXPECT_EQ(act(sent), act(fresh));
}

TEST_F(AForeignPolicy, ClampsItsActions) {
  VelocityPolicy free(file_.file(), z1());
  const JointVector q_des = act(free);
  file_.append("action_limit: 0.001\n");
  VelocityPolicy bound(file_.file(), z1());
  const JointVector small = act(bound);
  for (std::size_t i = 0; i < bound.descriptor().joints.size(); ++i) {
    const int joint = bound.descriptor().joints[i];
    const double action = (small[joint] - bound.descriptor().default_rad[i]) / bound.descriptor().action_scale_rad[i];
    EXPECT_NEAR(std::abs(action), 0.001, 1e-6) << z1().joint_index.name(joint);
    EXPECT_GT(action * (q_des[joint] - bound.descriptor().default_rad[i]), 0.0) << z1().joint_index.name(joint);
  }
}

TEST_F(AForeignPolicy, AStateThatIsNoNumberGivesNoTarget) {
  VelocityPolicy policy(file_.file(), z1());
  state_.gyro_rad_s.x() = std::numeric_limits<double>::quiet_NaN();
  JointVector q_des;
  EXPECT_EQ(policy.act(state_, reference_, {}, q_des), Status::kNotFinite);
}

std::string policy_refusal(const DescriptorFile& file) {
  return test::refusal_by<std::invalid_argument>([&] { const VelocityPolicy policy(file.file(), z1()); });
}

TEST_F(AForeignPolicy, WhoseNetworkDoesNotFitItsDescriptorIsRefused) {
  file_.exchange("  - {term: command_angular, scale: [1]}\n", "");
  EXPECT_THAT(policy_refusal(file_),
              testing::AllOf(HasSubstr("foreign.onnx"), HasSubstr("expected single-precision [1, 263]")));
}

TEST_F(AForeignPolicy, ThatComputesOtherActionsThanItsGoldenPairsIsRefused) {
  VelocityPolicy policy(file_.file(), z1());
  std::string zeros = "0";
  for (int i = 1; i < 264; ++i) zeros += ",0";
  std::string actions;
  for (int i = 0; i < 12; ++i) actions += ",9";
  file_.append("golden: pairs.csv\ngolden_tolerance: 0.001\n");
  std::ofstream(file_.file().parent_path() / "pairs.csv") << zeros << actions << "\n";
  EXPECT_THAT(policy_refusal(file_), HasSubstr("golden pair 0, action 0"));
}

TEST_F(AForeignPolicy, IsRefusedWithoutItsNetwork) {
  file_.exchange("network: foreign.onnx", "network: absent.onnx");
  EXPECT_THAT(policy_refusal(file_), HasSubstr("absent.onnx"));
}

}  // namespace
}  // namespace pmg::policy
