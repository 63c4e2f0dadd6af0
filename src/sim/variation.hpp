// Differences of a simulated robot and its ground from the model: unknown ones, and ones that change from day to day.
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

/// Friction and sensor noise are in WorldOptions; all other differences are here. Empty vectors and maps change
/// nothing. Factors multiply the values of robot.yaml and the URDF. Vectors are in joint order.
struct Variation {
  std::map<std::string, double> link_mass_factor;                    ///< by link; multiplies its inertia too
  double torso_mass_kg = 0.0;                                        ///< added at the torso's centre of mass
  Eigen::Vector3d torso_center_of_mass_m = Eigen::Vector3d::Zero();  ///< shift in the torso's frame
  PerFoot<double> hand_payload_kg{};                   ///< left and right, at the centre of mass of the hand
  JointVector armature_factor, joint_friction_factor;  ///< rotor inertia; dry friction
  JointVector kp_factor, kd_factor;                    ///< real gains of the drives over commanded gains
  JointVector encoder_offset_rad;  ///< encoder reading minus true angle; the drives use the reading too
  double delay_s = 0.0;            ///< from the command to the torque; rounded to whole physics steps
};

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

/// Reads a YAML with the keys of training/randomization.yaml; missing keys leave the model as it is. The keys kicks and
/// upper_body concern only training and are ignored. Throws model::ConfigError.
VariationRanges load_variation_ranges(const std::filesystem::path& file);

/// Draws friction, sensor noise, the seed of this noise and all other variations of the world. The same ranges, robot
/// and seed give the same world on every machine. Throws std::invalid_argument if a payload is drawn for a robot
/// without hands.
void vary(WorldOptions& options, const VariationRanges& ranges, const model::RobotModel& robot, std::uint64_t seed);

/// The link of each side that holds a payload: the last moving link of the longest chain on the torso. Throws
/// std::invalid_argument if a side has none.
PerFoot<std::string> hand_links(const model::RobotModel& robot);

/// Throws std::invalid_argument for a vector of another size than the robot's joints.
void expect_joints(const Variation& variation, const model::RobotModel& robot);

/// The joint's actuator with its variation: gains, rotor inertia and dry friction times their factors, plus the
/// encoder's offset.
ActuatorParameters varied(ActuatorParameters actuator, const Variation& variation, Eigen::Index joint);

/// Writes masses and inertias into a compiled model and updates MuJoCo's derived constants. data is scratch: reset it
/// afterwards. Throws std::invalid_argument for a link that the model doesn't have.
void apply(const Variation& variation, const model::RobotModel& robot, mjModel* model, mjData* data);

}  // namespace pmg::sim
