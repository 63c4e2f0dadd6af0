// A policy is checked before use: one that doesn't fit the robot is refused with the reason.
#include "policy/onnx_policy.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <limits>

#include "model/robots.hpp"
#include "policy/linear_policy.hpp"
#include "policy/observation.hpp"
#include "refusal.hpp"

namespace pmg::policy {
namespace {

namespace fs = std::filesystem;
using test::LinearPolicyFile;
using testing::HasSubstr;

using test::z1;

const fs::path& kFile = test::kLinearPolicy;
const std::string& kClips = test::kNoClips;

model::RobotState standing() {
  model::RobotState state;
  state.q = z1().q_stand();
  state.dq = JointVector::Constant(z1().joint_index.size(), 0.3);
  state.gyro_rad_s = {0.1, -0.2, 0.3};
  return state;
}

Reference standing_reference() {
  Reference reference;
  reference.q = z1().q_stand();
  reference.dq = JointVector::Zero(reference.q.size());
  return reference;
}

/// The error of loading.
std::string refusal(const fs::path& file, const std::string& clips = kClips, double rate_Hz = 100.0) {
  const std::string text =
      test::refusal_by<std::invalid_argument>([&] { const OnnxPolicy policy(file, z1(), clips, rate_Hz); });
  EXPECT_THAT(text, testing::AnyOf("taken", HasSubstr(file.string())));
  EXPECT_THAT(text, testing::Not(HasSubstr("\n"))) << "one line";
  return text;
}

std::string refusal_after(const std::string& text, const std::string& instead) {
  LinearPolicyFile policy;
  policy.exchange(text, instead);
  return refusal(policy.file());
}

TEST(OnnxPolicyFile, WhatWasExportedForThisRobotIsAccepted) { EXPECT_EQ(refusal(kFile), "taken"); }

TEST(OnnxPolicyFile, WhatDoesNotFitTheRobotIsRefusedAndNamed) {
  EXPECT_THAT(refusal_after("\"robot\": \"z1\"", "\"robot\": \"z2\""), HasSubstr("its robot is z2"));
  EXPECT_THAT(refusal_after("\"variant\": \"pmg\"", "\"variant\": \"abc\""),
              HasSubstr("variant is abc; this controller has pmg, without_gco, single_gait"));
  EXPECT_THAT(refusal_after("\"left_knee\"", "\"left_kgee\""), HasSubstr("joints: number 3 is left_kgee"));
  EXPECT_THAT(refusal_after("\"action_joints\": [\"left_hip_pitch\"", "\"action_joints\": [\"left_hip_yitch\""),
              HasSubstr("action joints: number 0 is left_hip_yitch"));
  EXPECT_THAT(refusal_after("\"policy_rate_Hz\": 100", "\"policy_rate_Hz\": 050"), HasSubstr("metadata can't be read"));
  EXPECT_THAT(refusal_after("\"policy_rate_Hz\": 100", "\"policy_rate_Hz\": 200"), HasSubstr("rate in Hz is 200"));
  EXPECT_THAT(refusal_after("\"name\": \"gravity_direction\"", "\"name\": \"gravity_direktion\""),
              HasSubstr("observation term 1 is gravity_direktion"));
  EXPECT_THAT(refusal_after("\"format\": 1", "\"format\": 2"), HasSubstr("format is 2"));
  EXPECT_THAT(refusal_after("pmg_policy\x12", "pmg_polizy\x12"), HasSubstr("no metadata pmg_policy"));
  EXPECT_THAT(refusal(kFile, std::string(64, '1')),
              testing::AllOf(HasSubstr("leave --clips out"), HasSubstr("clip library is 000")))
      << "what to do, then the numbers";
  EXPECT_THAT(refusal(kFile, kClips, 50.0), HasSubstr("rate in Hz is 100"));
}

TEST(OnnxPolicyFile, ANetworkThatGivesOtherActionsThanInTrainingIsRefused) {
  EXPECT_THAT(refusal_after("\"golden\": [{\"observation\": [0.", "\"golden\": [{\"observation\": [9."),
              HasSubstr("golden pair 0"));
}

// The tolerance is 1e-4: float32 actions of order one differ by 1e-6 between two machines.
TEST(OnnxPolicyFile, AnActionThatDiffersByTwiceTheToleranceIsRefusedAndByHalfIsNot) {
  const std::string trained = "\"action\": [-0.336349";
  EXPECT_THAT(refusal_after(trained, "\"action\": [-0.336549"), HasSubstr("golden pair 0"));
  EXPECT_EQ(refusal_after(trained, "\"action\": [-0.336399"), "taken");
}

TEST(OnnxPolicyFile, ANetworkWhoseWeightsAreNoNumbersIsRefused) {
  const std::string weights = "w0J";  // name, then raw data with its length in two bytes
  LinearPolicyFile policy;
  const std::string broken = policy.text_at(weights, weights.size() + 2 + sizeof(float));
  const std::string quiet_nan = {'\x00', '\x00', '\xC0', '\x7F'};
  policy.exchange(broken, broken.substr(0, weights.size() + 2) + quiet_nan);
  EXPECT_THAT(refusal(policy.file()), HasSubstr("the network gives nan"));
}

TEST(OnnxPolicyFile, ANetworkOfAnotherSizeIsRefused) {
  // Protocol buffers: the output's dimensions 1 and 12, the input's 1 and 264.
  EXPECT_NE(refusal_after("action\x12\x0e\n\x0c\x08\x01\x12\x08\n\x02\x08\x01\n\x02\x08\x0c",
                          "action\x12\x0e\n\x0c\x08\x01\x12\x08\n\x02\x08\x01\n\x02\x08\x0b"),
            "taken");
  EXPECT_NE(refusal_after("\n\x02\x08\x01\n\x03\x08\x88\x02", "\n\x02\x08\x01\n\x03\x08\x89\x02"), "taken");
}

TEST(OnnxPolicyFile, BytesThatAreNoNetworkAreRefused) {
  const LinearPolicyFile policy;
  std::ofstream(policy.file()) << "no network";
  EXPECT_NE(refusal(policy.file()), "taken");
  EXPECT_NE(refusal("absent.onnx"), "taken");
}

TEST(OnnxPolicyFile, AFileOrMetadataAboveItsBoundIsNotRead) {
  const LinearPolicyFile giant;
  fs::resize_file(giant.file(), std::uintmax_t{1} << 34);  // 16 GiB that the disk doesn't hold
  EXPECT_THAT(refusal(giant.file()), HasSubstr("has 1.64e+04 MiB; expected an ONNX policy of 32 MiB at most"));
  LinearPolicyFile wordy;
  wordy.exchange("pmg_policy\x12", "pmg_polizy\x12");
  wordy.append_metadata("pmg_policy", std::string((4 << 20) + 1, ' '));
  EXPECT_THAT(refusal(wordy.file()), HasSubstr("has 4194305 bytes; expected 4194304 at most"));
}

TEST(OnnxPolicyFile, WhatIsMissingOrNoNumberIsNamed) {
  EXPECT_THAT(refusal_after("\"action_limit\"", "\"aktion_limit\""), HasSubstr("action_limit"));
  EXPECT_THAT(refusal_after("\"action_limit\": 4.0", "\"action_limit\": 0.0"), HasSubstr("action_limit is 0"));
  EXPECT_THAT(refusal_after("\"action_limit\": 4.0", "\"action_limit\": -1 "), HasSubstr("action_limit is -1"));
  EXPECT_THAT(refusal_after("\"action_limit\": 4.0", "\"action_limit\": 9.0"), HasSubstr("half a turn: no bound"));
  EXPECT_THAT(refusal_after("\"action_limit\": 4.0", "\"action_limit\": 1e9"), HasSubstr("half a turn: no bound"));
  EXPECT_THAT(refusal_after("\"action_limit\": 4.0", "\"action_limit\": NaN"), HasSubstr("metadata can't be read"));
  EXPECT_THAT(refusal_after("\"action_scale\": 0.", "\"action_scale\": -0"), HasSubstr("metadata can't be read"));
  EXPECT_THAT(refusal_after("\"action_scale\": 0", "\"action_scale\":-1"), HasSubstr("action_scale is -1"));
  EXPECT_THAT(refusal_after("\"variant\"", "\"variamt\""), HasSubstr("variant"));
  EXPECT_THAT(refusal_after("\"golden\"", "\"silver\""), HasSubstr("golden"));
  EXPECT_THAT(refusal_after("\"kp_Nm_per_rad\": [180.0, ", "\"kp_Nm_per_rad\": [10, 2, "), HasSubstr("kp_Nm_per_rad"));
}

TEST(OnnxPolicyFile, APostureOtherThanTrainingsIsNamed) {
  EXPECT_THAT(refusal_after("\"stand_rad\": [-0.07", "\"stand_rad\": [-0.08"),
              HasSubstr("trained to stand with left_hip_pitch at -0.08 rad"));
}

TEST(OnnxPolicyFile, GoldenPairsMustBeThereAndProveSomething) {
  EXPECT_THAT(refusal_after("\"golden\": [{\"observation\": [", "\"golden\": [], \"g\": [{\"g\": [ "),
              HasSubstr("no golden pair"));
  EXPECT_THAT(refusal_after("\"golden_tolerance\": 0.0001", "\"golden_tolerance\": 1.0000"),
              HasSubstr("golden_tolerance is 1"));
  EXPECT_THAT(refusal_after("\"golden_tolerance\": 0.0001", "\"golden_tolerance\": 0.0000"),
              HasSubstr("golden_tolerance is 0"));
}

/// The variant, and with it the observed command, comes from the file alone.
TEST(OnnxPolicyFile, SaysWhichVariantItIs) {
  for (const Variant variant : {Variant::kPmg, Variant::kWithoutGco, Variant::kSingleGait}) {
    const fs::path clips = z1().directory / "clips";
    const LinearPolicyFile file(clips, variant);
    const OnnxPolicy policy(file.file(), z1(), model::clip_library_sha256(clips));
    EXPECT_EQ(policy.variant(), variant);
    EXPECT_EQ(policy.metadata().variant, variant);
  }
}

TEST(OnnxPolicy, AddsScaledActionsToTheReferenceOfItsJointsAlone) {
  OnnxPolicy policy(kFile, z1(), kClips);
  JointVector q_des;
  ASSERT_EQ(policy.act(standing(), standing_reference(), Command{}, q_des), Status::kOk);
  const JointVector added = q_des - standing_reference().q;
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
  policy.act(standing(), standing_reference(), Command{}, first);
  policy.act(standing(), standing_reference(), Command{}, second);
  EXPECT_GT((second - first).cwiseAbs().maxCoeff(), 1e-6);
  policy.reset();
  policy.act(standing(), standing_reference(), Command{}, anew);
  EXPECT_EQ(anew, first);
}

TEST(OnnxPolicy, AStateThatIsNoNumberGivesNoTarget) {
  OnnxPolicy policy(kFile, z1(), kClips);
  model::RobotState state = standing();
  state.dq[3] = std::numeric_limits<double>::quiet_NaN();
  JointVector q_des = standing_reference().q;
  EXPECT_EQ(policy.act(state, standing_reference(), Command{}, q_des), Status::kNotFinite);
  EXPECT_EQ(q_des, standing_reference().q);
}

}  // namespace
}  // namespace pmg::policy
