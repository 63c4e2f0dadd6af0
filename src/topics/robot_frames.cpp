#include "topics/robot_frames.hpp"

#include <algorithm>
#include <limits>

namespace pmg::topics {

namespace {

Eigen::Isometry3d eigen(const KDL::Frame& frame) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  for (int row = 0; row < 3; ++row) {
    T.translation()[row] = frame.p(row);
    for (int column = 0; column < 3; ++column) T.linear()(row, column) = frame.M(row, column);
  }
  return T;
}

}  // namespace

RobotFrames::RobotFrames(const model::RobotModel& robot) : robot_(robot) {
  const auto root = robot_.tree.getRootSegment();
  frames_.push_back({kWorldFrame, root->first});
  for (const auto& [name, element] : robot_.tree.getSegments()) {
    if (name == root->first) continue;
    segments_.push_back(&GetTreeElementSegment(element));
    frames_.push_back({GetTreeElementParent(element)->first, name});
  }
}

KDL::Frame RobotFrames::pose(const KDL::Segment& segment, const std::vector<double>& q_rad) const {
  const auto joint = robot_.joint_index.find(segment.getJoint().getName());
  return segment.pose(joint ? q_rad.at(static_cast<std::size_t>(*joint)) : 0.0);
}

const std::vector<RobotFrames::Frame>& RobotFrames::at(const std::vector<double>& q_rad,
                                                       const Eigen::Isometry3d& T_WB) {
  frames_.front().p = T_WB.translation();
  frames_.front().q = Eigen::Quaterniond(T_WB.linear());
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const Eigen::Isometry3d T = eigen(pose(*segments_[i], q_rad));
    frames_[i + 1].p = T.translation();
    frames_[i + 1].q = Eigen::Quaterniond(T.linear());
  }
  return frames_;
}

Eigen::Isometry3d RobotFrames::link_in_base(const std::string& link, const std::vector<double>& q_rad) const {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  for (auto at = robot_.tree.getSegment(link); at != robot_.tree.getRootSegment();
       at = GetTreeElementParent(at->second)) {
    T = eigen(pose(GetTreeElementSegment(at->second), q_rad)) * T;
  }
  return T;
}

Eigen::Isometry3d RobotFrames::standing_base(const std::vector<double>& q_rad, const Eigen::Quaterniond& q_WI) const {
  Eigen::Isometry3d T_WB = Eigen::Isometry3d::Identity();
  const Eigen::Isometry3d T_BI = link_in_base(robot_.imu.link, q_rad) * robot_.imu.T_LI;
  T_WB.linear() = q_WI.normalized().toRotationMatrix() * T_BI.linear().transpose();
  double lowest_m = std::numeric_limits<double>::infinity();
  for (const model::FootModel& foot : robot_.feet) {
    const Eigen::Isometry3d T_WF = T_WB * link_in_base(foot.link, q_rad);
    for (const Eigen::Vector3d& corner_F : foot.sole_corners_F()) lowest_m = std::min(lowest_m, (T_WF * corner_F).z());
  }
  T_WB.translation().z() = -lowest_m;
  return T_WB;
}

}  // namespace pmg::topics
