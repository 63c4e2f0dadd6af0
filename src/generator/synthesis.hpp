// Makes a whole clip library for a robot from published gait figures.
#pragma once

#include <functional>
#include <string>

#include "model/robot_model.hpp"
#include "pmg/clip.hpp"

namespace pmg::generator {

/// with_corners: also clips of two velocities (corner_synthesis.hpp). progress gets the name of the clip that is being
/// made, many times a second, one call at a time but from several threads. It may throw to stop.
ClipLibrary synthesize(const model::RobotModel& robot, bool with_corners,
                       const std::function<void(const std::string&)>& progress);

/// Source of a clip's numbers, one line for its YAML.
std::string clip_source(const std::string& name);

}  // namespace pmg::generator
