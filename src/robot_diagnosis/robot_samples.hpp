// Inputs of the equations of motion: means of a recording over control ticks, all with the same low-pass.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "pmg/types.hpp"
#include "robot_diagnosis/robot_recording.hpp"

namespace pmg::robot_diagnosis {

/// Weighted means over a few ticks. Joint vectors are in joint order. Torques are nominal, with the gains as commanded:
/// spring + damper + feed_forward.
struct RobotSample {
  double t_s = 0.0;
  JointVector q, dq, ddq;
  JointVector spring_Nm, damper_Nm, feed_forward_Nm;
  JointVector direction;                                     ///< of motion, -1 to 1; near 0 at rest or at a reversal
  JointVector late_Nm_per_s;                                 ///< d torque / d delay of the command
  Eigen::Vector3d omega_I, alpha_I, specific_force_I, up_I;  ///< IMU frame; up_I by the IMU's own orientation, unit
};

/// Torque ripple: each joint's torque at the reading of tick k minus its trend [Nm]; 0 at both ends. A command that is
/// held for a tick makes a sawtooth torque, so a reading at a tick's end differs from the tick's mean.
std::vector<JointVector> torque_ripple(const RobotRecording& recording);

/// Mean accelerometer reading between two ticks, from both readings: at + share * (after - at), with
/// DriveSampling::acceleration_share.
Eigen::Vector3d mean_of_readings(const Eigen::Vector3d& at, const Eigen::Vector3d& after, double share);

struct SampleOptions {
  int ticks_per_sample = 5;   ///< a sample per 50 ms: its Nyquist frequency, 10 Hz, lies above the low-pass
  double low_pass_s = 0.025;  ///< deviation of the Gaussian: -3 dB at sqrt(ln 2) / (2 pi 0.025 s) = 5.3 Hz
  /// Direction of motion: tanh(dq / turning_rad_s), dq after a low-pass of this deviation.
  double direction_low_pass_s = 0.025, turning_rad_s = 0.02;
  /// Mean specific force between every tick and the next [m/s^2, IMU axes]; empty: mean_of_readings() is used.
  std::span<const Eigen::Vector3d> specific_force_I{};
};

/// (recording) => (samples). Their times do not depend on the low-pass. Empty for recordings shorter than 0.2 s.
std::vector<RobotSample> robot_samples(const RobotRecording& recording, const SampleOptions& options = {});

}  // namespace pmg::robot_diagnosis
