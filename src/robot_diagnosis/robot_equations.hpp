// Equations of motion with the contact forces of ground and gantry eliminated, linear in a robot's parameter errors.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "model/robot_model.hpp"
#include "robot_diagnosis/robot_dynamics.hpp"
#include "robot_diagnosis/robot_options.hpp"
#include "robot_diagnosis/robot_parameters.hpp"
#include "robot_diagnosis/robot_row.hpp"
#include "robot_diagnosis/robot_samples.hpp"

namespace pmg::robot_diagnosis {

/// Contact force on one foot, from its leg's torques.
struct FootForce {
  double normal_N = 0.0, tangential_N = 0.0;
};

class RobotEquations {
 public:
  /// The robot and the list must outlive it. Throws std::runtime_error if the IMU is not on the base link.
  RobotEquations(const model::RobotModel& robot, const RobotParameterList& list, const SupportOptions& support = {});

  Support support(const RobotSample& sample);
  std::vector<RobotRow> rows(const RobotSample& sample, Support support);

  /// Share of these joint torques in the accelerometer's reading while the feet are free [m/s^2, IMU axes].
  Eigen::Vector3d accelerometer_share(const JointVector& q, const JointVector& torque_Nm);

  /// The IMU's velocity while both soles rest, from the legs' kinematics [m/s, IMU axes].
  Eigen::Vector3d imu_velocity_on_resting_soles(const model::RobotState& state);

  PerFoot<FootForce> foot_forces(const RobotSample& sample);
  double foot_separation_speed_m_s(const RobotSample& sample);

  int kinds() const;
  std::string kind_name(int kind) const;
  int kind_of_joint(Support support, int joint) const;

 private:
  struct Change {  // of the assumed zero point or IMU mounting
    int joint = -1;
    double zero_offset_rad = 0.0;
    Eigen::Vector3d imu_rad = Eigen::Vector3d::Zero();
  };
  struct Legs {  // maps a leg's joint torques to the base rows after its foot's wrench is eliminated
    PerFoot<Eigen::Matrix<double, 6, 6>> to_base;
  };

  GeneralizedVector missing(const RobotSample& sample, const Change& change);
  Eigen::VectorXd values(const RobotSample& sample, Support support, const Change& change, Legs* legs = nullptr);
  Eigen::Matrix<double, 6, 6> leg_jacobian(const WrenchJacobian& foot, Foot side) const;
  Eigen::Matrix<double, 6, 1> foot_wrench(const GeneralizedVector& force, Foot side);
  std::vector<int> joints_of_rows(Support support) const;
  void add_column(int parameter, const Eigen::VectorXd& column, std::vector<RobotRow>& rows) const;
  Eigen::VectorXd torque_column(const RobotParameter& parameter, const RobotSample& sample, Support support,
                                const Legs& legs, const Eigen::VectorXd& nominal) const;
  Eigen::VectorXd link_column(const RobotParameter& parameter, const RobotSample& sample, Support support,
                              const Eigen::VectorXd& nominal);

  const model::RobotModel& robot_;
  const RobotParameterList& list_;
  const SupportOptions support_;
  RobotDynamics dynamics_;
  const int joints_;
  int torso_;
  PerFoot<int> foot_body_{};
  bool legs_of_six_;
  std::vector<bool> in_leg_, below_torso_;
};

}  // namespace pmg::robot_diagnosis
