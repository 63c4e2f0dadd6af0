// Parameter errors of a whole robot. The equations of motion are linear in them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "model/robot_model.hpp"
#include "work/threshold.hpp"

namespace pmg::robot_diagnosis {

// docs/explanation/whole-robot-diagnosis.md
inline constexpr std::string_view kRobots = "hidden robots, seeds 0 to 39";
inline constexpr std::string_view kAssumed = "assumed; a series of measured robots would settle it";
inline constexpr std::string_view kPhysics = "MuJoCo's soft contacts";

/// Standard deviations of a healthy robot's parameters from its model. A cause lies beyond them. Assumed; measurements
/// of a series of robots should replace them.
struct RobotTolerances {
  work::Threshold link_mass_share{0.01, "", "standard deviation of a link's mass between robots of a kind", kAssumed};
  work::Threshold payload_kg{0.03, "kg", "of the mass of torso and hands", kAssumed};
  work::Threshold torso_center_m{0.002, "m", "of the torso's centre of mass", kAssumed};
  work::Threshold imu_rad{0.001, "rad", "of the IMU's mounting", kAssumed};
  work::Threshold kp_share{0.01, "", "of a gain", kAssumed};
  work::Threshold kd_share{0.03, "", "of a damping gain", kAssumed};
  work::Threshold friction_share{0.15, "", "of a joint's friction", kAssumed};
  work::Threshold friction_least_Nm{0.02, "Nm", "of small dry friction", kAssumed};
  work::Threshold armature_share{0.06, "", "of a rotor's inertia", kAssumed};
  work::Threshold inertia_share{0.01, "", "of the inertia that a joint moves: only its sum with the rotor's shows",
                                kAssumed};
  work::Threshold zero_offset_rad{0.0015, "rad", "of a joint's zero", kAssumed};
  work::Threshold delay_s{0.0004, "s", "of a command's delay", kAssumed};

  PMG_THRESHOLDS(link_mass_share, payload_kg, torso_center_m, imu_rad, kp_share, kd_share, friction_share,
                 friction_least_Nm, armature_share, inertia_share, zero_offset_rad, delay_s)
};

/// Sizes of a cause: standard deviation of its prior, and the smallest value worth reporting.
struct CauseSize {
  work::Threshold wide, relevant;

  PMG_THRESHOLDS(wide, relevant)
};

constexpr CauseSize cause_size(double wide, double relevant, std::string_view unit) {
  return {{wide, unit, "standard deviation of the prior of this cause", kAssumed},
          {relevant, unit, "smallest error worth reporting", kAssumed}};
}

/// Sizes of the causes; a share is relative to the model's value.
struct RobotCauseSizes {
  CauseSize torso_payload_kg = cause_size(3.0, 0.25, "kg");
  CauseSize hand_payload_kg = cause_size(1.5, 0.1, "kg");
  CauseSize torso_center_m = cause_size(0.03, 0.006, "m");
  CauseSize imu_rad = cause_size(0.04, 0.005, "rad");
  CauseSize kp_share = cause_size(0.3, 0.04, "");
  CauseSize kd_share = cause_size(0.5, 0.1, "");
  CauseSize coulomb_share = cause_size(2.0, 0.3, "");
  CauseSize viscous_share = cause_size(3.0, 0.4, "");
  CauseSize armature_share = cause_size(1.0, 0.2, "");
  CauseSize zero_offset_rad = cause_size(0.06, 0.006, "rad");
  CauseSize delay_s = cause_size(0.01, 0.0015, "s");
  work::Threshold coulomb_least_of_effort{
      0.01, "",
      "share of a joint's torque limit that a smaller dry friction is replaced by, where causes are sized by it",
      kAssumed};
  work::Threshold viscous_least_Nm_s_per_rad{0.05, "Nm s/rad", "the same of viscous friction", kAssumed};
  work::Threshold armature_least_kg_m2{0.002, "kg m^2", "the same of a rotor's inertia", kAssumed};
  work::Threshold lightest_link_kg{0.15, "kg", "the mass of a lighter link has no tolerance", kAssumed};

  PMG_THRESHOLDS(torso_payload_kg, hand_payload_kg, torso_center_m, imu_rad, kp_share, kd_share, coulomb_share,
                 viscous_share, armature_share, zero_offset_rad, delay_s, coulomb_least_of_effort,
                 viscous_least_Nm_s_per_rad, armature_least_kg_m2, lightest_link_kg)
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
