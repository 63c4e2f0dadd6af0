// The posture that a robot stands in where its clips say another one than robot.yaml.
#pragma once

#include <filesystem>
#include <string>

#include "model/robot_model.hpp"
#include "pmg/types.hpp"

namespace pmg::model {

/// The posture that a library's posture clips have at command 0, joint by joint [rad]. Throws ConfigError,
/// also where left and right aren't mirror images.
JointVector standing_posture(const std::filesystem::path& clips, const RobotModel& robot);

/// (robot, standing posture [rad] within its limits) => the same robot, which stands so. A joint that sat down where it
/// stood does so still.
RobotModel standing_as(RobotModel robot, const JointVector& q_stand);

/// (name or folder, clips) => the robot, which stands as these clips do; clips empty: as robot.yaml says. Throws
/// ConfigError.
RobotModel load_robot_standing_as(const std::string& robot, const std::filesystem::path& clips);

}  // namespace pmg::model
