// What drives say of themselves when they are asked, without being switched on or off.
#pragma once

#include <vector>

#include "doctor/checks.hpp"

namespace pmg::apps {

/// Reads the revision (0x1018:3) of every CiA 402 drive on the CAN buses; drives of other protocols are listed without.
/// Throws std::runtime_error, one line, when a bus can't be opened, or another program drives it.
std::vector<doctor::DriveAnswer> ask_firmware(const model::RobotModel& robot, const can::DriveSetup& setup);

}  // namespace pmg::apps
