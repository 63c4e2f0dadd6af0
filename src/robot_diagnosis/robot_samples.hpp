// A recording as what equations of motion are made of: means over control ticks, low-passed alike.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "pmg/types.hpp"
#include "robot_diagnosis/robot_recording.hpp"

namespace pmg::robot_diagnosis {

/// All as weighted means over a few ticks. Joint vectors are in joint order; torques are what the drives make of their
/// commands if they do as robot.yaml says: spring + damper + feed_forward.
struct RobotSample {
  double t_s = 0.0;
  JointVector q, dq, ddq;
  JointVector spring_Nm, damper_Nm, feed_forward_Nm;
  JointVector direction;                                     ///< of motion, -1 to 1: near 0 it turned, or stood still
  JointVector late_Nm_per_s;                                 ///< d torque / d delay of the command
  Eigen::Vector3d omega_I, alpha_I, specific_force_I, up_I;  ///< IMU frame; up_I by the IMU's own orientation, unit
};

/// Readings at the end of a tick aren't what they were in its middle: a command that is held for a tick makes torques
/// saw-toothed. How far each joint's torque at the reading of tick k lies from its trend [Nm]; 0 at both ends.
std::vector<JointVector> torque_ripple(const RobotRecording& recording);

/// Mean of what an accelerometer would show between two ticks, from its readings at both: at + share * (after - at),
/// share: DriveSampling::acceleration_share.
Eigen::Vector3d mean_of_readings(const Eigen::Vector3d& at, const Eigen::Vector3d& after, double share);

struct SampleOptions {
  int ticks_per_sample = 5;   ///< 50 ms lose nothing that the low-pass lets through
  double low_pass_s = 0.025;  ///< deviation of the Gaussian: -3 dB at 5.3 Hz; the hanging excitation ends at 2.1 Hz
  /// Mean between every tick and the next one [m/s^2, IMU axes], where that is known better than by mean_of_readings().
  std::span<const Eigen::Vector3d> specific_force_I{};
};

/// Samples at the same times whatever the low-pass; none for recordings shorter than 0.2 s.
std::vector<RobotSample> robot_samples(const RobotRecording& recording, const SampleOptions& options = {});

}  // namespace pmg::robot_diagnosis
