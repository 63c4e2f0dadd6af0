// Joint curves over the gait cycle: those of people, published, and how near others come to them.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "generator/joint_roles.hpp"

namespace pmg::generator {

enum GaitJoint : std::size_t { kHip, kKneeFlexion, kAnkle, kGaitJoints };
inline constexpr std::array<const char*, kGaitJoints> kGaitJointNames = {"hip flexion", "knee flexion",
                                                                         "ankle dorsiflexion"};

inline constexpr std::size_t kCyclePoints = 100;  ///< 0 to 99 % of the cycle, from initial contact of the same foot

/// Degrees at kCyclePoints. Hip flexion is that of the thigh against the vertical: hip flexion minus pelvic tilt.
struct GaitNorms {
  std::string source;
  std::array<std::vector<double>, kGaitJoints> deg;
  std::vector<double> pelvic_tilt_deg;  ///< anterior
  /// One standard deviation between persons, rms over the cycle. Of files without columns ..._sd that of the built-in
  /// norms.
  std::array<double, kGaitJoints> deviation_deg{};
};

/// The curves from which the forward clip is made (generator/published_gait.hpp).
GaitNorms built_in_norms();

/// CSV with a header line; lines that begin with # are skipped. Columns hip_flexion..._mean, knee_flexion..._mean,
/// ankle_dorsiflexion..._mean and pelvis_tilt..._mean in degrees, at equal steps from 0 to 100 % of the cycle; ..._sd
/// of the first three as far as they are there. Throws files::ConfigError.
GaitNorms load_norms(const std::filesystem::path& file);

/// Those of the file; the built-in ones if none is named.
GaitNorms norms_of(const std::filesystem::path& file);

/// Flexions [deg] of thigh, knee and ankle; positive as in gait analysis. The thigh's is against the vertical, as the
/// norms': the hip joint's less the pelvis' forward pitch.
std::array<double, kGaitJoints> flexions_deg(const JointVector& q, const std::array<int, kLegJoints>& leg,
                                             double pelvis_pitch_rad);

/// Correlation and RMS differences of two curves of equal length.
struct CurveAgreement {
  double correlation = 0.0;
  double rms_deg = 0.0;
  double shape_rms_deg = 0.0;  ///< RMS after both means are subtracted
};
CurveAgreement agreement(const std::vector<double>& ours, const std::vector<double>& published);

}  // namespace pmg::generator
