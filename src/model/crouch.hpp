// The lowest posture from which a robot has little left to fall.
#pragma once

#include "model/robot_model.hpp"

namespace pmg::model {

/// (a squat, both feet flat and in place) => (the same way down to the joints' limits): every joint goes on from the
/// standing posture through the squat until it is 2 degrees from its limit. Then the hips, the first leg joints that
/// the squat moves, turn until the robot's centre of mass is over the soles' centres, in the foot's x direction [rad].
/// Where no hip angle does that, the squat itself.
JointVector deepest_crouch(const RobotModel& robot, const JointVector& squat);

}  // namespace pmg::model
