// Zero points from poses that are computed rather than simulated: what is hidden is known exactly.
#include "zero/zero_calibration.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kdl/chaindynparam.hpp>
#include <nlohmann/json.hpp>

#include "sim/robots.hpp"
#include "zero/zero_results.hpp"
#include "zero/zero_stances.hpp"

namespace pmg::zero {
namespace {

using testing::Contains;
using testing::Each;
using testing::HasSubstr;
using testing::Not;

/// Deterministic offsets between 0.02 and 0.1 rad of either sign.
Eigen::VectorXd hidden_offsets(std::size_t joints) {
  std::mt19937_64 random(7);
  Eigen::VectorXd offset(static_cast<Eigen::Index>(joints));
  for (double& value : offset) value = (random() % 2 == 0 ? 1.0 : -1.0) * uniform(random, 0.02, 0.1);
  return offset;
}

/// Torques with which the legs carry half of the weight each, pressed so far in front of the middle of the sole.
JointVector carrying(const JointVector& q, const Eigen::Vector3d& gravity_B, double ahead_m = 0.0) {
  const model::RobotModel& robot = z1();
  JointVector torque = JointVector::Zero(q.size());
  model::LegKinematics legs(robot);
  const auto& feet = legs.compute(q, JointVector::Zero(q.size()));
  for (const Foot side : {kLeft, kRight}) {
    const auto& joints = robot.leg_joints[side];
    KDL::JntArray angles(static_cast<unsigned>(joints.size())), held(static_cast<unsigned>(joints.size()));
    for (unsigned i = 0; i < joints.size(); ++i) angles(i) = q[joints[i]];
    KDL::ChainDynParam(robot.leg_chain[side],
                       KDL::Vector(9.81 * gravity_B.x(), 9.81 * gravity_B.y(), 9.81 * gravity_B.z()))
        .JntToGravity(angles, held);
    Eigen::Vector3d sole_B = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& corner : feet[side].sole_B) sole_B += 0.25 * corner;
    sole_B += ahead_m * feet[side].R_BF.col(0);
    const Eigen::Vector3d force_B = -0.5 * 9.81 * robot.total_mass_kg * gravity_B;
    Eigen::Matrix<double, 6, 1> wrench_B;
    wrench_B << force_B, (sole_B - feet[side].p_BF).cross(force_B);
    const Eigen::VectorXd reaction = feet[side].J.transpose() * wrench_B;
    for (unsigned i = 0; i < joints.size(); ++i) torque[joints[i]] = held(i) - reaction[i];
  }
  return torque;
}

/// The robot in a stance, as its encoders show it.
StillPose seen(const ZeroStance& stance, const std::vector<int>& joints, const Eigen::VectorXd& offset) {
  StillPose pose;
  pose.log = stance.text;
  pose.to_s = 1.0;
  const JointVector q = posture(stance, z1());
  pose.gravity_I = -((Eigen::AngleAxisd(stance.pelvis_pitch_rad, Eigen::Vector3d::UnitY()) *
                      Eigen::AngleAxisd(stance.pelvis_roll_rad, Eigen::Vector3d::UnitX()))
                         .toRotationMatrix()
                         .transpose()
                         .col(2));
  pose.torque_Nm = carrying(q, pose.gravity_I);  // Z1's IMU is aligned with its pelvis
  pose.reading_rad = q;
  for (std::size_t i = 0; i < joints.size(); ++i) pose.reading_rad[joints[i]] += offset[static_cast<Eigen::Index>(i)];
  return pose;
}

std::vector<int> leg_joints() { return StandingConstraint(z1()).joints(); }

std::vector<StillPose> all_stances(const Eigen::VectorXd& offset) {
  std::vector<StillPose> poses;
  for (const ZeroStance& stance : reachable_stances(z1())) poses.push_back(seen(stance, leg_joints(), offset));
  return poses;
}

// 0.3 mrad: what the prior of 0.1 rad pulls the least observable of them towards zero.
constexpr double kPull_rad = 3e-4;

TEST(ZeroCalibration, FindsTheZeroPointOfEveryLegJoint) {
  const Eigen::VectorXd offset = hidden_offsets(leg_joints().size());
  const ZeroCalibration found = calibrate_zero(z1(), all_stances(offset));
  EXPECT_TRUE(found.converged);
  EXPECT_EQ(found.used(), found.poses.size());
  EXPECT_THAT(found.known, Each(Known::kWell));
  EXPECT_LT((found.z_rad + offset).cwiseAbs().maxCoeff(), kPull_rad) << (found.z_rad + offset).transpose();
}

TEST(ZeroCalibration, ConvergesAsThePaperSaysByDampedSteps) {
  const Eigen::VectorXd offset = hidden_offsets(leg_joints().size());
  ZeroOptions options;
  options.alpha = 0.25;
  options.M = 4;
  const ZeroCalibration found = calibrate_zero(z1(), all_stances(offset), options);
  ASSERT_GT(found.steps_rad.size(), 8U);
  EXPECT_NEAR(found.steps_rad.front(), 0.25 * offset.cwiseAbs().maxCoeff(), 2e-3) << "alpha of the whole miss";
  EXPECT_NEAR(found.steps_rad[3] / found.steps_rad[2], 0.75, 0.02);
  for (std::size_t k = found.steps_rad.size() - 4; k < found.steps_rad.size(); ++k)
    EXPECT_LT(found.steps_rad[k], options.epsilon_rad);
  EXPECT_GE(found.steps_rad[found.steps_rad.size() - 5], options.epsilon_rad);
}

TEST(ZeroCalibration, APoseWhoseImuIsntAlignedDoesntCount) {
  const Eigen::VectorXd offset = hidden_offsets(leg_joints().size());
  std::vector<StillPose> poses = all_stances(offset);
  poses[3].gravity_I = Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitY()) * poses[3].gravity_I;  // stood on a slope
  const ZeroCalibration found = calibrate_zero(z1(), poses);
  EXPECT_EQ(found.used(), poses.size() - 1);
  EXPECT_EQ(found.poses[3].why_not, "the IMU isn't aligned");
  EXPECT_LT((found.z_rad + offset).cwiseAbs().maxCoeff(), kPull_rad);
}

