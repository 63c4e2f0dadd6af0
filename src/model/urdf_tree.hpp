// A URDF file as a validated KDL tree. The conversion is our own because ROS' kdl_parser depends on ROS.
#pragma once

#include <urdf_model/model.h>
#include <urdf_world/types.h>

#include <filesystem>
#include <kdl/tree.hpp>
#include <map>
#include <string>

#include "files/config_error.hpp"

namespace pmg::model {

struct UrdfTree {
  std::filesystem::path file;
  std::string text;  ///< of the file, to find an element's line
  urdf::ModelInterfaceSharedPtr urdf;
  KDL::Tree tree;  ///< rooted at the URDF's root link
  KDL::RigidBodyInertia root_inertia;
  std::map<std::string, KDL::Frame> link_pose;  ///< each link in the root link's frame, all joints at zero

  /// The place where the element (<joint name="..."> or <link name="...">) begins.
  files::Place place(const std::string& element, const std::string& name) const;
};

/// Reads and checks: every link has a positive mass and a physically possible inertia; every joint is fixed, or
/// revolute with a unit axis and lower < upper limits. Throws ConfigError.
UrdfTree read_urdf(const std::filesystem::path& file);

}  // namespace pmg::model
