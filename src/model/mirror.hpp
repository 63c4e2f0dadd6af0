// The mirror image of each joint.
#pragma once

#include "model/robot_model.hpp"
#include "model/urdf_tree.hpp"

namespace pmg::model {

/// Each joint's counterpart under reflection in the sagittal plane, found from the names (left_/right_; a joint without
/// such a name is its own counterpart) and from the axes in the zero posture. Throws ConfigError if a partner is
/// missing, or if its axis (2.6 degrees), origin (1 mm), limits or standing angle are not the mirrored ones.
MirrorMap find_mirror(const RobotModel& robot, const UrdfTree& tree);

}  // namespace pmg::model
