#include "generator/leg_geometry.hpp"

#include <algorithm>
#include <vector>

#include "files/config_error.hpp"

namespace pmg::generator {
namespace {

Eigen::Isometry3d to_eigen(const urdf::Pose& pose) {
  Eigen::Quaterniond rotation;
  pose.rotation.getQuaternion(rotation.x(), rotation.y(), rotation.z(), rotation.w());
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = rotation.toRotationMatrix();
  T.translation() = Eigen::Vector3d(pose.position.x, pose.position.y, pose.position.z);
  return T;
}

std::vector<urdf::JointConstSharedPtr> joints_from_base(const model::RobotModel& robot, const std::string& foot_link) {
  std::vector<urdf::JointConstSharedPtr> joints;
  for (urdf::LinkConstSharedPtr link = robot.urdf->getLink(foot_link); link && link->name != robot.base_link;
       link = link->getParent()) {
    joints.push_back(link->parent_joint);
  }
  std::reverse(joints.begin(), joints.end());
  return joints;
}

}  // namespace

LegGeometry leg_geometry(const model::RobotModel& robot, const JointRoles& roles, Foot foot) {
  LegGeometry leg;
  Eigen::Isometry3d since_last_joint = Eigen::Isometry3d::Identity();
  std::size_t found = 0;
  for (const urdf::JointConstSharedPtr& joint : joints_from_base(robot, robot.feet[foot].link)) {
    since_last_joint = since_last_joint * to_eigen(joint->parent_to_joint_origin_transform);
    if (joint->type == urdf::Joint::FIXED) {
      continue;
    }
    const auto role = std::find(roles.leg[foot].begin(), roles.leg[foot].end(), robot.joint_index.at(joint->name));
    if (role == roles.leg[foot].end() || found == leg.segments.size()) {
      throw files::ConfigError(
          (robot.directory / "robot.yaml").string() + ": " + joint->name +
          ": has no part in a leg; expected hip_pitch, hip_roll, hip_yaw, knee, ankle_pitch or ankle_roll");
    }
    LegGeometry::Segment& segment = leg.segments[found++];
    segment.R = since_last_joint.linear();
    segment.p = since_last_joint.translation();
    segment.axis = robot.joints[static_cast<std::size_t>(*role)].axis;
    segment.role = static_cast<std::size_t>(role - roles.leg[foot].begin());
    since_last_joint.setIdentity();
  }
  const std::array<Eigen::Vector3d, 4> corners = robot.feet[foot].sole_corners_F();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    leg.sole[i] = since_last_joint * corners[i];
  }
  return leg;
}

}  // namespace pmg::generator
