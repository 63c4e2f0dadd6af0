// Postures for zero calibration of a steadied robot, and the files with which it takes them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "model/robot_model.hpp"

namespace pmg::zero {

/// Position of one level sole relative to the standing posture.
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

/// Strides, squats, straddles, tilted pelvis. The legs differ on purpose: with equal legs, an offset of the hips and
/// the opposite offset of the ankles only move the pelvis, which neither IMU nor ground can observe.
std::vector<ZeroStance> zero_stances();

/// (stance, robot) => (angles of all joints [rad]; unused joints as in the standing posture). Throws
/// std::invalid_argument if a joint's range does not allow the stance.
JointVector posture(const ZeroStance& stance, const model::RobotModel& robot);

/// The stances that the robot can take. Throws std::invalid_argument if they are too few for a calibration.
std::vector<ZeroStance> reachable_stances(const model::RobotModel& robot);

/// The last two joints of each leg, which turn its sole. Their gains are low, so that soles lie flat despite offsets.
std::vector<int> sole_joints(const model::RobotModel& robot);

/// Writes a robot folder for pmg_sil and pmg_controller in which the height command selects the stance and the sole
/// joints are soft, and scenario.yaml, in which the gantry sets the robot down in each stance. Throws
/// std::invalid_argument, or the errors of writing files.
void write_zero_rig(const model::RobotModel& robot, const std::filesystem::path& out);

}  // namespace pmg::zero
