#include "faults/torso_attitude.hpp"

#include <cmath>

#include "model/link_chain.hpp"

namespace pmg::faults {

TorsoAttitude::TorsoAttitude(const model::RobotModel& robot)
    : imu_link_to_torso_(model::chain_between(robot, robot.imu.link, robot.torso_link)),
      R_LI_(robot.imu.T_LI.linear()) {}

double TorsoAttitude::error_rad(const model::RobotState& state, const RollPitchAim& aim) noexcept {
  imu_link_to_torso_.compute(state.q);
  const Eigen::Vector3d up_I = state.orientation_WI.conjugate() * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d up_T = imu_link_to_torso_.R().transpose() * (R_LI_ * up_I);
  // Of (Ry(pitch) Rx(roll))^T z.
  const Eigen::Vector3d aimed_T(-std::sin(aim.pitch_rad), std::cos(aim.pitch_rad) * std::sin(aim.roll_rad),
                                std::cos(aim.pitch_rad) * std::cos(aim.roll_rad));
  return std::atan2(up_T.cross(aimed_T).norm(), up_T.dot(aimed_T));
}

}  // namespace pmg::faults
