#include "generator/upper_body.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "generator/published_gait.hpp"
#include "pmg/types.hpp"

namespace pmg::generator {
namespace {

void swing_arm(const JointRoles& roles, const UpperBody& body, Foot side, double own_phase, JointVector& q) {
  const PublishedGait& gait = published_gait();
  const double flexion = gait.shoulder_flexion.at_rad(own_phase) - gait.shoulder_flexion.mean_deg * kRadPerDegree;
  const double bend = gait.elbow_flexion.at_rad(own_phase) - gait.elbow_flexion.mean_deg * kRadPerDegree;
  if (roles.shoulder_pitch[side]) {
    q[*roles.shoulder_pitch[side]] -= body.arm_swing * flexion;
  }
  if (roles.elbow[side]) {
    constexpr double kBend_rad = 0.12;  // walking bends the elbows a little more than standing
    q[*roles.elbow[side]] -= body.arm_swing * bend + std::abs(body.arm_swing) * kBend_rad;
  }
}

}  // namespace

void move_upper_body(const JointRoles& roles, const UpperBody& body, double phase, JointVector& q) {
  for (const Foot side : {kLeft, kRight}) {
    q[roles.leg[side][kHipPitch]] -= body.pelvis_tilt_rad;
    swing_arm(roles, body, side, side == kLeft ? phase : phase + 0.5, q);
  }
  // The torso is upright in the heading frame, turned by its yaw. With R_HB = Rx(roll) Ry(tilt) the waist joints (a, b,
  // c) follow from R_BT = Ry(-tilt) Rx(-roll) Rz(yaw) = Rz(a) Rx(b) Ry(c).
  const double yaw = body.torso_yaw_rad * std::cos(2.0 * std::numbers::pi * phase);
  const double roll = body.pelvis_roll_rad ? body.pelvis_roll_rad(phase) : 0.0;
  const Eigen::Matrix3d R_BT =
      (Eigen::AngleAxisd(-body.pelvis_tilt_rad, Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(-roll, Eigen::Vector3d::UnitX()) * Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()))
          .toRotationMatrix();
  if (roles.waist_yaw && roles.waist_roll && roles.waist_pitch) {
    q[*roles.waist_yaw] += std::atan2(-R_BT(0, 1), R_BT(1, 1));
    q[*roles.waist_roll] += std::asin(R_BT(2, 1));
    q[*roles.waist_pitch] += std::atan2(-R_BT(2, 0), R_BT(2, 2));
  }
  if (roles.head_yaw) {
    q[*roles.head_yaw] += body.gaze_yaw_rad - yaw;
  }
}

}  // namespace pmg::generator
