// (ground truth) => the six command channels as the simulated robot realised them, for comparison with the command.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <deque>

#include "pmg/command.hpp"
#include "pmg_msgs/ground_truth_t.hpp"

namespace pmg::report {

/// Messages hold quaternions as w, x, y, z.
inline Eigen::Quaterniond to_quaternion(const double (&wxyz)[4]) { return {wxyz[0], wxyz[1], wxyz[2], wxyz[3]}; }

/// Velocities in the heading frame H, averaged over the last gait period as in metrics.hpp; posture of the torso in H;
/// height of the pelvis as deviation from standing.
class MeasuredCommand {
 public:
  /// Call once for each tick. A jump of time by more than a period, or backwards, restarts the averages.
  std::array<double, kChannels> add(const pmg_msgs::ground_truth_t& truth, double gait_period_s,
                                    double standing_height_m);

 private:
  struct Sample {
    double time_s, vx_W_m_s, vy_W_m_s, yaw_rate_rad_s, cos_yaw, sin_yaw;
  };
  std::deque<Sample> samples_;
};

/// Whether the robot has fallen, by the rule of metrics.hpp.
bool fallen(const pmg_msgs::ground_truth_t& truth, double standing_height_m);

}  // namespace pmg::report
