#include "generator/joint_roles.hpp"

#include "files/config_error.hpp"

namespace pmg::generator {
namespace {

constexpr PerFoot<const char*> kSide = {"left_", "right_"};

int leg_joint(const model::RobotModel& robot, std::size_t foot, const char* role) {
  const std::string name = std::string(kSide[foot]) + role;
  const std::optional<int> joint = robot.joint_index.find(name);
  if (!joint) {
    throw files::ConfigError((robot.directory / "robot.yaml").string() + ": " + name +
                             ": no such joint; expected legs with hip_pitch, hip_roll, hip_yaw, knee, ankle_pitch and "
                             "ankle_roll, which clips are made for");
  }
  return *joint;
}

}  // namespace

JointRoles find_joint_roles(const model::RobotModel& robot) {
  JointRoles roles;
  for (const Foot foot : {kLeft, kRight}) {
    for (std::size_t role = 0; role < kLegJoints; ++role) {
      roles.leg[foot][role] = leg_joint(robot, foot, kLegRoleNames[role]);
    }
    if (robot.leg_joints[foot].size() != kLegJoints) {
      throw files::ConfigError((robot.directory / "robot.yaml").string() + ": feet: the leg to " +
                               robot.feet[foot].link + " has " + std::to_string(robot.leg_joints[foot].size()) +
                               " joints; expected " + std::to_string(kLegJoints));
    }
    const std::string side = kSide[foot];
    roles.shoulder_pitch[foot] = robot.joint_index.find(side + "shoulder_pitch");
    roles.shoulder_roll[foot] = robot.joint_index.find(side + "shoulder_roll");
    roles.elbow[foot] = robot.joint_index.find(side + "elbow");
  }
  roles.waist_yaw = robot.joint_index.find("waist_yaw");
  roles.waist_roll = robot.joint_index.find("waist_roll");
  roles.waist_pitch = robot.joint_index.find("waist_pitch");
  roles.head_yaw = robot.joint_index.find("head_yaw");
  roles.head_pitch = robot.joint_index.find("head_pitch");
  return roles;
}

}  // namespace pmg::generator
