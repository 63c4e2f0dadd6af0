// Differences of a simulated robot and its ground from the model: unknown ones, and ones that change from day to day.
#pragma once

#include <mujoco/mujoco.h>

#include <array>
#include <cstdint>
#include <map>
#include <string>

#include "model/actuator_parameters.hpp"
#include "model/robot_model.hpp"
#include "pmg/types.hpp"
#include "sim/variation_ranges.hpp"

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
model::ActuatorParameters varied(model::ActuatorParameters actuator, const Variation& variation, Eigen::Index joint);

/// Writes masses and inertias into a compiled model and updates MuJoCo's derived constants. data is scratch: reset it
/// afterwards. Throws std::invalid_argument for a link that the model doesn't have.
void apply(const Variation& variation, const model::RobotModel& robot, mjModel* model, mjData* data);

}  // namespace pmg::sim
