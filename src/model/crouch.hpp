// The lowest posture from which a robot has little left to fall.
#pragma once

#include "model/robot_model.hpp"

namespace pmg::model {

/// (a squat, both feet flat and in place) => (the same way down to the joints' limits) [rad]: every leg joint goes on
/// from the standing posture through the squat until it is 2 degrees from its limit. Joints with a `sit_down_rad` of
/// their own in robot.yaml go there: arms that reach forward are props under a robot that folds over its knees. Then
/// the hips, the first leg joints that the squat moves, turn until the robot's centre of mass is over the soles, this
/// share of their half length before their centres. Where no hip angle does that, the squat itself.
JointVector deepest_crouch(const RobotModel& robot, const JointVector& squat, double ahead_share);

}  // namespace pmg::model
