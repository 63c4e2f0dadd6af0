// Simulated robots with something wrong with them that nobody tells the diagnosis.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "model/robot_model.hpp"
#include "robot_diagnosis/robot_diagnosis.hpp"
#include "sim/world.hpp"

namespace pmg::robot_diagnosis {

/// What was hidden: as RobotCause names it; "" for a clean robot.
struct HiddenEffect {
  std::string effect, place;
  std::vector<double> values;  ///< in the order of the cause's parameters
};

struct HiddenRobot {
  HiddenEffect hidden;
  double ground_friction = 0.8;
  model::RobotModel robot;  ///< that the world is built from
  sim::WorldOptions options;
};

/// Every kind in turn: clean, payload on the torso, in a hand, shifted centre of mass, IMU askew, and one joint's
/// effect (half of all). Every robot has noise, another ground, and masses, friction, gains, armatures and zeros that
/// are off by what robots of a kind are off by.
HiddenRobot hide(const model::RobotModel& robot, std::uint64_t seed);

/// The one cause, or none for a clean robot, and nothing besides: a payload within 15 %, an IMU within 0.3 degrees; of
/// the rest the name counts.
bool named_right(const HiddenEffect& hidden, const RobotDiagnosis& diagnosis);

/// Both excitations, in the gantry and on the ground.
std::vector<RobotRecording> record_hidden(const HiddenRobot& hidden);

}  // namespace pmg::robot_diagnosis
