// Published mean joint curves over the gait cycle.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace pmg::evaluation {

enum GaitJoint : std::size_t { kHip, kKneeFlexion, kAnkle, kGaitJoints };
inline constexpr std::array<const char*, kGaitJoints> kGaitJointNames = {"hip flexion", "knee flexion",
                                                                         "ankle dorsiflexion"};

inline constexpr std::size_t kCyclePoints = 100;  ///< 0 to 99 % of the cycle, from initial contact of the same foot

/// Degrees at kCyclePoints. Hip flexion is that of the thigh against the vertical: hip flexion minus pelvic tilt.
struct GaitNorms {
  std::string source;
  std::array<std::vector<double>, kGaitJoints> deg;
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

}  // namespace pmg::evaluation
