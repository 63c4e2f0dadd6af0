// Which joint is which one's mirror image.
#pragma once

#include "model/robot_model.hpp"
#include "model/urdf_tree.hpp"

namespace pmg::model {

/// Joint i's counterpart under reflection in the sagittal plane, found from the names (left_/right_; all others are
/// their own) and the axes in the zero posture. Throws ConfigError when a partner is missing, its axis isn't parallel
/// to the mirrored one, its origin isn't the mirrored one (1 mm), or its limits or standing angle aren't the mirrored
/// ones.
MirrorMap find_mirror(const RobotModel& robot, const UrdfTree& tree);

}  // namespace pmg::model
