// pmg_bus dump and replay: recordings of a robot's buses in candump's format.
#pragma once

#include <string>

namespace pmg::apps {

/// Prints frames of all buses in the order in which the kernel got them, until an interrupt or for_s > 0 seconds.
/// Returns an exit code.
int dump_buses(const std::string& robot_name, double for_s);

/// Prints what the backend says of a recording. Returns an exit code: 1 where a drive had a problem.
int replay_recording(const std::string& robot_name, const std::string& recording);

}  // namespace pmg::apps
