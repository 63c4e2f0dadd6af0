// Makes a clip library's command inverse: measures the cycle mean of the optimised command over a grid of commands.
#pragma once

#include "model/robot_model.hpp"
#include "pmg/clip.hpp"
#include "pmg/command_inverse.hpp"
#include "work/progress.hpp"

namespace pmg::gco {

/// u' averaged over one gait period at a steady command, without the library's own inverse; at rest the command itself.
Command mean_optimised_command(const model::RobotModel& robot, const ClipLibrary& library, const Command& command);

/// The inverse on a grid over the robot's command range, pitch and roll 0. What the clips can't reach is left: where
/// the velocities together ask for more than the generator gives, only their direction is corrected, and no correction
/// leaves the command range or exceeds two fifths of half a channel's. Rest stays rest. Throws work::Interrupted where
/// progress is over.
CommandInverse make_command_inverse(const model::RobotModel& robot, const ClipLibrary& library,
                                    const work::Progress& progress = {});

}  // namespace pmg::gco
