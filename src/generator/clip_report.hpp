// The figures of a clip library that an engineer checks before it goes to a robot.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "generator/gait_measure.hpp"
#include "model/robot_model.hpp"
#include "pmg/clip.hpp"

namespace pmg::generator {

/// A dynamic clip, blended with standing at one gain.
struct GainReport {
  double gain = 1.0;
  GroundMeasure ground;
  Eigen::Vector3d velocity_error = Eigen::Vector3d::Zero();  ///< mean velocity - gain * full velocity: m/s, m/s, rad/s
};

struct ClipReport {
  std::string name;
  double period_s = 0.0, duty_factor = 0.0;
  std::vector<GainReport> gains;
  double joint_speed_share = 0.0;  ///< of the joints' limits, largest
  double limit_margin_rad = 0.0;   ///< smallest distance from a joint limit
  std::string failure;             ///< empty if the clip passes
};

/// Every dynamic clip at gains 0.1 to 1. A clip fails if one of these holds: double-support slip over 3 cm/s on average
/// or 10 cm/s at the 95th percentile; stance feet more than 1 cm apart in height; mean velocity off by more than 0.05
/// (m/s, rad/s); a swinging sole more than 6 mm below the ground, or at full gain less than 2.5 cm above it in mid
/// swing or 1 cm from 0.7 to 0.85 of it (lower, a leg that sags a little lands early); soles closer than 2 cm; a joint
/// faster than 60 % of its limit.
std::vector<ClipReport> report(const model::RobotModel& robot, const ClipLibrary& library);

/// Agreement of a walking clip's left leg with a published mean; the offset counts.
struct NormReport {
  std::string curve;
  double correlation = 0.0, rms_deg = 0.0;
  double at_contact_deg = 0.0;  ///< flexion at initial contact
};

/// norms: empty for the means that the forward clip is made from (published_gait.hpp), or a CSV of 101 rows (0 .. 100 %
/// of the cycle) with columns hip_flexion_mean, knee_flexion_mean, ankle_dorsiflexion_mean and pelvis_tilt_ant+_mean,
/// in degrees. Throws files::ConfigError.
std::vector<NormReport> compare_with_norms(const model::RobotModel& robot, const DynamicClip& forward,
                                           const std::filesystem::path& norms);

/// How far a walking clip's left sole stands on its heel in the mean of 10 to 30 % of the cycle, where people's feet
/// lie flat: thigh flexion - knee flexion + ankle dorsiflexion [deg]. A robot's foot lies flat on the floor there,
/// whatever the clip says.
struct SoleReport {
  double toes_up_deg = 0.0, published_toes_up_deg = 0.0;
};
/// norms: as of compare_with_norms.
SoleReport compare_sole_with_norms(const model::RobotModel& robot, const DynamicClip& forward,
                                   const std::filesystem::path& norms);

}  // namespace pmg::generator
