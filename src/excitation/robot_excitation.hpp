// Commands that excite a robot's masses, IMU, ground contact and each joint.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "model/robot_io.hpp"
#include "model/robot_model.hpp"
#include "pmg/clip.hpp"

namespace pmg::excitation {

/// One command per 10 ms tick, in the gantry, feet clear of the ground. Every joint follows a sum of three sines at its
/// own frequencies about a posture with arms and legs slightly spread. Three stretches: nominal gains with dq_des = 0;
/// half gains; nominal gains with dq_des the derivative of q_des. The three separate a joint's gain, damping, friction
/// and delay. Joints named in own_gains have nominal gains and dq_des = 0 throughout: their drives know nothing else.
/// Throws std::out_of_range when the robot has no such joint.
std::vector<model::JointCommand> hanging_excitation(const model::RobotModel& robot,
                                                    std::span<const std::string> own_gains = {});

/// One command per 10 ms tick, on the ground without the gantry: slow squats, bends, leans and all three together, feet
/// flat. At the end, squatting, the hips push the feet apart and together three times, as hard as they may: only a
/// slipping sole shows the ground's friction.
std::vector<model::JointCommand> standing_excitation(const model::RobotModel& robot, const ClipLibrary& clips);

}  // namespace pmg::excitation
