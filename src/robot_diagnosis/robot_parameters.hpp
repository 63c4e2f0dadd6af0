// Parameter errors of a whole robot. The equations of motion are linear in them.
#pragma once

#include <string>
#include <vector>

#include "model/robot_model.hpp"

namespace pmg::robot_diagnosis {

/// Standard deviations of a healthy robot's parameters from its model. A cause lies beyond them. Assumed; measurements
/// of a series of robots should replace them.
struct RobotTolerances {
  double link_mass_share = 0.01;
  double payload_kg = 0.03;
  double torso_center_m = 0.002;
  double imu_rad = 0.001;
  double kp_share = 0.01, kd_share = 0.03;
  double friction_share = 0.15, friction_least_Nm = 0.02;  ///< Coulomb; viscous friction has the same share
  double armature_share = 0.06;
  double inertia_share = 0.01;  ///< of the inertia that a joint moves: only its sum with the armature is observable
  double zero_offset_rad = 0.0015;
  double delay_s = 0.0004;
};

/// Sizes of a cause: standard deviation of its prior, and the smallest value worth reporting.
struct CauseSize {
  double wide = 0.0, relevant = 0.0;
};

/// Sizes of the causes; a share is relative to the model's value.
struct RobotCauseSizes {
  CauseSize torso_payload_kg{3.0, 0.25}, hand_payload_kg{1.5, 0.1}, torso_center_m{0.03, 0.006}, imu_rad{0.04, 0.005};
  CauseSize kp_share{0.3, 0.04}, kd_share{0.5, 0.1};
  CauseSize coulomb_share{2.0, 0.3}, viscous_share{3.0, 0.4}, armature_share{1.0, 0.2};
  CauseSize zero_offset_rad{0.06, 0.006}, delay_s{0.01, 0.0015};
  double coulomb_least_of_effort = 0.01, viscous_least_Nm_s_per_rad = 0.05, armature_least_kg_m2 = 0.002;
  double lightest_link_kg = 0.15;
};

/// One parameter error; 0 means that the model is right.
struct RobotParameter {
  enum class Kind {
    kLinkMass,     ///< relative error of a link's mass and inertia; a nuisance parameter, never a cause
    kTorsoMass,    ///< [kg] at the torso's centre of mass
    kTorsoCenter,  ///< [m] along the torso's axes
    kHandPayload,  ///< [kg] at the hand's centre of mass
    kImu,          ///< [rad] about the IMU's axes
    kKp,           ///< relative error of the gain
    kKd,
    kCoulomb,     ///< additional [Nm]
    kViscous,     ///< additional [Nm s/rad]
    kArmature,    ///< additional [kg m^2]
    kZeroOffset,  ///< [rad] reading minus true angle
    kDelay,       ///< [s] from command to torque
  } kind;
  int joint = -1;          ///< its joint, or -1
  std::string link{};      ///< its link, or ""
  int axis = -1;           ///< component of a vector
  double tolerance = 0.0;  ///< standard deviation of the prior without a cause
  double wide = 0.0;       ///< standard deviation of the prior of a cause
  double relevant = 0.0;   ///< smallest value worth reporting
};

/// Parameters that form one cause.
struct RobotCandidate {
  std::string effect;           ///< "payload", "center_of_mass", "imu_mounting", "gain", ...
  std::string place;            ///< link or joint
  std::vector<int> parameters;  ///< indices into the list
};

struct RobotParameterList {
  std::vector<RobotParameter> parameters;
  std::vector<RobotCandidate> candidates;
};

/// Inertia about each joint's axis, of all links beyond it and its armature, with all joints at 0 [kg m^2].
JointVector moved_inertia_kg_m2(const model::RobotModel& robot);

RobotParameterList robot_parameters(const model::RobotModel& robot, const RobotTolerances& tolerances,
                                    const RobotCauseSizes& sizes = {});

/// Key of the parameter in diagnosis.json ("kp_error_share", "mass_kg", ...), and its unit.
std::string name(const RobotParameter& parameter);
std::string unit(const RobotParameter& parameter);

}  // namespace pmg::robot_diagnosis