TEST(ZeroCalibration, ARobotInTheAirOrOnItsEdgesTellsNothing) {
  std::vector<StillPose> poses = all_stances(Eigen::VectorXd::Zero(12));
  poses[0].torque_Nm = JointVector::Zero(z1().joint_index.size());
  poses[1].torque_Nm = carrying(poses[1].reading_rad, poses[1].gravity_I, 0.108);  // 6 mm from the front edge
  const ZeroCalibration found = calibrate_zero(z1(), poses);
  EXPECT_EQ(found.poses[0].why_not, "doesn't stand on both soles");
  EXPECT_EQ(found.poses[1].why_not, "the left sole stands on its edge");
  EXPECT_EQ(found.used(), poses.size() - 2);
}

TEST(ZeroCalibration, SaysWhatStandingStillWithBothLegsAlikeCantTell) {
  std::vector<StillPose> poses;
  for (const double drop_m : {0.02, 0.06, 0.1}) {
    poses.push_back(seen({"both alike", drop_m, 0.0, 0.0, {}}, leg_joints(), Eigen::VectorXd::Zero(12)));
  }
  const ZeroCalibration found = calibrate_zero(z1(), poses);
  EXPECT_THAT(found.known, Not(Contains(Known::kWell)));
  ASSERT_FALSE(found.blind.empty());
  EXPECT_GT(found.blind.front().deviation_rad, 0.05) << "half of what was expected, or more, is left";
  EXPECT_LT(found.z_rad.cwiseAbs().maxCoeff(), 1e-3) << "what isn't seen isn't changed";
}

TEST(ZeroCalibration, AnImuThatSitsAskewWithinItsMountingDoesntHideInTheLegs) {
  const Eigen::VectorXd offset = hidden_offsets(leg_joints().size());
  std::vector<StillPose> poses = all_stances(offset);
  for (StillPose& pose : poses)
    pose.gravity_I = Eigen::AngleAxisd(0.001, Eigen::Vector3d(0.6, 0.8, 0.0)) * pose.gravity_I;
  const ZeroCalibration found = calibrate_zero(z1(), poses);
  // Its pitch is that of both hips: no pose can tell them apart, so up to 0.8 mrad of it may stay there.
  EXPECT_LT((found.z_rad + offset).cwiseAbs().maxCoeff(), 0.0012);
}

TEST(ZeroCalibration, WithoutAPoseThatStandsThereIsAMessage) {
  std::vector<StillPose> poses = all_stances(Eigen::VectorXd::Zero(12));
  for (StillPose& pose : poses) pose.torque_Nm.setZero();
  EXPECT_THROW(calibrate_zero(z1(), poses), std::invalid_argument);
  EXPECT_THROW(calibrate_zero(z1(), {}), std::invalid_argument);
}

