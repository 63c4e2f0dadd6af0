#include "model/sole_load.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <kdl/chaindynparam.hpp>
#include <kdl/chainidsolver_recursive_newton_euler.hpp>
#include <memory>
#include <random>

#include "generator_core/allocation_count.hpp"
#include "model/leg_kinematics.hpp"
#include "model/robots.hpp"

namespace pmg::model {
namespace {

using test::kZ1Folder;

class SoleLoadsTest : public testing::Test {
 protected:
  double draw(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

  /// A random posture within the joints' ranges, with a bent knee.
  JointVector posture() {
    JointVector q = robot_.q_stand();
    for (const Foot foot : {kLeft, kRight}) {
      for (const int joint : robot_.leg_joints[foot]) {
        const Joint& limits = robot_.joints[static_cast<std::size_t>(joint)];
        q[joint] = draw(0.8 * limits.lower_rad, 0.8 * limits.upper_rad);
        if (limits.name.ends_with("knee")) q[joint] = draw(0.2, 1.5);
      }
    }
    return q;
  }

  /// The drives' torques by KDL's own dynamics.
  JointVector torques(const JointVector& q, const Eigen::Vector3d& gravity_B,
                      const PerFoot<Eigen::Matrix<double, 6, 1>>& wrench_B) {
    JointVector torque_Nm = JointVector::Zero(q.size());
    LegKinematics legs(robot_);
    const auto& feet = legs.compute(q, JointVector::Zero(q.size()));
    for (const Foot foot : {kLeft, kRight}) {
      const auto& joints = robot_.leg_joints[foot];
      const auto n = static_cast<unsigned>(joints.size());
      const Eigen::Vector3d g = 9.81 * gravity_B;
      KDL::ChainDynParam dynamics(robot_.leg_chain[foot], KDL::Vector(g.x(), g.y(), g.z()));
      KDL::JntArray angles(n), held(n);
      for (unsigned i = 0; i < n; ++i) angles(i) = q[joints[i]];
      dynamics.JntToGravity(angles, held);
      for (unsigned i = 0; i < n; ++i) torque_Nm[joints[i]] = held(i) - feet[foot].J.col(i).dot(wrench_B[foot]);
    }
    return torque_Nm;
  }

  /// The drives' torques of legs in the air, by KDL's own inverse dynamics of a chain that begins with a joint about
  /// omega_B, along which alpha_B is.
  JointVector torques_in_the_air(const LegMotion& motion) {
    JointVector torque_Nm = JointVector::Zero(motion.q.size());
    const KDL::Vector omega(motion.omega_B.x(), motion.omega_B.y(), motion.omega_B.z());
    for (const Foot foot : {kLeft, kRight}) {
      const auto& joints = robot_.leg_joints[foot];
      KDL::Chain chain;
      chain.addSegment(KDL::Segment(KDL::Joint("base", KDL::Vector::Zero(), omega, KDL::Joint::RotAxis)));
      chain.addChain(robot_.leg_chain[foot]);
      const auto n = static_cast<unsigned>(joints.size() + 1);
      KDL::JntArray q(n), dq(n), ddq(n), held(n);
      dq(0) = motion.omega_B.norm();
      ddq(0) = motion.alpha_B.dot(motion.omega_B) / dq(0);
      for (unsigned i = 1; i < n; ++i) {
        q(i) = motion.q[joints[i - 1]];
        dq(i) = motion.dq[joints[i - 1]];
        ddq(i) = motion.ddq[joints[i - 1]];
      }
      const Eigen::Vector3d gravity = -motion.specific_force_B;
      KDL::ChainIdSolver_RNE dynamics(chain, KDL::Vector(gravity.x(), gravity.y(), gravity.z()));
      EXPECT_EQ(dynamics.CartToJnt(q, dq, ddq, KDL::Wrenches(chain.getNrOfSegments(), KDL::Wrench::Zero()), held), 0);
      for (unsigned i = 1; i < n; ++i) {
        const Joint& joint = robot_.joints[static_cast<std::size_t>(joints[i - 1])];
        torque_Nm[joints[i - 1]] = held(i) + joint.armature_kg_m2 * ddq(i);
      }
    }
    return torque_Nm;
  }

  RobotModel robot_ = load_robot(kZ1Folder);
  SoleLoads loads_{robot_};
  std::mt19937 random_{5};
};

TEST_F(SoleLoadsTest, AreTheForcesThatTheTorquesHold) {
  for (int trial = 0; trial < 200; ++trial) {
    const JointVector q = posture();
    const Eigen::Vector3d gravity_B = Eigen::Vector3d(draw(-0.5, 0.5), draw(-0.5, 0.5), -1.0).normalized();
    PerFoot<Eigen::Matrix<double, 6, 1>> wrench_B;
    for (auto& wrench : wrench_B) {
      wrench << draw(-50.0, 50.0), draw(-50.0, 50.0), draw(0.0, 400.0), draw(-20.0, 20.0), draw(-20.0, 20.0),
          draw(-5.0, 5.0);
    }
    loads_.set_posture(q, gravity_B);
    const PerFoot<SoleLoad> loads = loads_.of(torques(q, gravity_B, wrench_B));
    LegKinematics legs(robot_);
    const auto& feet = legs.compute(q, JointVector::Zero(q.size()));
    for (const Foot foot : {kLeft, kRight}) {
      const double normal_N = feet[foot].R_BF.col(2).dot(wrench_B[foot].head<3>());
      // Rounding, amplified by the condition of a knee bent by 0.2 rad or more.
      EXPECT_NEAR(loads[foot].force_N, normal_N, 1e-6) << trial;
      EXPECT_NEAR(loads[foot].vertical_N, -gravity_B.dot(wrench_B[foot].head<3>()), 1e-6) << trial;
    }
  }
}

TEST_F(SoleLoadsTest, OfALegThatHangsAreNothing) {
  const JointVector q = posture();
  const Eigen::Vector3d down_B(0.0, 0.0, -1.0);
  loads_.set_posture(q, down_B);
  const PerFoot<SoleLoad> loads =
      loads_.of(torques(q, down_B, {Eigen::Matrix<double, 6, 1>::Zero(), Eigen::Matrix<double, 6, 1>::Zero()}));
  for (const SoleLoad& load : loads) EXPECT_NEAR(load.vertical_N, 0.0, 1e-7);
}

TEST_F(SoleLoadsTest, FrictionFalsifiesThemByAFewNewtonsWithBentKneesAndBeyondMeasureWithAStraightOne) {
  const Eigen::Vector3d down_B(0.0, 0.0, -1.0);
  JointVector q = robot_.q_stand();
  for (const char* name : {"left_knee", "right_knee"}) q[robot_.joint_index.at(name)] += 0.16;
  const JointVector still = JointVector::Zero(q.size());
  loads_.set_posture(q, down_B);
  const double weight_N = robot_.total_mass_kg * 9.81;
  EXPECT_LT(loads_.error_N(kLeft, still), 0.05 * weight_N);
  EXPECT_GT(loads_.error_N(kLeft, still), 0.01 * weight_N);
  const int knee = robot_.joint_index.at("left_knee");
  q[knee] = 0.0;
  loads_.set_posture(q, down_B);
  EXPECT_GT(loads_.error_N(kLeft, still), weight_N);
  EXPECT_LT(loads_.error_N(kRight, still), 0.05 * weight_N) << "the other leg is as it was";
}

TEST_F(SoleLoadsTest, AJointsWrongAccelerationFalsifiesThemTheMoreTheStraighterItsLegIs) {
  const Eigen::Vector3d down_B(0.0, 0.0, -1.0);
  JointVector q = robot_.q_stand(), wrong = JointVector::Zero(q.size());
  const int knee = robot_.joint_index.at("left_knee");
  loads_.set_posture(q, down_B);
  const double still_N = loads_.error_N(kLeft, wrong);
  wrong[knee] = 50.0;
  const double bent_N = loads_.error_N(kLeft, wrong);
  EXPECT_GT(bent_N, 2.0 * still_N);
  EXPECT_EQ(loads_.error_N(kRight, wrong), loads_.error_N(kRight, JointVector::Zero(q.size())));
  q[knee] *= 0.3;
  loads_.set_posture(q, down_B);
  EXPECT_GT(loads_.error_N(kLeft, wrong), 2.0 * bent_N);
}

TEST_F(SoleLoadsTest, OfALegThatSwingsInTheAirAreNothingThoughItsJointsAccelerate) {
  for (int trial = 0; trial < 50; ++trial) {
    const JointVector q = posture();
    JointVector dq = JointVector::Zero(q.size()), ddq = dq;
    for (const Foot foot : {kLeft, kRight}) {
      for (const int i : robot_.leg_joints[foot]) {
        dq[i] = draw(-4.0, 4.0);
        ddq[i] = draw(-60.0, 60.0);
      }
    }
    const Eigen::Vector3d down_B = Eigen::Vector3d(draw(-0.2, 0.2), draw(-0.2, 0.2), -1.0).normalized();
    const Eigen::Vector3d acceleration(draw(-1.0, 1.0), draw(-1.0, 1.0), draw(-1.0, 1.0));
    const Eigen::Vector3d omega_B(draw(-1.0, 1.0), draw(-1.0, 1.0), draw(-1.0, 1.0));
    const LegMotion motion{.q = q,
                           .dq = dq,
                           .ddq = ddq,
                           .gravity_B = down_B,
                           .specific_force_B = acceleration - 9.81 * down_B,
                           .omega_B = omega_B,
                           .alpha_B = draw(-30.0, 30.0) * omega_B};
    const JointVector torque_Nm = torques_in_the_air(motion);
    loads_.set_motion(motion);
    for (const SoleLoad& load : loads_.of(torque_Nm)) EXPECT_NEAR(load.vertical_N, 0.0, 1e-6) << trial;
    loads_.set_posture(q, down_B);
    const PerFoot<SoleLoad> as_if_still = loads_.of(torque_Nm);
    EXPECT_GT(std::abs(as_if_still[kLeft].vertical_N) + std::abs(as_if_still[kRight].vertical_N), 1.0) << trial;
  }
}

TEST_F(SoleLoadsTest, NeverUseTheHeapNorTheRobot) {
  auto robot = std::make_unique<RobotModel>(load_robot(kZ1Folder));
  SoleLoads loads(*robot);
  const JointVector q = robot->q_stand(), torque_Nm = JointVector::Zero(q.size());
  robot.reset();
  const long before = test::allocation_count();
  double sum = 0.0;
  for (int k = 0; k < 100; ++k) {
    loads.set_posture(q, {0.0, 0.0, -1.0});
    sum += loads.of(torque_Nm)[kLeft].force_N;
  }
  EXPECT_EQ(test::allocation_count(), before);
  EXPECT_TRUE(std::isfinite(sum));
}

}  // namespace
}  // namespace pmg::model
