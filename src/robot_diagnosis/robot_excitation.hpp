// What a robot is told so that its masses, its IMU, the ground and each of its joints show themselves.
#pragma once

#include <vector>

#include "model/robot_io.hpp"
#include "model/robot_model.hpp"
#include "pmg/clip.hpp"

namespace pmg::robot_diagnosis {

/// One command a tick of 10 ms, in the gantry, feet clear of the ground: every joint swings by sums of three sines of
/// its own frequencies about a posture with arms and legs spread a little. Three stretches: the robot's gains with
/// dq_des = 0; half of them; the robot's gains with dq_des that follows. Gain, damping, friction and delay of a joint
/// are told apart by how they change between the three.
std::vector<model::JointCommand> hanging_excitation(const model::RobotModel& robot);

/// Likewise, on the ground without the gantry: squats, bends, leans and all three together, slowly, feet flat; at the
/// end, squatting, the feet are pushed apart and together three times, as hard as the hips may: only a sole that slips
/// tells the ground's friction.
std::vector<model::JointCommand> standing_excitation(const model::RobotModel& robot, const ClipLibrary& clips);

}  // namespace pmg::robot_diagnosis
