#include "sim/actuator_joint.hpp"

namespace pmg::sim {

void hand_over(mjModel* model, int actuator, const ActuatorModel& by) {
  const int dof = model->jnt_dofadr[model->actuator_trnid[2 * actuator]];
  model->dof_armature[dof] = by.joint_armature_kg_m2();
  model->dof_damping[dof] = model->dof_frictionloss[dof] = 0.0;
  model->actuator_forcelimited[actuator] = 0;
  model->actuator_gainprm[actuator * mjNGAIN] = 1.0;
}

void apply(mjModel* model, mjData* data, int actuator, const ActuatorTorque& torque, double dq_rad_s) noexcept {
  mjtNum* bias = model->actuator_biasprm + actuator * mjNBIAS;
  bias[0] = bias[1] = 0.0;
  bias[2] = torque.slope_Nm_s_per_rad;
  data->ctrl[actuator] = torque.torque_Nm - torque.slope_Nm_s_per_rad * dq_rad_s;
}

}  // namespace pmg::sim
