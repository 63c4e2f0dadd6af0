#include "can/plumb.hpp"

#include <array>
#include <cmath>
#include <span>

#include "pmg/types.hpp"

namespace pmg::can {

namespace {

/// (joints) => the IMU in the base.
Eigen::Quaterniond imu_in_base(const model::RobotModel& robot, const JointVector& q) {
  KDL::Chain chain;
  KDL::Rotation rotation = KDL::Rotation::Identity();
  if (robot.imu.link != robot.base_link && robot.tree.getChain(robot.base_link, robot.imu.link, chain)) {
    for (const KDL::Segment& segment : chain.segments) {
      const auto joint = robot.joint_index.find(segment.getJoint().getName());
      rotation = rotation * segment.pose(joint ? q[*joint] : 0.0).M;
    }
  }
  Eigen::Quaterniond R_BL;
  rotation.GetQuaternion(R_BL.x(), R_BL.y(), R_BL.z(), R_BL.w());
  return R_BL * Eigen::Quaterniond(robot.imu.T_LI.linear());
}

}  // namespace

std::optional<Plumb::Sample> Plumb::sample(const JointVector& q) {
  imu_.begin_cycle();
  std::array<drives::Message, 64> messages;
  while (const std::size_t count = link_ != nullptr ? link_->receive(messages) : 0) {
    for (const drives::Message& message : std::span(messages).first(count)) hear(message);
  }
  if (imu_.age_cycles() > XsensImu::kSilentCycles) return std::nullopt;
  model::RobotState state;
  imu_.read(state);
  constexpr double kRest = 0.25;
  if (std::abs(state.acceleration_m_s2.norm() / kGravity_m_s2 - 1.0) > kRest) return std::nullopt;
  const Eigen::Quaterniond R_BI = imu_in_base(robot_, q);
  return Sample{.down_B = R_BI * -state.acceleration_m_s2.normalized(),
                .base_WB = state.orientation_WI * R_BI.conjugate()};
}

}  // namespace pmg::can
