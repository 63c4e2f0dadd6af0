// The gantry of a first start: springs and dampers hold the torso at an anchor that can be raised and lowered.
#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Geometry>

namespace pmg::sim {

class Suspension {
 public:
  /// standing_height_m: of the base. With the weight W: vertical stiffness W / kSag_m, horizontal W / 0.06 m,
  /// rotational W standing_height_m per rad.
  Suspension(double total_mass_kg, double standing_height_m);

  /// Sag of the suspension under the whole robot [m].
  static constexpr double kSag_m = 0.02;

  /// Centre of mass and heading of the torso when the robot stands on the ground.
  void set_ground_place(const Eigen::Vector3d& p_WT, double yaw_rad);
  /// lift_m: of the anchor above the torso's standing height; engaged in [0, 1]: see World::set_hoist.
  void set(double lift_m, double engaged) noexcept;
  /// Adds the suspension's force and torque on the torso to mjData.xfrc_applied.
  void apply(const mjModel* model, mjData* data, int torso_body) noexcept;

  double ground_height_m() const { return ground_height_m_; }  ///< of set_ground_place()
  bool engaged() const { return engaged_ > 0.0; }
  const Eigen::Vector3d& anchor_W() const { return anchor_W_; }

 private:
  double stiffness_z_N_m_, damping_z_N_s_m_;
  double stiffness_xy_N_m_, damping_xy_N_s_m_;
  double stiffness_Nm_rad_, damping_Nm_s_rad_;
  double ground_height_m_ = 0.0;
  Eigen::Vector3d anchor_W_ = Eigen::Vector3d::Zero();
  double anchor_yaw_rad_ = 0.0;
  double lift_m_ = 0.0, engaged_ = 0.0;
  bool anchored_ = false;
};

}  // namespace pmg::sim
