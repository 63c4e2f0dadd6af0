// Makes a clip library's command inverse: measures, command by command, what the optimised command averages to.
#pragma once

#include <functional>

#include "model/robot_model.hpp"
#include "pmg/clip.hpp"
#include "pmg/command_inverse.hpp"

namespace pmg::gco {

/// u' averaged over one gait period at a steady command, the library's own inverse left out; the command itself
/// at rest.
Command mean_optimised_command(const model::RobotModel& robot, const ClipLibrary& library, const Command& command);

/// The inverse on a grid over the robot's command range, pitch and roll 0. What the clips can't reach is left: where
/// the velocities together ask for more than the generator gives, only their direction is corrected, and no correction
/// leaves the command range or exceeds two fifths of half a channel's. Rest stays rest. progress is told the share done
/// and may throw to stop.
CommandInverse make_command_inverse(const model::RobotModel& robot, const ClipLibrary& library,
                                    const std::function<void(double)>& progress);

}  // namespace pmg::gco
