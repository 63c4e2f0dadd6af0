// Makes a clip library's command inverse: measures the cycle mean of the optimised command over a grid of commands.
#pragma once

#include "model/robot_model.hpp"
#include "pmg/clip.hpp"
#include "pmg/command_inverse.hpp"
#include "work/progress.hpp"

namespace pmg::gco {

/// u' averaged over one gait period at a steady command, without the library's own inverse; at rest the command itself.
Command mean_optimised_command(const model::RobotModel& robot, const ClipLibrary& library, const Command& command);

/// The inverse on a grid over the robot's command range, with pitch and roll 0. Where the velocities together exceed
/// the generator's reach, only their direction is corrected. No correction leaves the command range or exceeds 40 % of
/// half the channel's range. At rest it is 0. Throws work::Interrupted where progress is over.
CommandInverse make_command_inverse(const model::RobotModel& robot, const ClipLibrary& library,
                                    const work::Progress& progress = {});

}  // namespace pmg::gco
