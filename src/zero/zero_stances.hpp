// Postures in which a robot that somebody steadies shows its joints' zero points, and what makes it take them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "model/robot_model.hpp"

namespace pmg::zero {

/// Where one sole is, level, against the standing posture.
struct SolePlace {
  double forward_m = 0.0, outward_m = 0.0, turned_out_rad = 0.0;
};

/// Both soles level and equally high, the pelvis above them, the torso upright.
struct ZeroStance {
  std::string text;
  double drop_m = 0.0;  ///< pelvis below its standing height
  double pelvis_roll_rad = 0.0, pelvis_pitch_rad = 0.0;
  PerFoot<SolePlace> soles;
};

/// Strides, squats, straddles, tilted pelvis. Unequal legs are the point of it: where both legs do the same, a hip's
/// offset and the opposite one of its ankle only move the pelvis, which neither IMU nor ground can see.
std::vector<ZeroStance> zero_stances();

/// All joints of the stance; those that it doesn't need stand. Throws std::invalid_argument when a joint can't.
JointVector posture(const ZeroStance& stance, const model::RobotModel& robot);

/// Those that the robot can take. Throws std::invalid_argument when they are too few to calibrate by.
std::vector<ZeroStance> reachable_stances(const model::RobotModel& robot);

/// The joints that turn the sole of a leg whose knee is given: its last two. They go soft, so that soles lie flat
/// whatever the offsets.
std::vector<int> sole_joints(const model::RobotModel& robot);

/// Makes a robot folder in which the height command calls up one stance after the other and the sole joints are soft,
/// and scenario.yaml, in which the gantry sets the robot down in each: what pmg_sil and pmg_controller take the logs
/// with. Throws std::invalid_argument or what copying files throws.
void write_zero_rig(const model::RobotModel& robot, const std::filesystem::path& out);

}  // namespace pmg::zero
