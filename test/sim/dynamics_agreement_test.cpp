// KDL's tree and MuJoCo's model are built separately from the URDF; they must be the same robot.
#include <gtest/gtest.h>

#include <kdl/treefksolverpos_recursive.hpp>
#include <kdl/treeidsolver_recursive_newton_euler.hpp>

#include "robots.hpp"
#include "sim/world.hpp"

namespace pmg {
namespace {

constexpr double kTolerance = 1e-9;  // a few hundred roundings of numbers up to 100
constexpr int kPostures = 50;

class DynamicsAgreement : public testing::TestWithParam<const model::RobotModel* (*)()> {
 protected:
  DynamicsAgreement() : robot(*GetParam()()), world(robot, {}), q_kdl(robot.tree.getNrOfJoints()) {
    for (const auto& [name, element] : robot.tree.getSegments()) {
      const KDL::Joint& joint = GetTreeElementSegment(element).getJoint();
      if (joint.getType() == KDL::Joint::Fixed || joint.getType() == KDL::Joint::None) continue;
      kdl_index.resize(static_cast<std::size_t>(robot.joint_index.size()));
      kdl_index[static_cast<std::size_t>(robot.joint_index.at(joint.getName()))] = GetTreeElementQNr(element);
    }
    for (const auto& joint : robot.joints)
      mj_joint.push_back(mj_name2id(world.mj_model(), mjOBJ_JOINT, joint.name.c_str()));
  }

  /// Puts the base at the world's origin, unrotated and at rest: there MuJoCo's floating base and KDL's fixed one have
  /// the same numbers.
  void take_posture(const JointVector& q) {
    const mjModel* m = world.mj_model();
    mjData* d = world.mj_data();
    mju_zero(d->qpos, m->nq);
    d->qpos[3] = 1.0;
    mju_zero(d->qvel, m->nv);
    for (std::size_t j = 0; j < mj_joint.size(); ++j) {
      d->qpos[m->jnt_qposadr[mj_joint[j]]] = q[static_cast<int>(j)];
      q_kdl(kdl_index[j]) = q[static_cast<int>(j)];
    }
    mj_forward(m, d);
  }

  int dof(std::size_t joint) const { return world.mj_model()->jnt_dofadr[mj_joint[joint]]; }

  const model::RobotModel& robot;
  sim::World world;
  KDL::JntArray q_kdl;
  std::vector<unsigned int> kdl_index;
  std::vector<int> mj_joint;
  std::mt19937_64 random{20240601};
};

TEST_P(DynamicsAgreement, EveryLinkIsAtTheSamePlace) {
  KDL::TreeFkSolverPos_recursive fk(robot.tree);
  for (int i = 0; i < kPostures; ++i) {
    take_posture(random_posture(robot, random));
    for (const auto& [name, element] : robot.tree.getSegments()) {
      KDL::Frame frame;
      ASSERT_GE(fk.JntToCart(q_kdl, frame, name), 0);
      const int body = mj_name2id(world.mj_model(), mjOBJ_BODY, name.c_str());
      ASSERT_GE(body, 0) << name;
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(world.mj_data()->xpos[3 * body + k], frame.p[k], kTolerance) << name;
      for (int k = 0; k < 9; ++k)
        EXPECT_NEAR(world.mj_data()->xmat[9 * body + k], frame.M(k / 3, k % 3), kTolerance) << name;
    }
  }
}

TEST_P(DynamicsAgreement, GravityTorquesAreTheSame) {
  KDL::TreeIdSolver_RNE dynamics(robot.tree, KDL::Vector(0, 0, -9.81));
  KDL::JntArray zero(q_kdl.rows()), torques(q_kdl.rows());
  for (int i = 0; i < kPostures; ++i) {
    take_posture(random_posture(robot, random));
    ASSERT_EQ(dynamics.CartToJnt(q_kdl, zero, zero, {}, torques), 0);
    for (std::size_t j = 0; j < mj_joint.size(); ++j)
      EXPECT_NEAR(world.mj_data()->qfrc_bias[dof(j)], torques(kdl_index[j]), kTolerance) << robot.joints[j].name;
  }
}

TEST_P(DynamicsAgreement, MassMatricesAreTheSame) {
  KDL::TreeIdSolver_RNE dynamics(robot.tree, KDL::Vector::Zero());
  KDL::JntArray zero(q_kdl.rows()), torques(q_kdl.rows());
  const int nv = world.mj_model()->nv;
  std::vector<mjtNum> M(static_cast<std::size_t>(nv * nv));
  for (int i = 0; i < kPostures; ++i) {
    take_posture(random_posture(robot, random));
    mj_fullM(world.mj_model(), M.data(), world.mj_data()->qM);
    for (std::size_t column = 0; column < mj_joint.size(); ++column) {
      KDL::JntArray unit(q_kdl.rows());
      unit(kdl_index[column]) = 1.0;
      ASSERT_EQ(dynamics.CartToJnt(q_kdl, zero, unit, {}, torques), 0);
      for (std::size_t row = 0; row < mj_joint.size(); ++row) {
        const double rotor = row == column ? robot.joints[row].armature_kg_m2 : 0.0;  // KDL's tree has no rotors
        EXPECT_NEAR(M[static_cast<std::size_t>(dof(row) * nv + dof(column))] - rotor, torques(kdl_index[row]),
                    kTolerance)
            << robot.joints[row].name << ", " << robot.joints[column].name;
      }
    }
  }
}

const model::RobotModel* z1_pointer() { return &z1(); }
const model::RobotModel* biped_pointer() { return &biped(); }

INSTANTIATE_TEST_SUITE_P(Robots, DynamicsAgreement, testing::Values(&z1_pointer, &biped_pointer),
                         [](const auto& test) { return test.index == 0 ? "Z1" : "Biped"; });

}  // namespace
}  // namespace pmg
