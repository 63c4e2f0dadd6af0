// Inverse dynamics of a robot from its IMU and encoders alone, by MuJoCo's recursive Newton-Euler.
#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "model/robot_model.hpp"
#include "pmg/types.hpp"

namespace pmg::robot_diagnosis {

/// Motion of the joints (rad, rad/s, rad/s^2) and of the base, in the base frame B. The specific force is an
/// accelerometer's reading at the IMU's position; it contains gravity, so no attitude is needed.
struct RobotMotion {
  JointVector q, dq, ddq;
  Eigen::Vector3d omega_B, alpha_B, specific_force_B;
};

/// Generalised coordinates: the base's translation and rotation (6, along B), then the joints in joint order.
using GeneralizedVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 6 + kMaxJoints, 1>;
using WrenchJacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 6 + kMaxJoints>;

class RobotDynamics {
 public:
  /// Throws std::runtime_error if the IMU is not on the base link.
  explicit RobotDynamics(const model::RobotModel& robot);

  /// (motion) => (generalised force of drives and contacts together, without armatures and joint friction): force and
  /// moment on the base [N, Nm, B axes], joint torques [Nm].
  GeneralizedVector required(const RobotMotion& motion);

  /// Sets the posture of the functions below; required() does so, too.
  void take_posture(const JointVector& q);

  /// At that posture: Jacobian of the body's frame origin or centre of mass (B axes, linear, then angular).
  WrenchJacobian jacobian_of_link(int body) const;
  WrenchJacobian jacobian_of_center(int body) const;
  Eigen::Matrix3d rotation(int body) const;  ///< R_BL
  Eigen::Vector3d origin(int body) const;    ///< p_BL

  /// Acceleration at the IMU that these joint torques alone cause on a free-floating robot [m/s^2, B axes].
  Eigen::Vector3d imu_acceleration(const JointVector& q, const JointVector& torque_Nm);

  int body(const std::string& link) const;  ///< throws std::invalid_argument if there is none
  double mass_kg(int body) const { return model_->body_mass[body]; }
  /// Changes a link for the following calls: mass factor, mass added at its centre of mass, shift of that centre.
  /// Replaces the link's earlier change.
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
