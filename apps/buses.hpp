// The buses of a robot, and one question to all of their drives.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "can/link.hpp"
#include "can/roll_call.hpp"
#include "drives/drive_setup.hpp"
#include "model/robot_model.hpp"

namespace pmg::apps {

struct Buses {
  /// Opens every CAN bus that robot.yaml names.
  /// \throws std::runtime_error where a bus can't be opened, or can't carry its load
  explicit Buses(const std::string& robot_name);

  model::RobotModel robot;
  drives::DriveSetup setup;
  std::vector<std::unique_ptr<can::Link>> links;
};

using TakeAnswer = std::function<void(const drives::BusSetup&, const drives::MotorSetup&, const can::Answer*)>;

/// Asks every bus once; take gets each motor with its answer, nullptr for none. Returns all problems. Ends early after
/// an interrupt.
std::vector<std::string> ask(Buses& buses, const TakeAnswer& take);

/// Asks every bus once, and prints a row for each motor and all problems. Returns the number of problems.
std::size_t show(Buses& buses);

}  // namespace pmg::apps
