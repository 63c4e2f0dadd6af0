#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <random>

#include "generator_core/allocation_count.hpp"
#include "model/leg_kinematics.hpp"
#include "model/robot_model.hpp"
#include "model/robots.hpp"

namespace pmg::model {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

using test::kBipedFolder;
using test::kZ1Folder;

Matrix3d Rx(double angle) { return Eigen::AngleAxisd(angle, Vector3d::UnitX()).toRotationMatrix(); }
Matrix3d Ry(double angle) { return Eigen::AngleAxisd(angle, Vector3d::UnitY()).toRotationMatrix(); }
Matrix3d Rz(double angle) { return Eigen::AngleAxisd(angle, Vector3d::UnitZ()).toRotationMatrix(); }

Matrix3d exponential(const Vector3d& v) {
  return v.norm() > 0.0 ? Eigen::AngleAxisd(v.norm(), v.normalized()).toRotationMatrix() : Matrix3d::Identity();
}
Vector3d logarithm(const Matrix3d& R) {
  const Eigen::AngleAxisd turn(R);
  return turn.angle() * turn.axis();
}

struct Motion {
  JointVector q, dq;
};

Motion random_motion(const RobotModel& robot, std::mt19937& random) {
  Motion motion{robot.q_stand(), robot.q_stand()};
  std::uniform_real_distribution<double> rate(-3.0, 3.0);
  for (Eigen::Index i = 0; i < motion.q.size(); ++i) {
    const Joint& joint = robot.joints[static_cast<std::size_t>(i)];
    motion.q[i] = std::uniform_real_distribution<double>(joint.lower_rad, joint.upper_rad)(random);
    motion.dq[i] = rate(random);
  }
  return motion;
}

class EveryRobotsKinematics : public ::testing::TestWithParam<std::string> {
 protected:
  RobotModel robot_ = load_robot(GetParam());
  std::mt19937 random_{11};
};
INSTANTIATE_TEST_SUITE_P(Robots, EveryRobotsKinematics, ::testing::Values(kZ1Folder, kBipedFolder),
                         [](const auto& robot) { return std::filesystem::path(robot.param).filename().string(); });

// The knees' frames of this robot are turned about z, and its right hip rolls about -x, so a wrong conversion shows.
TEST(LegKinematics, AgreesWithTheBipedsLegWrittenByHand) {
  const RobotModel robot = load_robot(kBipedFolder);
  std::mt19937 random(3);
  LegKinematics legs(robot);
  for (int trial = 0; trial < 50; ++trial) {
    const Motion motion = random_motion(robot, random);
    const PerFoot<FootKinematics>& feet = legs.compute(motion.q, motion.dq);
    for (const Foot foot : {kLeft, kRight}) {
      const std::string side = foot == kLeft ? "left_" : "right_";
      const auto q = [&](const char* name) { return motion.q[robot.joint_index.at(side + name)]; };
      const double roll = foot == kLeft ? q("hip_roll") : -q("hip_roll");
      const Matrix3d thigh = Rz(q("hip_yaw")) * Rx(roll) * Ry(q("hip_pitch"));
      const Matrix3d shank = thigh * Ry(q("knee"));
      const Vector3d hip(0.0, foot == kLeft ? 0.08 : -0.08, 0.0);
      const Vector3d ankle = hip + thigh * Vector3d(0, 0, -0.2) + shank * Vector3d(0, 0, -0.2);
      EXPECT_LT((feet[foot].p_BF - ankle).norm(), 1e-12) << "seed 3, trial " << trial;
      EXPECT_LT((feet[foot].R_BF - shank * Ry(q("ankle_pitch"))).norm(), 1e-12) << "seed 3, trial " << trial;
      const Vector3d front_left = ankle + feet[foot].R_BF * Vector3d(0.12, 0.04, -0.05);
      EXPECT_LT((feet[foot].sole_B[0] - front_left).norm(), 1e-12) << "seed 3, trial " << trial;
    }
  }
}

TEST_P(EveryRobotsKinematics, AgreeWithKdlsOwnSolvers) {
  LegKinematics legs(robot_);
  for (int trial = 0; trial < 50; ++trial) {
    const Motion motion = random_motion(robot_, random_);
    const PerFoot<FootKinematics>& feet = legs.compute(motion.q, motion.dq);
    for (const Foot foot : {kLeft, kRight}) {
      const std::vector<int>& joints = robot_.leg_joints[foot];
      KDL::JntArray q(static_cast<unsigned>(joints.size()));
      for (unsigned i = 0; i < joints.size(); ++i) q(i) = motion.q[joints[i]];
      KDL::Frame pose;
      KDL::Jacobian J(static_cast<unsigned>(joints.size()));
      KDL::ChainFkSolverPos_recursive(robot_.leg_chain[foot]).JntToCart(q, pose);
      KDL::ChainJntToJacSolver(robot_.leg_chain[foot]).JntToJac(q, J);
      const Vector3d p(pose.p.x(), pose.p.y(), pose.p.z());
      EXPECT_LT((feet[foot].p_BF - p).norm(), 1e-12) << "seed 11, trial " << trial;
      EXPECT_LT((feet[foot].J - J.data).norm(), 1e-12) << "seed 11, trial " << trial;
    }
  }
}

TEST_P(EveryRobotsKinematics, JacobianIsTheDerivativeOfThePose) {
  LegKinematics legs(robot_);
  const double h = 1e-5;  // central differences: truncation h^2 = 1e-10, round-off 1e-16/h = 1e-11
  const double tolerance = 1e-6;
  for (int trial = 0; trial < 20; ++trial) {
    const Motion motion = random_motion(robot_, random_);
    const PerFoot<FootKinematics> feet = legs.compute(motion.q, motion.dq);
    const PerFoot<FootKinematics> after = legs.compute(motion.q + h * motion.dq, motion.dq);
    const PerFoot<FootKinematics> before = legs.compute(motion.q - h * motion.dq, motion.dq);
    for (const Foot foot : {kLeft, kRight}) {
      const Vector3d v = (after[foot].p_BF - before[foot].p_BF) / (2 * h);
      const Vector3d omega = logarithm(after[foot].R_BF * before[foot].R_BF.transpose()) / (2 * h);
      EXPECT_LT((feet[foot].v_BF - v).norm(), tolerance) << "seed 11, trial " << trial;
      EXPECT_LT((feet[foot].omega_BF - omega).norm(), tolerance) << "seed 11, trial " << trial;
      Eigen::VectorXd dq(feet[foot].J.cols());
      for (Eigen::Index i = 0; i < dq.size(); ++i)
        dq[i] = motion.dq[robot_.leg_joints[foot][static_cast<std::size_t>(i)]];
      EXPECT_LT((feet[foot].J.topRows<3>() * dq - feet[foot].v_BF).norm(), 1e-12);
      EXPECT_LT((feet[foot].J.bottomRows<3>() * dq - feet[foot].omega_BF).norm(), 1e-12);
    }
  }
}

TEST_P(EveryRobotsKinematics, NeitherAllocatesNorDependsOnTheRobotsLifetime) {
  auto robot = std::make_unique<RobotModel>(load_robot(GetParam()));
  LegKinematics legs(*robot);
  BaseAttitude attitude(*robot);
  const Motion motion = random_motion(*robot, random_);
  robot.reset();
  const long before = test::allocation_count();
  legs.compute(motion.q, motion.dq);
  attitude.compute(motion.q, motion.dq, 0.1, 0.1, 0.2, 0.2);
  EXPECT_EQ(test::allocation_count(), before);
  const auto probe = std::make_unique<int>(1);
  if (before < 0) return;  // a sanitizer's malloc isn't counted
  EXPECT_GT(test::allocation_count(), before) << "the counter counts";
}

class Attitude : public EveryRobotsKinematics {
 protected:
  /// The torso link in the base, by KDL's own solver.
  Matrix3d torso_in_base(const JointVector& q) const {
    KDL::JntArray angles(static_cast<unsigned>(robot_.torso_joints.size()));
    for (unsigned i = 0; i < robot_.torso_joints.size(); ++i) angles(i) = q[robot_.torso_joints[i]];
    KDL::Frame pose;
    KDL::ChainFkSolverPos_recursive(robot_.torso_chain).JntToCart(angles, pose);
    return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(pose.M.data);
  }
  static double pitch(const Matrix3d& R) { return std::asin(-R(2, 0)); }
  static double roll(const Matrix3d& R) { return std::atan2(R(2, 1), R(2, 2)); }
  static double yaw(const Matrix3d& R) { return std::atan2(R(1, 0), R(0, 0)); }
};
INSTANTIATE_TEST_SUITE_P(Robots, Attitude, ::testing::Values(kZ1Folder, kBipedFolder),
                         [](const auto& robot) { return std::filesystem::path(robot.param).filename().string(); });

TEST_P(Attitude, OfAStraightWaistIsTheTorsos) {
  BaseAttitude attitude(robot_);
  const JointVector zero = JointVector::Zero(robot_.joint_index.size());
  const BaseAttitude::Result result = attitude.compute(zero, zero, 0.3, -0.2, 0.5, 0.7);
  EXPECT_LT((result.R_HB - Ry(0.3) * Rx(-0.2)).norm(), 1e-12);
  const Vector3d omega = 0.5 * Vector3d::UnitY() + 0.7 * Ry(0.3).col(0);
  EXPECT_LT((result.omega_HB_H - Vector3d(omega.x(), omega.y(), 0.0)).norm(), 1e-12);
}

TEST_P(Attitude, GivesTheTorsoItsPitchAndRollAndTheBaseNoYaw) {
  BaseAttitude attitude(robot_);
  std::uniform_real_distribution<double> angle(-0.5, 0.5);
  for (int trial = 0; trial < 50; ++trial) {
    const Motion motion = random_motion(robot_, random_);
    const double p = angle(random_), r = angle(random_);
    const Matrix3d R_HB = attitude.compute(motion.q, motion.dq, p, r, 0.0, 0.0).R_HB;
    const Matrix3d R_HT = R_HB * torso_in_base(motion.q);
    EXPECT_NEAR(pitch(R_HT), p, 1e-12) << "seed 11, trial " << trial;
    EXPECT_NEAR(roll(R_HT), r, 1e-12) << "seed 11, trial " << trial;
    EXPECT_NEAR(yaw(R_HB), 0.0, 1e-12) << "seed 11, trial " << trial;
    EXPECT_LT((R_HB * R_HB.transpose() - Matrix3d::Identity()).norm(), 1e-12);
  }
}

TEST_P(Attitude, RatesTurnTheBaseSoThatTheTorsoPitchesAndRollsAsAsked) {
  BaseAttitude attitude(robot_);
  std::uniform_real_distribution<double> angle(-0.4, 0.4), rate(-1.0, 1.0);
  const double h = 1e-5;  // as above; joint rates of 3 rad/s make the truncation 1e-9
  const double tolerance = 1e-6;
  for (int trial = 0; trial < 50; ++trial) {
    const Motion motion = random_motion(robot_, random_);
    const double p = angle(random_), r = angle(random_), dp = rate(random_), dr = rate(random_);
    const BaseAttitude::Result now = attitude.compute(motion.q, motion.dq, p, r, dp, dr);
    EXPECT_EQ(now.omega_HB_H.z(), 0.0);
    const Matrix3d after = exponential(h * now.omega_HB_H) * now.R_HB * torso_in_base(motion.q + h * motion.dq);
    const Matrix3d before = exponential(-h * now.omega_HB_H) * now.R_HB * torso_in_base(motion.q - h * motion.dq);
    EXPECT_NEAR((pitch(after) - pitch(before)) / (2 * h), dp, tolerance) << "seed 11, trial " << trial;
    EXPECT_NEAR((roll(after) - roll(before)) / (2 * h), dr, tolerance) << "seed 11, trial " << trial;
  }
}

}  // namespace
}  // namespace pmg::model