ZeroResults results_of(const std::vector<StillPose>& poses, int most_questions = 1 << 30) {
  ZeroResults results{.robot = &z1(), .poses = &poses, .options = {}, .found = {}};
  int questions = 0;
  const work::Progress progress{.report = {}, .interrupted = [&] { return ++questions > most_questions; }};
  results.found = calibrate_zero(z1(), poses, results.options, progress);
  results.interrupted = questions > most_questions;
  return results;
}

/// The words that zero.yaml, zero.json and the page begin with.
void expect_everywhere(const ZeroResults& results, const std::string& word, work::Grade grade) {
  EXPECT_EQ(worth_of(results).grade(), grade) << worth_of(results).sentence();
  EXPECT_THAT(zero_remarks(results).front(), testing::StartsWith(word));
  EXPECT_EQ(zero_json(results)["worth"], work::name(grade));
  EXPECT_THAT(zero_report(results).html(), Not(HasSubstr("class=\"verdict good\"")));
}

TEST(ZeroWorth, GreenOnlyWhereTheIterationEndedAndThePosesAgree) {
  const Eigen::VectorXd offset = hidden_offsets(leg_joints().size());
  const std::vector<StillPose> poses = all_stances(offset);
  const ZeroResults whole = results_of(poses);
  EXPECT_EQ(worth_of(whole).sentence(), "");
  EXPECT_THAT(zero_report(whole).html(), HasSubstr("class=\"verdict good\""));
  expect_everywhere(results_of(poses, 1), "INTERRUPTED: ", work::Grade::kInterrupted);

  ZeroResults apart = whole;
  apart.found.weighted_rms = 1.1 * kMostWeightedRms;
  expect_everywhere(apart, "OFF ITS DATA: ", work::Grade::kOffItsData);
  apart = whole;
  apart.found.converged = false;
  expect_everywhere(apart, "MISSED: ", work::Grade::kMissed);
  apart = whole;
  apart.found.known.front() = Known::kNo;
  expect_everywhere(apart, "PARTIAL: ", work::Grade::kPartial);
}

// Fewer poses tell less. What they tell roughly is far nearer the truth than nothing, so it is applied, and said.
TEST(ZeroWorth, WhatIsKnownRoughlyIsAppliedAndSaid) {
  const Eigen::VectorXd offset = hidden_offsets(leg_joints().size());
  std::vector<StillPose> poses = all_stances(offset);
  poses.resize(5);
  const ZeroResults results = results_of(poses);
  ASSERT_THAT(results.found.known, Contains(Known::kRoughly)) << results.found.deviation_rad.transpose();
  const sim::ActuatorsByJoint applied = with_zero_offsets({}, results);
  const std::string page = zero_report(results).html();
  for (std::size_t i = 0; i < leg_joints().size(); ++i) {
    const auto place = static_cast<Eigen::Index>(i);
    const std::string& joint = z1().joint_index.name(leg_joints()[i]);
    ASSERT_EQ(applied.contains(joint), results.found.known[i] != Known::kNo) << joint;
    if (results.found.known[i] == Known::kNo) continue;
    EXPECT_NEAR(applied.at(joint).sensor.zero_offset_rad, offset[place], 3.0 * results.found.deviation_rad[place]);
  }
  EXPECT_THAT(page, HasSubstr("known roughly"));
  EXPECT_EQ(zero_json(results)["worth"], "partial");
  EXPECT_THAT(zero_remarks(results).front(), HasSubstr("are known roughly: one standard deviation is up to"));
}

// Such legs stand on no ground: poses are judged before they are used.
TEST(ZeroWorth, OfReadingsInDegreesOrOfNoiseThereAreNoZeroPoints) {
  for (const bool degrees : {true, false}) {
    std::mt19937_64 random(11);
    std::vector<StillPose> poses = all_stances(hidden_offsets(leg_joints().size()));
    for (StillPose& pose : poses) {
      for (double& reading_rad : pose.reading_rad)
        reading_rad = degrees ? reading_rad * 57.29578 : reading_rad + uniform(random, -0.15, 0.15);
    }
    EXPECT_THROW(results_of(poses), std::invalid_argument) << (degrees ? "degrees" : "noise");
  }
}

}  // namespace
}  // namespace pmg::zero
