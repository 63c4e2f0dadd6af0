#include "robot_diagnosis/robot_dynamics.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <stdexcept>

#include "sim/world.hpp"

namespace pmg::robot_diagnosis {

RobotDynamics::RobotDynamics(const model::RobotModel& robot) : p_BI_(robot.imu.T_LI.translation()) {
  if (robot.imu.link != robot.base_link) {
    throw std::runtime_error(
        fmt::format("{}: the IMU is on {}; a diagnosis of the robot expects it on the base link {}",
                    (robot.directory / "robot.yaml").string(), robot.imu.link, robot.base_link));
  }
  const sim::World world(robot, {});
  model_.reset(mj_copyModel(nullptr, world.mj_model()));
  nominal_.reset(mj_copyModel(nullptr, world.mj_model()));
  mju_zero(model_->opt.gravity, 3);  // the specific force contains gravity
  data_.reset(mj_makeData(model_.get()));
  for (const auto& joint : robot.joints) {
    const int id = mj_name2id(model_.get(), mjOBJ_JOINT, joint.name.c_str());
    qpos_address_.push_back(model_->jnt_qposadr[id]);
    dof_address_.push_back(model_->jnt_dofadr[id]);
  }
}

/// Puts the base at the world's origin, so that B's axes are the world's.
void RobotDynamics::take_posture(const JointVector& q) {
  mjData* d = data_.get();
  mju_zero(d->qpos, 7);
  d->qpos[3] = 1.0;
  for (std::size_t j = 0; j < qpos_address_.size(); ++j) d->qpos[qpos_address_[j]] = q[static_cast<Eigen::Index>(j)];
  mj_kinematics(model_.get(), d);
  mj_comPos(model_.get(), d);
}

Eigen::Vector3d RobotDynamics::imu_acceleration(const JointVector& q, const JointVector& torque_Nm) {
  take_posture(q);
  mj_crb(model_.get(), data_.get());
  const int n = model_->nv;
  Eigen::MatrixXd mass(n, n);
  mj_fullM(model_.get(), mass.data(), data_->qM);
  Eigen::VectorXd force = Eigen::VectorXd::Zero(n);
  for (std::size_t j = 0; j < dof_address_.size(); ++j)
    force[dof_address_[j]] = torque_Nm[static_cast<Eigen::Index>(j)];
  const Eigen::VectorXd acceleration = mass.llt().solve(force);
  return acceleration.head<3>() + acceleration.segment<3>(3).cross(p_BI_);
}

GeneralizedVector RobotDynamics::required(const RobotMotion& motion) {
  mjData* d = data_.get();
  const mjModel* m = model_.get();
  const Eigen::Vector3d centripetal = motion.omega_B.cross(motion.omega_B.cross(p_BI_));
  const Eigen::Vector3d specific_force_base = motion.specific_force_B - motion.alpha_B.cross(p_BI_) - centripetal;
  mju_zero(d->qvel, 3);  // a constant velocity changes no force
  for (int i = 0; i < 3; ++i) {
    d->qvel[3 + i] = motion.omega_B[i];
    d->qacc[i] = specific_force_base[i];
    d->qacc[3 + i] = motion.alpha_B[i];
  }
  for (std::size_t j = 0; j < dof_address_.size(); ++j) {
    const auto index = static_cast<Eigen::Index>(j);
    d->qvel[dof_address_[j]] = motion.dq[index];
    d->qacc[dof_address_[j]] = motion.ddq[index];
  }
  take_posture(motion.q);
  mj_comVel(m, d);
  mj_rne(m, d, 1, d->qfrc_inverse);
  GeneralizedVector force(6 + static_cast<Eigen::Index>(dof_address_.size()));
  for (int i = 0; i < 6; ++i) force[i] = d->qfrc_inverse[i];
  for (std::size_t j = 0; j < dof_address_.size(); ++j)
    force[6 + static_cast<Eigen::Index>(j)] = d->qfrc_inverse[dof_address_[j]];
  return force;
}

WrenchJacobian RobotDynamics::jacobian(int body, const mjtNum* point) const {
  constexpr int kMaxDofs = 6 + kMaxJoints;
  Eigen::Matrix<double, 3, kMaxDofs, Eigen::RowMajor> translation, rotation;
  using Rows = Eigen::Map<const Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor>>;
  mj_jac(model_.get(), data_.get(), translation.data(), rotation.data(), point, body);
  const Rows linear(translation.data(), 3, model_->nv), angular(rotation.data(), 3, model_->nv);
  WrenchJacobian result(6, 6 + static_cast<Eigen::Index>(dof_address_.size()));
  const auto take = [&](Eigen::Index column, int dof) {
    result.col(column).head<3>() = linear.col(dof);
    result.col(column).tail<3>() = angular.col(dof);
  };
  for (int i = 0; i < 6; ++i) take(i, i);
  for (std::size_t j = 0; j < dof_address_.size(); ++j) take(6 + static_cast<Eigen::Index>(j), dof_address_[j]);
  return result;
}

WrenchJacobian RobotDynamics::jacobian_of_link(int body) const { return jacobian(body, data_->xpos + 3 * body); }
WrenchJacobian RobotDynamics::jacobian_of_center(int body) const { return jacobian(body, data_->xipos + 3 * body); }

Eigen::Matrix3d RobotDynamics::rotation(int body) const {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(data_->xmat + 9 * body);
}

Eigen::Vector3d RobotDynamics::origin(int body) const {
  return Eigen::Map<const Eigen::Vector3d>(data_->xpos + 3 * body);
}

int RobotDynamics::body(const std::string& link) const {
  const int id = mj_name2id(model_.get(), mjOBJ_BODY, link.c_str());
  if (id < 0) throw std::invalid_argument(fmt::format("the robot has no link {}", link));
  return id;
}

void RobotDynamics::set_link(int body, double mass_factor, double added_kg, const Eigen::Vector3d& center_shift_m) {
  model_->body_mass[body] = mass_factor * nominal_->body_mass[body] + added_kg;
  for (int i = 0; i < 3; ++i) {
    model_->body_inertia[3 * body + i] = mass_factor * nominal_->body_inertia[3 * body + i];
    model_->body_ipos[3 * body + i] = nominal_->body_ipos[3 * body + i] + center_shift_m[i];
  }
}

}  // namespace pmg::robot_diagnosis
