// A clip library on the ground at a steady command: generator and ground-aware optimisation without a robot.
#pragma once

#include <cstdint>
#include <vector>

#include "gco/slip_statistics.hpp"
#include "model/robot_model.hpp"
#include "pmg/clip.hpp"
#include "pmg/command.hpp"

namespace pmg::gco {

/// Figures over whole gait cycles, after the commands have reached their values.
struct SteadyWalk {
  SlipSummary slip;
  double pure_single_support_m_s = 0.0;  ///< largest slip while the other foot has no contact weight
  Command mean;                          ///< u' over whole cycles
  Command admissible;                    ///< the command that the generator accepts
  double lowest_swing_m = 0.0;  ///< lowest sole point of a foot without contact weight; negative: in the ground
  double clearance_m = 0.0;     ///< lowest sole point of a foot in mid swing (0.3 to 0.7 of it)
  double foot_gap_m = 0.0;      ///< smallest gap between the soles along the base's y axis while they are side by side
  bool limited = false;         ///< the generator limited the command
  bool clamped = false;         ///< the last guard clamped a joint
};

/// Walks for some gait cycles. Throws what Generator throws.
SteadyWalk walk_steadily(const model::RobotModel& robot, const ClipLibrary& library, const Command& command);

/// Random commands over the whole velocity box of robot.yaml. Each channel is 0 with probability 0.3 and otherwise
/// uniform. Half of the commands also have a posture: pitch, roll and height over posture_share of their ranges.
std::vector<Command> commands_over_the_box(const model::RobotModel& robot, int count, std::uint64_t seed,
                                           double posture_share);

}  // namespace pmg::gco
