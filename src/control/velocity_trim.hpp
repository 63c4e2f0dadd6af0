// Corrects what a policy leaves of a velocity command: slowly, by what the robot's legs and IMU say it really does.
#pragma once

#include <array>

#include "control/leg_odometry.hpp"
#include "model/robot_io.hpp"
#include "model/robot_model.hpp"
#include "pmg/command.hpp"
#include "pmg/reference.hpp"

namespace pmg::control {

/// Shares are of a channel's range in robot.yaml.
struct VelocityTrimOptions {
  double gain_per_s = 0.4;  ///< of the missing velocity, so much is added a second; 0: no trim
  /// A walking robot is behind its command. So it learns while the user's command agrees with its own low-pass of lag_s
  /// to settled_share: about 3 lag_s after a step.
  double lag_s = 1.0, settled_share = 0.05;
  double most_share = 0.25;
  /// A larger miss counts as this: the robot was pushed, or a foot that should carry doesn't.
  double most_miss_share = 0.25;
  double forgets_per_range = 6.0;  ///< what was learnt of one command counts the less for another
  double full_above_share = 0.1;   ///< below this sum of commanded shares the trim fades out
};

/// One trim a velocity channel:
///   missing = low_pass(taken, lag) - low_pass(leg odometry, lag), at most most_miss_share of the range,
///   trim += gain missing dt, at most most_share of the range, while the command has settled,
///   trim *= exp(-forgets_per_range sum of |d taken| / range), with what is taken of the user's command.
/// Where the clips reach no farther, less is taken of the user's command as the trim grows, so the trim comes to rest.
/// A walking robot sways by more than it is missing: its velocity is smoothed before a bound may bend its mean.
class VelocityTrim {
 public:
  /// double_support_rate: a correction changes the slower where both feet carry, as the generator's commands do
  /// (GeneratorOptions).
  VelocityTrim(const model::RobotModel& robot, const VelocityTrimOptions& options, double double_support_rate,
               double dt_s);

  /// Nothing is added, from now: for a motion that is itself reset.
  void reset() noexcept;

  /// (state, the user's command, the last tick's reference, whether a policy walks by it) => (what to add to the
  /// velocities asked of the clips [m/s, m/s, rad/s]). Goes to zero when nothing is commanded or nothing walks, and
  /// then nothing is remembered. It never jumps. No heap.
  const std::array<double, kVelocityChannels>& step(const model::RobotState& state, const Command& user,
                                                    const Reference& reference, bool walks) noexcept;

 private:
  static constexpr double kMostRate_per_s = 1.0;  ///< of a correction, in ranges

  void learn(const model::RobotState& state, const Command& user, const Command& taken,
             const PerFoot<double>& weight) noexcept;
  bool settled(const Command& user, const Command& taken) noexcept;
  void forget() noexcept;

  VelocityTrimOptions options_;
  double double_support_rate_, dt_s_;
  LegOdometry odometry_;
  CommandLimits limits_;
  std::array<double, kVelocityChannels> range_{}, asked_{}, before_{}, lagged_{}, measured_{}, trim_{}, correction_{};
};

}  // namespace pmg::control
