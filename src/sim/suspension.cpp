#include "sim/suspension.hpp"

#include <algorithm>
#include <cmath>

#include "pmg/types.hpp"

namespace pmg::sim {

namespace {

constexpr double kSway_m = 0.06;  // horizontal deflection under a force equal to the robot's weight
constexpr double kDampingRatio = 0.7;
constexpr double kRotationDamping_s = 0.15;  // damping over stiffness: at rest within about half a second

double yaw(const Eigen::Quaterniond& q) {
  return std::atan2(2.0 * (q.w() * q.z() + q.x() * q.y()), 1.0 - 2.0 * (q.y() * q.y() + q.z() * q.z()));
}

double damping(double mass, double stiffness) { return 2.0 * kDampingRatio * std::sqrt(mass * stiffness); }

}  // namespace

Suspension::Suspension(double total_mass_kg, double standing_height_m) {
  const double weight_N = total_mass_kg * kGravity_m_s2;
  stiffness_z_N_m_ = weight_N / kSag_m;
  damping_z_N_s_m_ = damping(total_mass_kg, stiffness_z_N_m_);
  stiffness_xy_N_m_ = weight_N / kSway_m;
  damping_xy_N_s_m_ = damping(total_mass_kg, stiffness_xy_N_m_);
  stiffness_Nm_rad_ = weight_N * standing_height_m;
  damping_Nm_s_rad_ = kRotationDamping_s * stiffness_Nm_rad_;
}

void Suspension::set_ground_place(const Eigen::Vector3d& p_WT, double yaw_rad) {
  ground_height_m_ = p_WT.z();
  anchor_W_ = p_WT;
  anchor_yaw_rad_ = yaw_rad;
  anchored_ = true;
}

void Suspension::set(double lift_m, double engaged) noexcept {
  lift_m_ = lift_m;
  engaged_ = std::clamp(engaged, 0.0, 1.0);
}

void Suspension::apply(const mjModel* model, mjData* data, int torso_body) noexcept {
  if (engaged_ == 0.0) {
    anchored_ = false;
    return;
  }
  const Eigen::Map<const Eigen::Vector3d> p(data->xipos + 3 * torso_body);
  const mjtNum* xquat = data->xquat + 4 * torso_body;
  const Eigen::Quaterniond q(xquat[0], xquat[1], xquat[2], xquat[3]);
  mjtNum velocity[6];  // rotational, then linear, at the body's centre of mass in world axes
  mj_objectVelocity(model, data, mjOBJ_BODY, torso_body, velocity, 0);
  const Eigen::Map<const Eigen::Vector3d> omega(velocity), v(velocity + 3);
  if (!anchored_) {
    anchor_W_ = p;
    anchor_yaw_rad_ = yaw(q);
    anchored_ = true;
  }
  anchor_W_.z() = ground_height_m_ + lift_m_;

  Eigen::Vector3d force = stiffness_xy_N_m_ * (anchor_W_ - p) - damping_xy_N_s_m_ * v;
  force.z() = stiffness_z_N_m_ * (anchor_W_.z() - p.z()) - damping_z_N_s_m_ * v.z();
  force.z() = std::max(0.0, force.z());  // a rope pulls, it doesn't push

  const Eigen::Quaterniond upright(Eigen::AngleAxisd(anchor_yaw_rad_, Eigen::Vector3d::UnitZ()));
  const Eigen::AngleAxisd error(upright * q.conjugate());
  const Eigen::Vector3d torque = stiffness_Nm_rad_ * error.angle() * error.axis() - damping_Nm_s_rad_ * omega;

  Eigen::Map<Eigen::Vector3d>(data->xfrc_applied + 6 * torso_body) += engaged_ * force;
  Eigen::Map<Eigen::Vector3d>(data->xfrc_applied + 6 * torso_body + 3) += engaged_ * torque;
}

}  // namespace pmg::sim
