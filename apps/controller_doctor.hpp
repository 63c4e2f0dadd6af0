// The doctor before pmg_controller drives motors.
#pragma once

#include "controller_arguments.hpp"

namespace pmg::apps {

/// Asks what concerns this controller (doctor/examination.hpp) and prints what isn't ok. Throws std::runtime_error with
/// the first failure, unless the user says --despite-doctor. A simulated robot needs no doctor.
void see_doctor(const ControllerArguments& arguments, const model::RobotModel& robot, const hal::Backend& backend);

}  // namespace pmg::apps
