// Integrating u' over time moves the base so that the stance foot stays in place in the world.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

#include "gco/ground_aware_command.hpp"
#include "model/leg_kinematics.hpp"
#include "robot_states.hpp"

namespace pmg::gco {
namespace {

/// Every leg and torso joint swings about standing, each with its own frequency.
class Swing {
 public:
  explicit Swing(const model::RobotModel& robot)
      : robot_(robot), amplitude_(JointVector::Zero(robot.joint_index.size())) {
    const JointVector stand = robot.q_stand(), lower = robot.q_lower(), upper = robot.q_upper();
    for (const auto* joints : {&robot.leg_joints[kLeft], &robot.leg_joints[kRight], &robot.torso_joints}) {
      for (const int joint : *joints) {
        amplitude_[joint] = std::min({0.2, 0.9 * (upper[joint] - stand[joint]), 0.9 * (stand[joint] - lower[joint])});
      }
    }
  }
  JointVector q(double t) const {
    JointVector q = robot_.q_stand();
    for (Eigen::Index i = 0; i < q.size(); ++i) q[i] += amplitude_[i] * std::sin(rhythm(i) * t + offset(i));
    return q;
  }
  JointVector dq(double t) const {
    JointVector dq = JointVector::Zero(amplitude_.size());
    for (Eigen::Index i = 0; i < dq.size(); ++i)
      dq[i] = amplitude_[i] * rhythm(i) * std::cos(rhythm(i) * t + offset(i));
    return dq;
  }

 private:
  static double rhythm(Eigen::Index i) { return 2.0 + 0.37 * static_cast<double>(i % 7); }
  static double offset(Eigen::Index i) { return 1.3 * static_cast<double>(i); }
  const model::RobotModel& robot_;
  JointVector amplitude_;
};

double yaw_of(const Eigen::Matrix3d& R) { return std::atan2(R(1, 0), R(0, 0)); }

class KinematicReplayOf : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Robots, KinematicReplayOf, testing::ValuesIn(test::kRobots), test::robot_name);

TEST_P(KinematicReplayOf, StanceFootStaysPutWhileLegsAndWaistMove) {
  const model::RobotModel robot = test::load(GetParam());
  const Swing swing(robot);
  model::LegKinematics legs(robot);
  model::BaseAttitude base_attitude(robot);
  model::ChainKinematics torso(robot.torso_chain, robot.torso_joints);
  GroundAwareCommand gco(robot);
  const auto foot_at = [&](double t) { return legs.compute(swing.q(t), swing.dq(t))[kLeft]; };
  // The torso attitude that keeps the left foot flat: (pitch, roll) of R_WT = R_FB R_BT with a level foot.
  const auto torso_attitude = [&](double t) {
    torso.compute(swing.q(t));
    const Eigen::Matrix3d R = foot_at(t).R_BF.transpose() * torso.R();
    return Eigen::Vector2d(std::asin(-R(2, 0)), std::atan2(R(2, 1), R(2, 2)));
  };
  Eigen::Vector3d omega_HB_H;  // of the last call of base_motion
  const auto base_motion = [&](double t) {
    Reference reference = test::standing(robot);
    test::set_contact(reference, 1.0, 0.0);
    reference.q = swing.q(t);
    reference.dq = swing.dq(t);
    constexpr double kStep_s = 1e-5;
    const Eigen::Vector2d attitude = torso_attitude(t);
    const Eigen::Vector2d rate = (torso_attitude(t + kStep_s) - torso_attitude(t - kStep_s)) / (2.0 * kStep_s);
    reference.command = {{0.4, -0.1, 0.3, attitude[0], attitude[1], 0.0}};
    reference.command_rate = {{0.0, 0.0, 0.0, rate[0], rate[1], 0.0}};
    omega_HB_H =
        base_attitude.compute(reference.q, reference.dq, attitude[0], attitude[1], rate[0], rate[1]).omega_HB_H;
    return gco.solve(reference);
  };

  constexpr double kStep_s = 1e-3;
  constexpr int kSteps = 2000;
  // The world's origin is the foot's start; it is turned so that its yaw differs from the base's.
  Eigen::Matrix3d R_WB = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()) * foot_at(0.0).R_BF.transpose();
  Eigen::Vector3d p_WB = Eigen::Vector3d(1.0, -2.0, robot.standing_height_m + base_motion(0.0).command[kHeight]);
  const Eigen::Vector3d p_WF_start = p_WB + R_WB * foot_at(0.0).p_BF;
  const Eigen::Matrix3d R_WF_start = R_WB * foot_at(0.0).R_BF;
  double moved = 0.0;
  for (int k = 0; k < kSteps; ++k) {
    const double t = k * kStep_s;
    const auto rotation_W = [&](const Result& result, const Eigen::Matrix3d& R) {
      const Eigen::Vector3d omega = omega_HB_H + result.command[kOmega] * Eigen::Vector3d::UnitZ();
      return Eigen::Vector3d(Eigen::AngleAxisd(yaw_of(R), Eigen::Vector3d::UnitZ()) * omega);
    };
    const auto turned = [](const Eigen::Matrix3d& R, const Eigen::Vector3d& angle) {
      return Eigen::Matrix3d(Eigen::AngleAxisd(angle.norm(), angle.normalized()) * R);
    };
    const Eigen::Vector3d omega_start = rotation_W(base_motion(t), R_WB);
    const Eigen::Matrix3d R_middle = turned(R_WB, 0.5 * kStep_s * omega_start);
    const Result& middle = base_motion(t + 0.5 * kStep_s);
    const Eigen::Vector3d v_H(middle.command[kVx], middle.command[kVy], middle.vz_m_s);
    const Eigen::Vector3d step = kStep_s * (Eigen::AngleAxisd(yaw_of(R_middle), Eigen::Vector3d::UnitZ()) * v_H);
    R_WB = turned(R_WB, kStep_s * rotation_W(middle, R_middle));
    p_WB += step;
    moved += step.norm();
    const model::FootKinematics foot = foot_at(t + kStep_s);
    // Midpoint rule: (1 ms)^2 / 24 times accelerations of a few m/s^2 per second, plus the prior's 1e-6 m/s.
    ASSERT_LT((p_WB + R_WB * foot.p_BF - p_WF_start).norm(), 2e-5) << t;
    ASSERT_LT((R_WB * foot.R_BF - R_WF_start).norm(), 2e-5) << t;
    ASSERT_NEAR(p_WB.z(), robot.standing_height_m + base_motion(t + kStep_s).command[kHeight], 2e-5) << t;
  }
  EXPECT_GT(moved, 0.1);
}

}  // namespace
}  // namespace pmg::gco
