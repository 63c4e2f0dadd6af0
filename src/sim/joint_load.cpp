#include "sim/joint_load.hpp"

#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "sim/world.hpp"

namespace pmg::sim {

HangingLoad hanging_load(const model::RobotModel& robot, const std::string& joint) {
  World world(robot, WorldOptions{});
  const mjModel* model = world.mj_model();
  mjData* data = world.mj_data();
  const int id = mj_name2id(model, mjOBJ_JOINT, joint.c_str());
  if (id < 0) throw std::invalid_argument(joint + " isn't a joint of " + robot.name);
  const int dof = model->jnt_dofadr[id], address = model->jnt_qposadr[id];

  HangingLoad load;
  load.mass_kg = model->body_subtreemass[model->jnt_bodyid[id]];
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> mass(model->nv, model->nv);
  mj_fullM(model, mass.data(), data->qM);
  load.inertia_kg_m2 = mass(dof, dof) - model->dof_armature[dof];

  // At rest the bias is what holds the joint against gravity: gravity_Nm sin(q - hangs_at).
  const auto holding_Nm = [&](double q_rad) {
    data->qpos[address] = q_rad;
    mju_zero(data->qvel, model->nv);
    mj_forward(model, data);
    return data->qfrc_bias[dof];
  };
  const double at_zero_Nm = holding_Nm(0.0), at_right_angle_Nm = holding_Nm(0.5 * std::numbers::pi);
  load.gravity_Nm = std::hypot(at_zero_Nm, at_right_angle_Nm);
  load.hangs_at_rad = std::atan2(-at_zero_Nm, at_right_angle_Nm);
  return load;
}

}  // namespace pmg::sim
