#include "can/plumb.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "pmg/types.hpp"

namespace pmg::can {

Eigen::Quaterniond link_in_base(const model::RobotModel& robot, const std::string& link, const JointVector& q) {
  KDL::Chain chain;
  KDL::Rotation rotation = KDL::Rotation::Identity();
  if (link != robot.base_link && robot.tree.getChain(robot.base_link, link, chain)) {
    for (const KDL::Segment& segment : chain.segments) {
      const auto joint = robot.joint_index.find(segment.getJoint().getName());
      rotation = rotation * segment.pose(joint ? q[*joint] : 0.0).M;
    }
  }
  Eigen::Quaterniond R_BL;
  rotation.GetQuaternion(R_BL.x(), R_BL.y(), R_BL.z(), R_BL.w());
  return R_BL;
}

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
  const Eigen::Quaterniond R_BI =
      link_in_base(robot_, robot_.imu.link, q) * Eigen::Quaterniond(robot_.imu.T_LI.linear());
  return Sample{.down_B = R_BI * -state.acceleration_m_s2.normalized(),
                .base_WB = state.orientation_WI * R_BI.conjugate()};
}

void PlumbMean::add(const std::optional<Plumb::Sample>& sample) {
  whole_ = whole_ && sample.has_value();
  if (!sample) return;
  down_B_ += sample->down_B;
  const Eigen::Vector4d coefficients = sample->base_WB.coeffs();
  base_WB_ += base_WB_.dot(coefficients) < 0.0 ? Eigen::Vector4d(-coefficients) : coefficients;
}

std::optional<Plumb::Sample> PlumbMean::mean() const {
  if (!whole_ || base_WB_.isZero()) return std::nullopt;
  return Plumb::Sample{.down_B = down_B_.normalized(),
                       .base_WB = Eigen::Quaterniond(Eigen::Vector4d(base_WB_.normalized()))};
}

Eigen::Vector3d turned_rad(const Plumb::Sample& from, const Plumb::Sample& to) {
  const Eigen::AngleAxisd turn(from.base_WB.conjugate() * to.base_WB);
  return std::remainder(turn.angle(), 2.0 * std::numbers::pi) * turn.axis();
}

}  // namespace pmg::can
