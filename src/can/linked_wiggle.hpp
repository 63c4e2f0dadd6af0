// First movements of joints that a linkage turns: its motors drive together, all others are off. From the cranks'
// angles alone nothing tells which motor turns which crank, since each pair of angles belongs to some posture. The
// load, the base that turns and the joints' ranges may tell; the eye does.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "can/bus_setup.hpp"
#include "can/first_light.hpp"
#include "can/link.hpp"
#include "can/plumb.hpp"
#include "model/hanging_load.hpp"
#include "model/robot_model.hpp"

namespace pmg::can {

/// Names of the joints that a linkage turns with this motor; empty: the motor turns its joint alone.
std::vector<std::string> linked_joints(const BusSetup& bus, const drives::MotorSetup& motor);

/// A linkage at rest: means over half of the time at one end of a way, as robot.yaml has motors and cranks.
struct CrankEnd {
  std::vector<double> crank_rad{}, torque_Nm{};
  std::optional<Plumb::Sample> plumb{};
};

/// One joint's way, the others' held.
struct LinkedWay {
  std::string joint;
  double asked_rad = 0.0, moved_rad = 0.0;            ///< from the start to the end of the positive way
  double asked_down_rad = 0.0, moved_down_rad = 0.0;  ///< of the negative way; positive numbers
  CrankEnd begin{}, highest{}, lowest{}, back{};
};

/// Moves each joint of the motor's linkage there and back, one after the other. Throws as wiggle() does, and when no
/// joint angles belong to the cranks'. options.by_rad: of each joint.
std::vector<LinkedWay> wiggle_linked(const model::RobotModel& robot, const JointVector& q, const BusSetup& bus,
                                     const drives::MotorSetup& motor, Link& link, const WiggleOptions& options,
                                     const std::function<void()>& tick, const std::function<bool()>& interrupted,
                                     const model::Hanging& hanging = {}, Plumb* plumb = nullptr);

/// What these ways say of how the motors are connected: as robot.yaml has it, swapped, with one or both the other way
/// round. An arrangement is ruled out when it puts a joint beyond its range, when its posture's weight isn't what the
/// motors held, or when the base turned otherwise. Verdict::look: what the eye would see of those that are left.
Verdict verdict(const model::RobotModel& robot, const JointVector& q, const BusSetup& bus,
                const drives::MotorSetup& motor, const std::vector<LinkedWay>& ways,
                const model::Hanging& hanging = {});

/// A way to connect a linkage's motors, or a joint's own motor, and where the joints then are.
struct Connection {
  std::string words;              ///< against robot.yaml; empty: as it has them
  std::vector<double> joint_rad;  ///< of linked_joints, or of the motor's joint
};

/// Angles of the cranks, or of the joint that its motor turns alone, at these joints' [rad], all as robot.yaml has
/// them. Throws std::runtime_error when no cranks' angles belong to them.
std::vector<double> cranks_at(const BusSetup& bus, const drives::MotorSetup& motor, const JointVector& q);

/// All of them, robot.yaml's first; of a linkage those that put its joints into their ranges, or at most 0.2 rad
/// beyond. cranks_rad: as cranks_at() has them.
std::vector<Connection> connections(const BusSetup& bus, const drives::MotorSetup& motor,
                                    const std::vector<double>& cranks_rad);

/// What was looked at, in words.
struct Evidence {
  const char* name;    ///< "load and base", before "can't tell"
  const char* advice;  ///< where they can't
  const char* seems;   ///< "it moves", before "as if"
};

/// The verdict where the ways to connect the motors with these words are left, one or more.
Verdict verdict_of(const std::vector<std::string>& possible, const Evidence& evidence);

/// What puts the joints of this linkage into their ranges, if robot.yaml's arrangement doesn't: "the motors of
/// left_ankle_pitch and left_ankle_roll are swapped". cranks_rad: as robot.yaml has them. Empty: robot.yaml's does.
std::string arranged_within_ranges(const BusSetup& bus, const drives::MotorSetup& motor,
                                   const std::vector<double>& cranks_rad);

}  // namespace pmg::can
