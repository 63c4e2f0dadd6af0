// The load of a hanging joint, computed from the robot's links, is what MuJoCo's own dynamics say.
#include "model/hanging_load.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
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
  }
}

TEST(HangingLoad, AJointThatIsNoneIsNamed) {
  EXPECT_THROW(model::hanging_load(z1(), "left_kne"), std::invalid_argument);
  EXPECT_THROW(model::hanging_load(z1(), ""), std::invalid_argument) << "fixed joints have names too";
}

}  // namespace
}  // namespace pmg::sim
