// randomization.yaml: the ranges that simulated robots are drawn from, in evaluation and in training.
#pragma once

#include <filesystem>

namespace pmg::sim {

/// A uniform distribution.
struct Range {
  double lower = 0.0, upper = 0.0;
};

/// Distributions of a variation; the format is that of training/randomization.yaml.
struct VariationRanges {
  Range friction{0.8, 0.8};  ///< sole on floor
  Range torso_mass_kg;
  double torso_center_of_mass_m = 0.0;  ///< +- on each axis
  Range hand_payload_kg;                ///< per hand, on a payload_share of the robots
  double payload_share = 0.0;
  Range link_mass_factor{1.0, 1.0};
  Range armature_factor{1.0, 1.0}, joint_friction_factor{1.0, 1.0}, kp_factor{1.0, 1.0}, kd_factor{1.0, 1.0};
  Range delay_s;
  double encoder_offset_rad = 0.0;  ///< +-
  /// Half widths of uniform distributions; a world's noise is normal with the same standard deviation (width / sqrt 3).
  double gyro_noise_rad_s = 0.0, gravity_direction_noise = 0.0, encoder_noise_rad = 0.0, velocity_noise_rad_s = 0.0;
};

/// Reads a YAML of the keys of training/randomization.yaml. A key that the file lacks leaves the model's value. The
/// groups `kicks` and `upper_body` are checked, but only training uses them. Throws files::ConfigError.
VariationRanges load_variation_ranges(const std::filesystem::path& file);

/// The same checks for a training: every key must be in the file. Throws files::ConfigError.
void check_training_ranges(const std::filesystem::path& file);

}  // namespace pmg::sim
