// The robot: robot.yaml and its URDF, read once, validated whole. No C++ code knows a particular robot.
#pragma once

#include <urdf_model/model.h>
#include <urdf_world/types.h>

#include <Eigen/Geometry>
#include <array>
#include <filesystem>
#include <kdl/chain.hpp>
#include <kdl/tree.hpp>
#include <optional>
#include <string>
#include <vector>

#include "model/joint_index.hpp"
#include "pmg/clip.hpp"
#include "pmg/command.hpp"
#include "pmg/types.hpp"

namespace pmg::model {

/// Address of a drive, a bus and a node on it, and how its motor turns the joint:
///   q_motor = direction gear (q_joint + zero_offset).
struct BusAddress {
  std::string bus;  ///< "can0", "ethercat", ...
  int node = 0;
  std::string drive;              ///< its entry in robot.yaml's `drives` (src/drives); empty: none
  int direction = 1;              ///< 1 or -1
  double gear = 1.0;              ///< turns of the drive's output a turn of the joint
  std::optional<int> reply_id{};  ///< identifier of the drive's replies; nullopt: that of its entry in `drives`
  double zero_offset_rad = 0.0;   ///< the joint's reading minus its true angle, as zero.yaml has it
};

struct Joint {
  std::string name;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitY();  ///< in the joint frame, unit length
  double lower_rad = 0.0, upper_rad = 0.0;          ///< from the URDF
  double velocity_limit_rad_s = 0.0;                ///< from the URDF
  double effort_limit_Nm = 0.0;                     ///< from the URDF
  double kp_Nm_per_rad = 0.0, kd_Nm_s_per_rad = 0.0;
  double armature_kg_m2 = 0.0;  ///< rotor inertia seen at the joint
  double damping_Nm_s_per_rad = 0.0, friction_Nm = 0.0;
  double stand_rad = 0.0;
  double sit_down_rad = 0.0;  ///< in the crouch before the drives damp; the legs' is computed (model/crouch.hpp)
  bool policy = false;        ///< the policy drives it (the legs); other joints follow q_ref
  BusAddress bus;
};

/// One foot: the box that touches the ground; its bottom face is the sole.
struct FootModel {
  std::string link;
  Eigen::Vector3d box_center_F = Eigen::Vector3d::Zero();     ///< [m] in the foot link's frame
  Eigen::Vector3d box_half_size_m = Eigen::Vector3d::Zero();  ///< [m] along the link's axes
  std::array<Eigen::Vector3d, 4> sole_corners_F() const;      ///< [m] front-left, front-right, rear-left, rear-right
};

/// An IMU on a serial line of its own (src/imu).
struct SerialImuModel {
  std::string device;  ///< "/dev/serial/by-id/..."
  int baud = 0;
  int rate_Hz = 0;  ///< samples a second
};

struct ImuModel {
  std::string link;
  Eigen::Isometry3d T_LI = Eigen::Isometry3d::Identity();  ///< IMU frame in its link
  std::optional<SerialImuModel> serial;                    ///< nullopt: it speaks on a bus of the drives
};

struct RobotModel {
  std::string name;
  std::filesystem::path directory;  ///< folder of robot.yaml, clips/ and policies/
  JointIndex joint_index;
  std::vector<Joint> joints;  ///< in joint_index order
  std::string base_link, torso_link;
  PerFoot<FootModel> feet;
  ImuModel imu;
  CommandLimits command_limits;
  std::array<double, kVelocityChannels> velocity_scale_negative{}, velocity_scale_positive{};  ///< u_max_i per sign
  urdf::ModelInterfaceSharedPtr urdf;
  KDL::Tree tree;  ///< rooted at base_link, inertias included (the root's own: base_inertia)
  KDL::RigidBodyInertia base_inertia;
  PerFoot<KDL::Chain> leg_chain;         ///< base_link -> foot link
  PerFoot<std::vector<int>> leg_joints;  ///< joint order index of each moving joint of leg_chain, from the base down
  std::vector<int> torso_joints;         ///< joints between base_link and torso_link, from the base up
  KDL::Chain torso_chain;                ///< base_link -> torso_link
  MirrorMap mirror;                      ///< found from names (left_/right_) and axes (mirror.hpp)
  double total_mass_kg = 0.0;
  double standing_height_m = 0.0;  ///< base_link origin above the soles in the standing posture

  JointVector q_stand() const;
  JointVector q_sit_down() const;
  JointVector q_lower() const;
  JointVector q_upper() const;
};

/// Reads DIRECTORY/robot.yaml and the URDF it names. Throws ConfigError on anything missing, unknown or implausible.
RobotModel load_robot(const std::filesystem::path& directory);

/// config/robots/NAME beside the installed binary or in the source tree, or NAME itself if it is a directory. Throws
/// ConfigError if there is none.
std::filesystem::path find_robot(const std::string& name);

}  // namespace pmg::model
