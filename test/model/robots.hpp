// The robots that tests use, read once each.
#pragma once

#include <string>

#include "folders.hpp"
#include "model/robot_model.hpp"

namespace pmg::test {

inline const std::string kZ1Folder = pmg::test::project_folder() + "/config/robots/z1";
inline const std::string kBipedFolder = pmg::test::project_folder() + "/test/data/robots/biped";

inline const model::RobotModel& z1() {
  static const model::RobotModel robot = model::load_robot(kZ1Folder);
  return robot;
}

inline const model::RobotModel& biped() {
  static const model::RobotModel robot = model::load_robot(kBipedFolder);
  return robot;
}

}  // namespace pmg::test
