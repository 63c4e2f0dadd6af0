// A whole clip library for a robot, made from published gait figures.
#pragma once

#include <functional>
#include <string>

#include "model/robot_model.hpp"
#include "pmg/clip.hpp"

namespace pmg::generator {

/// with_corners: clips of two velocities too (corner_synthesis.hpp). progress is told the name of the clip that is
/// being made, many times a second and one call at a time, but from several threads; it may throw to stop.
ClipLibrary synthesize(const model::RobotModel& robot, bool with_corners,
                       const std::function<void(const std::string&)>& progress);

/// Where a clip's numbers come from, one line for its YAML.
std::string clip_source(const std::string& name);

}  // namespace pmg::generator
