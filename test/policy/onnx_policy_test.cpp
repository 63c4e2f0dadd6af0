// A policy is checked before it is trusted: what doesn't fit the robot is refused and named.
// test/data/policies/linear.onnx is one random linear layer with the metadata of a trained policy
// (training/tests/make_linear_policy.py).
#include "policy/onnx_policy.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <limits>

#include "policy/observation.hpp"

namespace pmg::policy {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const model::RobotModel& z1() {
  static const model::RobotModel robot = model::load_robot(PMG_SOURCE_DIR "/config/robots/z1");
  return robot;
}

const fs::path kFile = PMG_SOURCE_DIR "/test/data/policies/linear.onnx";
const std::string kClips(64, '0');

model::RobotState standing() {
  model::RobotState state;
  state.q = z1().q_stand();
  state.dq = JointVector::Constant(z1().joint_index.size(), 0.3);
  state.gyro_rad_s = {0.1, -0.2, 0.3};
  return state;
}

Reference reference() {
  Reference reference;
  reference.q = z1().q_stand();
  reference.dq = JointVector::Zero(reference.q.size());
  return reference;
}

class OnnxPolicyFile : public testing::Test {
 protected:
  ~OnnxPolicyFile() override { fs::remove(copy_); }

  /// The file with one text in it exchanged for another of the same length, so that the protobuf around it stays whole.
  std::string refusal_after(const std::string& text, const std::string& instead) {
    EXPECT_EQ(text.size(), instead.size());
    std::ifstream in(kFile, std::ios::binary);
    std::string bytes(std::istreambuf_iterator<char>(in), {});
    const std::size_t at = bytes.find(text);
    EXPECT_NE(at, std::string::npos) << text;
    if (at != std::string::npos) bytes.replace(at, text.size(), instead);
    std::ofstream(copy_, std::ios::binary) << bytes;
    return refusal(copy_, kClips);
  }
  static std::string refusal(const fs::path& file, const std::string& clips, double rate_Hz = 100.0) {
    try {
      const OnnxPolicy policy(file, z1(), clips, rate_Hz);
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), HasSubstr(file.string()));
      return error.what();
    }
    return "was accepted";
  }

  fs::path copy_ = fs::temp_directory_path() / ("pmg_policy_test_" + std::to_string(getpid()) + ".onnx");
};

TEST_F(OnnxPolicyFile, WhatWasExportedForThisRobotIsAccepted) { EXPECT_EQ(refusal(kFile, kClips), "was accepted"); }

TEST_F(OnnxPolicyFile, WhatDoesNotFitTheRobotIsRefusedAndNamed) {
  EXPECT_THAT(refusal_after("\"robot\": \"z1\"", "\"robot\": \"z2\""), HasSubstr("its robot is z2"));
  EXPECT_THAT(refusal_after("\"variant\": \"pmg\"", "\"variant\": \"abc\""), HasSubstr("variant is abc"));
  EXPECT_THAT(refusal_after("\"left_knee\"", "\"left_kgee\""), HasSubstr("joints: number 3 is left_kgee"));
  EXPECT_THAT(refusal_after("\"action_joints\": [\"left_hip_pitch\"", "\"action_joints\": [\"left_hip_yitch\""),
              HasSubstr("action joints: number 0 is left_hip_yitch"));
  EXPECT_THAT(refusal_after("\"policy_rate_Hz\": 100", "\"policy_rate_Hz\": 050"), HasSubstr("metadata can't be read"));
  EXPECT_THAT(refusal_after("\"policy_rate_Hz\": 100", "\"policy_rate_Hz\": 200"), HasSubstr("rate in Hz is 200"));
  EXPECT_THAT(refusal_after("\"name\": \"gravity_direction\"", "\"name\": \"gravity_direktion\""),
              HasSubstr("observation term 1 is gravity_direktion"));
  EXPECT_THAT(refusal_after("\"format\": 1", "\"format\": 2"), HasSubstr("format is 2"));
  EXPECT_THAT(refusal_after("pmg_policy\x12", "pmg_polizy\x12"), HasSubstr("no metadata pmg_policy"));
  EXPECT_THAT(refusal(kFile, std::string(64, '1')), HasSubstr("clip library is 000"));
  EXPECT_THAT(refusal(kFile, kClips, 50.0), HasSubstr("rate in Hz is 100"));
}

TEST_F(OnnxPolicyFile, ANetworkThatGivesOtherActionsThanInTrainingIsRefused) {
  EXPECT_THAT(refusal_after("\"golden\": [{\"observation\": [0.", "\"golden\": [{\"observation\": [9."),
              HasSubstr("golden pair 0"));
}

TEST_F(OnnxPolicyFile, BytesThatAreNoNetworkAreRefused) {
  std::ofstream(copy_) << "no network";
  EXPECT_NE(refusal(copy_, kClips), "was accepted");
  EXPECT_NE(refusal("absent.onnx", kClips), "was accepted");
}

TEST(OnnxPolicy, AddsScaledActionsToTheReferenceOfItsJointsAlone) {
  OnnxPolicy policy(kFile, z1(), kClips);
  JointVector q_des;
  ASSERT_EQ(policy.act(standing(), reference(), Command{}, q_des), Status::kOk);
  const JointVector added = q_des - reference().q;
  for (int i = 0; i < z1().joint_index.size(); ++i) {
    const bool driven = z1().joints[static_cast<std::size_t>(i)].policy;
    EXPECT_EQ(added[i] != 0.0, driven) << z1().joint_index.name(i);
    EXPECT_LE(std::abs(added[i]), policy.metadata().action_scale * policy.metadata().action_limit);
  }
  EXPECT_EQ(policy.gains()->kp_Nm_per_rad.size(), z1().joint_index.size());
}

TEST(OnnxPolicy, SeesItsLastActionUntilItIsReset) {
  OnnxPolicy policy(kFile, z1(), kClips);
  JointVector first, second, anew;
  policy.act(standing(), reference(), Command{}, first);
  policy.act(standing(), reference(), Command{}, second);
  EXPECT_GT((second - first).cwiseAbs().maxCoeff(), 1e-6);
  policy.reset();
  policy.act(standing(), reference(), Command{}, anew);
  EXPECT_EQ(anew, first);
}

TEST(OnnxPolicy, AStateThatIsNoNumberGivesNoTarget) {
  OnnxPolicy policy(kFile, z1(), kClips);
  model::RobotState state = standing();
  state.dq[3] = std::numeric_limits<double>::quiet_NaN();
  JointVector q_des = reference().q;
  EXPECT_EQ(policy.act(state, reference(), Command{}, q_des), Status::kNotFinite);
  EXPECT_EQ(q_des, reference().q);
}

}  // namespace
}  // namespace pmg::policy
