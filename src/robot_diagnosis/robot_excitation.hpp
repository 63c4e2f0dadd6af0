// Commands that excite a robot's masses, IMU, ground contact and each joint.
#pragma once

#include <vector>

#include "model/robot_io.hpp"
#include "model/robot_model.hpp"
#include "pmg/clip.hpp"

namespace pmg::robot_diagnosis {

/// One command per 10 ms tick, in the gantry, feet clear of the ground. Every joint follows a sum of three sines at its
/// own frequencies about a posture with arms and legs slightly spread. Three stretches: nominal gains with dq_des = 0;
/// half gains; nominal gains with dq_des the derivative of q_des. The three separate a joint's gain, damping, friction
/// and delay.
std::vector<model::JointCommand> hanging_excitation(const model::RobotModel& robot);

/// One command per 10 ms tick, on the ground without the gantry: slow squats, bends, leans and all three together, feet
/// flat. At the end, squatting, the hips push the feet apart and together three times, as hard as they may: only a
/// slipping sole shows the ground's friction.
std::vector<model::JointCommand> standing_excitation(const model::RobotModel& robot, const ClipLibrary& clips);

}  // namespace pmg::robot_diagnosis
