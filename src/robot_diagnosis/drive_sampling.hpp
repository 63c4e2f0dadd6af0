// When a drive samples its joint's position within a control tick, as the recording backend describes it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "model/joint_index.hpp"

namespace pmg::robot_diagnosis {

/// A joint's position is the cubic through the positions q and speeds dq at both ends of a control tick T. Here it, or
/// what is computed from it, as weights of the three states around two ticks in a row: q, q, q, T dq, T dq, T dq. s is
/// the share of the second tick that has passed, -1 to 0 in the first one.
using PathWeights = Eigen::Matrix<double, 6, 1>;
PathWeights path_position(double s);
PathWeights path_integral(double s);  ///< over the position, from 0 to s

/// A command's part of a tick: what share of it, and the means of the positions and of the speeds [rad/T] that its
/// torque is computed from.
struct CommandInForce {
  double share = 0.0;
  PathWeights position = PathWeights::Zero(), speed = PathWeights::Zero();
};

/// A drive samples the position at the beginning of each of n steps per tick T and holds its torque over the step. For
/// a drive faster than the bus n is infinite. An acceleration that is read with a state belongs to the step before it:
/// the mean over a tick is over s = 1/n .. 1, at c = (n + 1) / 2n.
struct DriveSampling {
  double step_s = 0.0;       ///< 0: much faster than the control tick
  std::string known_from{};  ///< source of step_s, for people
  /// From the moment of a state to the first torque of the command that was computed from it: what the bus needs. Until
  /// then the tick before has its command in force. 0 to a control tick.
  double command_delay_s = 0.0;
  std::string delay_known_from{};
  /// Joints, and perhaps the IMU, whose state is so much older than the others' in the same sample.
  std::vector<int> older_joints{};
  bool older_imu = false;
  double older_by_s = 0.0;
  /// Joints of whose drives all this isn't true but this: the bus thread computes their torques from positions and
  /// speeds that are so old on average while the torque acts.
  std::vector<int> closed_by_bus{};
  double bus_loop_age_s = 0.0;

  /// Mean position that the drive samples from s = from to s = to: Euler and Maclaurin's formula, with h = 1 / n,
  /// (integral of q - h/2 (change of q) + h^2/12 (change of dq/ds)) / (to - from). Exact for whole steps.
  PathWeights mean_position(double from, double to, double tick_s) const;
  /// The command of the tick before, then that of the tick.
  std::array<CommandInForce, 2> in_force(int joint, double tick_s) const;
  double acceleration_share(double tick_s) const { return 0.5 * (1.0 + step_s / tick_s); }
};

/// (ROBOT_INFO's backend, its options as JSON) => (drive sampling): the keys of hal::BackendDescription in the options;
/// without drive_sampling_s and command_delay_s, 2 ms and none of the simulated drive for the backend sil; else unknown
/// and assumed to be much shorter than the tick. Throws std::runtime_error if a time isn't from 0 to a control tick, or
/// a joint isn't one of the robot's.
DriveSampling drive_sampling(const std::string& backend, const std::string& options, const model::JointIndex& joints);

/// For people, one line.
std::string drive_sampling_text(const DriveSampling& sampling);

}  // namespace pmg::robot_diagnosis
