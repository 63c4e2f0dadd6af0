// What another project's policy sees and commands, read from a YAML file beside its network
// (docs/reference/file-formats.md).
#pragma once

#include <array>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "model/robot_model.hpp"
#include "pmg/command.hpp"
#include "policy/golden_pairs.hpp"
#include "policy/policy.hpp"

namespace pmg::policy {

/// The velocities that a policy was trained for [m/s, rad/s].
struct VelocityRange {
  std::array<double, kVelocityChannels> lower{}, upper{};
};

/// What one term of the observation measures.
enum class Signal {
  kGyro,              ///< angular velocity of the base, in its frame [rad/s]
  kGravityDirection,  ///< unit vector down, in the base's frame
  kCommand,           ///< vx, vy [m/s], omega [rad/s]
  kCommandLinear,     ///< vx, vy [m/s]
  kCommandAngular,    ///< omega [rad/s]
  kJointPosition,     ///< q - default_rad of the policy's joints [rad]
  kJointVelocity,     ///< dq of the policy's joints [rad/s]
  kLastAction,        ///< the network's previous output
  kClockSin,          ///< sin 2 pi (t / period_s + offset) of each offset
  kClockCos,          ///< cos of the same
};

/// Of the terms that tell the time: a policy may step to a clock.
struct StepClock {
  double period_s = 0.0;
  std::vector<double> offsets_cycle{};    ///< of each foot, or one
  std::optional<double> at_rest_cycle{};  ///< all phases while no velocity is asked for, and then the clock begins
                                          ///< again; nullopt: it goes on
};

/// One term: each element is scale * clamp(value, -clip, clip), of each of `history` frames.
struct SignalTerm {
  Signal signal = Signal::kGyro;
  int size = 0;                                           ///< elements of one frame
  std::vector<double> scale;                              ///< one an element
  double clip = std::numeric_limits<double>::infinity();  ///< in the value's own unit
  int history = 1;                                        ///< frames, this one among them
  StepClock clock{};                                      ///< of kClockSin and kClockCos
};

/// How frames of several ticks lie in the vector.
struct HistoryOrder {
  bool by_term = true;  ///< all frames of a term, then the next term; otherwise all terms of a frame
  bool oldest_first = true;
};

struct PolicyDescriptor {
  std::filesystem::path network;                      ///< the ONNX file
  std::vector<std::filesystem::path> files;           ///< the network, and what else the descriptor names
  std::string input, output;                          ///< the network's names of them
  double rate_Hz = 0.0;                               ///< of inferences
  std::vector<int> joints;                            ///< in the network's order, indices of the robot's joint order
  std::vector<double> default_rad, action_scale_rad;  ///< one a joint: q_des = default + scale * action
  std::optional<double> action_limit;  ///< the network's outputs are clamped to +- this; nullopt: they are not
  std::optional<double>
      action_bound_rad;   ///< largest |q_des - default| in normal operation; nullopt: the monitor's own
  DriveGains gains;       ///< in the robot's joint order; robot.yaml's for joints that aren't the policy's
  VelocityRange command;  ///< that the policy was trained for
  std::vector<SignalTerm> observation;
  HistoryOrder order;
  int observation_size = 0;  ///< of all frames of all terms
  double golden_tolerance = 0.0;
  std::vector<GoldenPair> golden;  ///< may be empty
};

/// Reads and checks against the robot. Throws files::ConfigError with file, line and key, and what was expected: a
/// joint that the robot hasn't or gives to no policy, a term that isn't known, sizes, gains, a rate that doesn't divide
/// the controller's, an IMU that isn't fixed to the base.
PolicyDescriptor read_policy_descriptor(const std::filesystem::path& file, const model::RobotModel& robot,
                                        double control_rate_Hz);

}  // namespace pmg::policy
