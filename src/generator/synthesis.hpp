// Makes a whole clip library for a robot from published gait figures.
#pragma once

#include <string>

#include "model/robot_model.hpp"
#include "pmg/clip.hpp"
#include "work/progress.hpp"

namespace pmg::generator {

/// with_corners: also clips of two velocities (corner_synthesis.hpp). progress gets the name of the clip that is being
/// made, many times a second, one call at a time but from several threads. Throws work::Interrupted where it is over.
ClipLibrary synthesize(const model::RobotModel& robot, bool with_corners, const work::Progress& progress);

/// Source of a clip's numbers, one line for its YAML.
std::string clip_source(const std::string& name);

}  // namespace pmg::generator
