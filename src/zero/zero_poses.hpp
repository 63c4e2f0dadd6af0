// Still poses from a robot's logs: mean readings of encoders, drives and IMU.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "model/robot_model.hpp"
#include "work/progress.hpp"

namespace pmg::zero {

/// Means over one still stretch, joints in the robot's order.
struct StillPose {
  std::string log;  ///< folder or file, as the caller named it
  double from_s = 0.0, to_s = 0.0;
  JointVector reading_rad;  ///< r of the paper
  JointVector torque_Nm;
  Eigen::Vector3d gravity_I = -Eigen::Vector3d::UnitZ();  ///< s of the paper: unit vector, from the IMU's attitude
};

struct StillnessOptions {
  double block_s = 0.2;              ///< averaging time of the compared readings
  double largest_change_rad = 4e-3;  ///< of any joint, and of the gravity direction, from one block to the next
  double settled_after_s = 0.6;      ///< beginning of a stretch to discard: the robot may still swing
  double shortest_s = 0.8;           ///< least duration of the rest
};

/// (logs: files or folders) => (their still poses, in order). Throws std::runtime_error if a log can't be read, has no
/// STATE, or is of a robot with other joints.
std::vector<StillPose> read_still_poses(const std::vector<std::filesystem::path>& logs, const model::RobotModel& robot,
                                        const StillnessOptions& options = {}, const work::Progress& progress = {});

}  // namespace pmg::zero
