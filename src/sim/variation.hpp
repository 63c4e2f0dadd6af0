// How a simulated robot and its ground differ from the model: what no drawing tells, and what changes from day to day.
#pragma once

#include <mujoco/mujoco.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "model/robot_model.hpp"
#include "pmg/types.hpp"
#include "sim/actuator_parameters.hpp"

namespace pmg::sim {

struct WorldOptions;

/// Friction and sensor noise are WorldOptions' own; this is the rest. Empty vectors and maps change nothing. Factors
/// multiply what robot.yaml and the URDF say; vectors are in joint order.
struct Variation {
  std::map<std::string, double> link_mass_factor;                    ///< by link; its inertia scales alike
  double torso_mass_kg = 0.0;                                        ///< added at the torso's centre of mass
  Eigen::Vector3d torso_center_of_mass_m = Eigen::Vector3d::Zero();  ///< shift in the torso's frame
  PerFoot<double> hand_payload_kg{};                                 ///< left and right, at the hand's centre of mass
  JointVector armature_factor, joint_friction_factor;                ///< rotor inertia; dry friction
  JointVector kp_factor, kd_factor;  ///< of what the drives make of the gains that they are given
  JointVector encoder_offset_rad;    ///< what encoders show too much; the drives go by them too
  double delay_s = 0.0;              ///< from the command to the torque: whole physics steps, rounded
};

/// A uniform distribution.
struct Range {
  double lower = 0.0, upper = 0.0;
};

/// What a variation is drawn from; the format of training/randomization.yaml.
struct VariationRanges {
  Range friction{0.8, 0.8};  ///< sole on floor
  Range torso_mass_kg;
  double torso_center_of_mass_m = 0.0;  ///< +- on each axis
  Range hand_payload_kg;                ///< a hand each, on a payload_share of the robots
  double payload_share = 0.0;
  Range link_mass_factor{1.0, 1.0};
  Range armature_factor{1.0, 1.0}, joint_friction_factor{1.0, 1.0}, kp_factor{1.0, 1.0}, kd_factor{1.0, 1.0};
  Range delay_s;
  double encoder_offset_rad = 0.0;  ///< +-
  /// Half widths of uniform distributions; a world's noise is normal with the same standard deviation (width / sqrt 3).
  double gyro_noise_rad_s = 0.0, gravity_direction_noise = 0.0, encoder_noise_rad = 0.0, velocity_noise_rad_s = 0.0;
};

/// Reads a YAML of the keys of training/randomization.yaml; what it doesn't name stays as the model has it. Its kicks
/// and upper_body belong to training alone and are passed over. Throws model::ConfigError.
VariationRanges load_variation_ranges(const std::filesystem::path& file);

/// Sets friction, sensor noise and everything else of the world, and the seed of its noise. Same ranges, robot and
/// seed: same world, on every machine. Throws std::invalid_argument when a payload is drawn for a robot without hands.
void vary(WorldOptions& options, const VariationRanges& ranges, const model::RobotModel& robot, std::uint64_t seed);

/// The links that hold what hands hold: on each side the last that moves of the longest chain that hangs on the torso.
/// Throws std::invalid_argument when a side has none.
PerFoot<std::string> hand_links(const model::RobotModel& robot);

/// Throws std::invalid_argument for a vector of another size than the robot's joints.
void expect_joints(const Variation& variation, const model::RobotModel& robot);

/// That joint's actuator as it varies: gains, rotor inertia and dry friction times their factors, the encoder's offset
/// added.
ActuatorParameters varied(ActuatorParameters actuator, const Variation& variation, Eigen::Index joint);

/// Writes masses and inertias into a compiled model; MuJoCo's derived constants follow. data is scratch: reset it
/// afterwards. Throws std::invalid_argument for a link that the model doesn't have.
void apply(const Variation& variation, const model::RobotModel& robot, mjModel* model, mjData* data);

}  // namespace pmg::sim
