// The optimiser's leg kinematics agree with the controller's.
#include "generator/leg_geometry.hpp"

#include <gtest/gtest.h>

#include <random>

#include "generator/gait_reference.hpp"
#include "model/leg_kinematics.hpp"
#include "model/robot_model.hpp"

namespace pmg::generator {
namespace {

LegVector<double> leg_part(const JointVector& all, const JointRoles& roles, Foot foot) {
  LegVector<double> leg;
  for (std::size_t role = 0; role < kLegJoints; ++role) {
    leg[static_cast<Eigen::Index>(role)] = all[roles.leg[foot][role]];
  }
  return leg;
}

TEST(LegGeometry, AgreesWithTheControllersKinematics) {
  const model::RobotModel robot = model::load_robot(model::find_robot("z1"));
  const JointRoles roles = find_joint_roles(robot);
  model::LegKinematics kinematics(robot);
  constexpr unsigned kSeed = 20;
  RecordProperty("seed", static_cast<int>(kSeed));
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const JointVector lower = robot.q_lower();
  const JointVector upper = robot.q_upper();
  for (int i = 0; i < 100; ++i) {
    JointVector q(lower.size());
    JointVector dq(lower.size());
    for (Eigen::Index j = 0; j < q.size(); ++j) {
      q[j] = lower[j] + unit(random) * (upper[j] - lower[j]);
      dq[j] = 4.0 * unit(random) - 2.0;
    }
    const PerFoot<model::FootKinematics>& expected = kinematics.compute(q, dq);
    for (const Foot foot : {kLeft, kRight}) {
      const LegGeometry leg = leg_geometry(robot, roles, foot);
      const FootMotion<double> ours = foot_motion<double>(leg, leg_part(q, roles, foot), leg_part(dq, roles, foot));
      // the same arithmetic in another order: only rounding differs
      EXPECT_LT((ours.R_BF - expected[foot].R_BF).norm(), 1e-12);
      EXPECT_LT((ours.p_BF - expected[foot].p_BF).norm(), 1e-12);
      EXPECT_LT((ours.v_BF - expected[foot].v_BF).norm(), 1e-12);
      EXPECT_LT((ours.omega_BF - expected[foot].omega_BF).norm(), 1e-12);
    }
  }
}

TEST(Reach, PutsTheFootWhereItIsAsked) {
  const model::RobotModel robot = model::load_robot(model::find_robot("z1"));
  const JointRoles roles = find_joint_roles(robot);
  const LegGeometry leg = leg_geometry(robot, roles, kLeft);
  const LegVector<double> stand = leg_part(robot.q_stand(), roles, kLeft);
  const FootMotion<double> standing = foot_motion<double>(leg, stand, LegVector<double>::Zero());
  const Eigen::Vector3d target = standing.p_BF + Eigen::Vector3d(0.1, 0.05, 0.08);
  const Eigen::Matrix3d turned = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const FootMotion<double> reached =
      foot_motion<double>(leg, reach(leg, turned, target, stand), LegVector<double>::Zero());
  EXPECT_LT((reached.p_BF - target).norm(), 1e-7);  // ten times reach()'s stopping threshold
  EXPECT_LT((reached.R_BF - turned).norm(), 1e-7);
}

TEST(Reach, RefusesWhatTheLegIsTooShortFor) {
  const model::RobotModel robot = model::load_robot(model::find_robot("z1"));
  const JointRoles roles = find_joint_roles(robot);
  const LegGeometry leg = leg_geometry(robot, roles, kLeft);
  const LegVector<double> stand = leg_part(robot.q_stand(), roles, kLeft);
  EXPECT_THROW(reach(leg, Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.0, 0.1, -1.5), stand), std::runtime_error);
}

}  // namespace
}  // namespace pmg::generator
