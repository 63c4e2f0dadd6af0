#include "model/leg_kinematics.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace pmg::model {

LegKinematics::LegKinematics(const RobotModel& robot)
    : chains_{ChainKinematics(robot.leg_chain[kLeft], robot.leg_joints[kLeft]),
              ChainKinematics(robot.leg_chain[kRight], robot.leg_joints[kRight])},
      sole_corners_F_{robot.feet[kLeft].sole_corners_F(), robot.feet[kRight].sole_corners_F()} {
  for (const Foot foot : {kLeft, kRight}) feet_[foot].J.setZero(6, static_cast<Eigen::Index>(chains_[foot].size()));
}

const PerFoot<FootKinematics>& LegKinematics::compute(const JointVector& q, const JointVector& dq) noexcept {
  for (const Foot side : {kLeft, kRight}) {
    ChainKinematics& chain = chains_[side];
    FootKinematics& foot = feet_[side];
    chain.compute(q);
    foot.R_BF = chain.R();
    foot.p_BF = chain.p();
    foot.v_BF.setZero();
    foot.omega_BF.setZero();
    for (std::size_t i = 0; i < chain.size(); ++i) {
      const Eigen::Vector3d& axis = chain.axis(i);
      const Eigen::Vector3d linear = axis.cross(foot.p_BF - chain.origin(i));
      const auto column = static_cast<Eigen::Index>(i);
      foot.J.col(column).head<3>() = linear;
      foot.J.col(column).tail<3>() = axis;
      const double rate = dq[chain.joint(i)];
      foot.v_BF += rate * linear;
      foot.omega_BF += rate * axis;
    }
    for (std::size_t corner = 0; corner < foot.sole_B.size(); ++corner) {
      foot.sole_B[corner] = foot.p_BF + foot.R_BF * sole_corners_F_[side][corner];
    }
  }
  return feet_;
}

BaseAttitude::BaseAttitude(const RobotModel& robot) : torso_(robot.torso_chain, robot.torso_joints) {}

BaseAttitude::Result BaseAttitude::compute(const JointVector& q, const JointVector& dq, double pitch_rad,
                                           double roll_rad, double pitch_rate_rad_s, double roll_rate_rad_s) noexcept {
  torso_.compute(q);
  const Eigen::Matrix3d R_pitch = Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const Eigen::Matrix3d R_roll = Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitX()).toRotationMatrix();

  // The base's attitude while the torso's yaw is zero. Turning it by minus its own yaw gives R_HB.
  const Eigen::Matrix3d R_turned = R_pitch * R_roll * torso_.R().transpose();
  const double norm = std::hypot(R_turned(0, 0), R_turned(1, 0));
  const double cosine = norm > 0.0 ? R_turned(0, 0) / norm : 1.0;
  const double sine = norm > 0.0 ? -R_turned(1, 0) / norm : 0.0;
  Eigen::Matrix3d R_yaw;
  R_yaw << cosine, -sine, 0.0, sine, cosine, 0.0, 0.0, 0.0, 1.0;

  Result result;
  result.R_HB = R_yaw * R_turned;

  // omega_HT = yaw rate * z + Rz(yaw) (pitch rate * y + Ry(pitch) roll rate * x), and omega_HB = omega_HT - omega_BT.
  // The free yaw rate sets the z component of omega_HB to zero; the other two don't depend on it.
  const Eigen::Vector3d omega_HT =
      R_yaw * (pitch_rate_rad_s * Eigen::Vector3d::UnitY() + roll_rate_rad_s * R_pitch.col(0));
  Eigen::Vector3d omega_BT_B = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < torso_.size(); ++i) omega_BT_B += dq[torso_.joint(i)] * torso_.axis(i);
  result.omega_HB_H = omega_HT - result.R_HB * omega_BT_B;
  result.omega_HB_H.z() = 0.0;
  return result;
}

}  // namespace pmg::model
