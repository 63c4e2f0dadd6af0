// Which forces a robot's motion takes, by MuJoCo's recursive Newton-Euler, from what its IMU and encoders say alone.
#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "model/robot_model.hpp"
#include "pmg/types.hpp"

namespace pmg::robot_diagnosis {

/// Of the base frame B and the joints. The specific force, what an accelerometer shows, is that of the IMU's place; it
/// holds gravity, so neither attitude nor place in the world are needed.
struct RobotMotion {
  JointVector q, dq, ddq;
  Eigen::Vector3d omega_B, alpha_B, specific_force_B;
};

/// Generalised coordinates: the base's translation and rotation (6, along B), then the joints in joint order.
using GeneralizedVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 6 + kMaxJoints, 1>;
using WrenchJacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 6 + kMaxJoints>;

class RobotDynamics {
 public:
  /// Throws std::runtime_error when the IMU isn't on the base link.
  explicit RobotDynamics(const model::RobotModel& robot);

  /// What drives and contacts together have to do, without armatures and joint friction: force and moment on the base
  /// [N, Nm], joint torques [Nm].
  GeneralizedVector required(const RobotMotion& motion);

  /// For what follows, as required() does.
  void take_posture(const JointVector& q);

  /// At the posture taken last: motion of the body's place (B axes, linear then angular).
  WrenchJacobian jacobian_of_link(int body) const;
  WrenchJacobian jacobian_of_center(int body) const;
  Eigen::Matrix3d rotation(int body) const;  ///< R_BL
  Eigen::Vector3d origin(int body) const;    ///< p_BL

  /// What these joint torques alone do to the acceleration at the IMU's place, of a robot in the air [m/s^2, B axes].
  Eigen::Vector3d imu_acceleration(const JointVector& q, const JointVector& torque_Nm);

  int body(const std::string& link) const;  ///< throws std::invalid_argument when there is none
  double mass_kg(int body) const { return model_->body_mass[body]; }
  /// From here on: mass added at the link's centre of mass, and how far that is moved. Replaces what was set before.
  void set_link(int body, double mass_factor, double added_kg, const Eigen::Vector3d& center_shift_m);

 private:
  WrenchJacobian jacobian(int body, const mjtNum* point) const;

  struct FreeModel {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
  };
  struct FreeData {
    void operator()(mjData* data) const { mj_deleteData(data); }
  };
  std::unique_ptr<mjModel, FreeModel> model_, nominal_;
  std::unique_ptr<mjData, FreeData> data_;
  Eigen::Vector3d p_BI_;
  std::vector<int> qpos_address_, dof_address_;
};

}  // namespace pmg::robot_diagnosis
