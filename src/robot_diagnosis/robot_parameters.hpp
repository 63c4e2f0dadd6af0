// What may be wrong with a whole robot, as numbers that the equations of motion are linear in.
#pragma once

#include <string>
#include <vector>

#include "model/robot_model.hpp"

namespace pmg::robot_diagnosis {

/// What is normal between a model and a robot that it describes well: standard deviations. A cause is more than that.
/// Assumed; a series of robots that were measured would say better.
struct RobotTolerances {
  double link_mass_share = 0.01;
  double payload_kg = 0.03;
  double torso_center_m = 0.002;
  double imu_rad = 0.001;
  double kp_share = 0.01, kd_share = 0.03;
  double friction_share = 0.15, friction_least_Nm = 0.02;  ///< Coulomb; viscous with a share alike
  double armature_share = 0.06;
  double inertia_share = 0.01;  ///< of what a joint moves: only its sum with the armature shows
  double zero_offset_rad = 0.0015;
  double delay_s = 0.0004;
};

/// One number. 0 is as the model says.
struct RobotParameter {
  enum class Kind {
    kLinkMass,     ///< share of a link's mass and inertia more; a nuisance, never a cause
    kTorsoMass,    ///< [kg] at the torso's centre of mass
    kTorsoCenter,  ///< [m] along the torso's axes
    kHandPayload,  ///< [kg] at the hand's centre of mass
    kImu,          ///< [rad] about the IMU's axes
    kKp,           ///< share of the gain more
    kKd,
    kCoulomb,     ///< [Nm] more
    kViscous,     ///< [Nm s/rad] more
    kArmature,    ///< [kg m^2] more
    kZeroOffset,  ///< [rad] reading minus truth
    kDelay,       ///< [s] from command to torque
  } kind;
  int joint = -1;      ///< of the robot's joints, or
  std::string link{};  ///< a link
  int axis = -1;       ///< of a vector
  double tolerance = 0.0;
  double wide = 0.0;      ///< standard deviation of what a cause may be
  double relevant = 0.0;  ///< smaller isn't worth telling
};

/// Parameters that are one cause together.
struct RobotCandidate {
  std::string effect;           ///< "payload", "center_of_mass", "imu_mounting", "gain", ...
  std::string place;            ///< link or joint
  std::vector<int> parameters;  ///< of the list
};

struct RobotParameterList {
  std::vector<RobotParameter> parameters;
  std::vector<RobotCandidate> candidates;
};

/// About each joint's axis, of all links beyond it and its armature, as the robot stands with straight joints.
JointVector moved_inertia_kg_m2(const model::RobotModel& robot);

RobotParameterList robot_parameters(const model::RobotModel& robot, const RobotTolerances& tolerances);

/// "kp_scale_error", "payload", ...: key of diagnosis.json, and its unit.
std::string name(const RobotParameter& parameter);
std::string unit(const RobotParameter& parameter);

}  // namespace pmg::robot_diagnosis
