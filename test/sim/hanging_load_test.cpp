// The load of a hanging joint, computed from the robot's links, is what MuJoCo's own dynamics say.
#include "model/hanging_load.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>

#include "robots.hpp"
#include "sim/world.hpp"

namespace pmg::sim {
namespace {

/// MuJoCo keeps link inertias as principal moments, to ten digits or so.
constexpr double kAgreement = 1e-8;

TEST(HangingLoad, OfEveryJointIsMuJoCos) {
  const model::RobotModel& robot = z1();
  World world(robot, WorldOptions{});
  const mjModel* model = world.mj_model();
  mjData* data = world.mj_data();
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> mass(model->nv, model->nv);
  mj_forward(model, data);
  mj_fullM(model, mass.data(), data->qM);
  for (const model::Joint& joint : robot.joints) {
    SCOPED_TRACE(joint.name);
    const model::HangingLoad load = model::hanging_load(robot, joint.name);
    const int id = mj_name2id(model, mjOBJ_JOINT, joint.name.c_str());
    const int dof = model->jnt_dofadr[id], address = model->jnt_qposadr[id];
    EXPECT_NEAR(load.mass_kg, model->body_subtreemass[model->jnt_bodyid[id]], kAgreement);
    EXPECT_NEAR(load.inertia_kg_m2, mass(dof, dof) - model->dof_armature[dof], kAgreement);
    mju_zero(data->qvel, model->nv);
    for (const double q_rad : {-1.1, 0.0, 0.4, 2.0}) {
      data->qpos[address] = q_rad;
      mj_forward(model, data);
      EXPECT_NEAR(load.gravity_Nm * std::sin(q_rad - load.hangs_at_rad), data->qfrc_bias[dof], 1e-6) << q_rad;
    }
    data->qpos[address] = joint.stand_rad;
    mj_forward(model, data);
    const Eigen::Map<const Eigen::Vector3d> base(data->xpos +
                                                 3 * mj_name2id(model, mjOBJ_BODY, robot.base_link.c_str())),
        axis(data->xaxis + 3 * id), anchor(data->xanchor + 3 * id),
        center(data->subtree_com + 3 * model->jnt_bodyid[id]);
    EXPECT_LT((load.center_m - (center - base)).norm(), 1e-6);
    EXPECT_LT((load.center_m_per_rad - axis.cross(center - anchor)).norm(), 1e-6);
  }
}

TEST(HangingLoad, InAnotherPostureIsMuJoCos) {
  const model::RobotModel& robot = z1();
  World world(robot, WorldOptions{});
  const mjModel* model = world.mj_model();
  mjData* data = world.mj_data();
  JointVector q = robot.q_stand();
  for (Eigen::Index j = 0; j < q.size(); ++j) {
    q[j] += 0.3 * std::sin(1.0 + 2.0 * static_cast<double>(j));
    const int id = mj_name2id(model, mjOBJ_JOINT, robot.joint_index.name(static_cast<int>(j)).c_str());
    data->qpos[model->jnt_qposadr[id]] = q[j];
  }
  mju_zero(data->qvel, model->nv);
  mj_forward(model, data);
  for (Eigen::Index j = 0; j < q.size(); ++j) {
    const std::string& name = robot.joint_index.name(static_cast<int>(j));
    const model::HangingLoad load = model::hanging_load(robot, name, q);
    const int dof = model->jnt_dofadr[mj_name2id(model, mjOBJ_JOINT, name.c_str())];
    EXPECT_NEAR(load.gravity_Nm * std::sin(q[j] - load.hangs_at_rad), data->qfrc_bias[dof], 1e-6) << name;
  }
}

TEST(HangingLoad, AJointThatIsNoneIsNamed) {
  EXPECT_THROW(model::hanging_load(z1(), "left_kne"), std::invalid_argument);
  EXPECT_THROW(model::hanging_load(z1(), ""), std::invalid_argument) << "fixed joints have names too";
}

}  // namespace
}  // namespace pmg::sim
