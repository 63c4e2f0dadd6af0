// Gaussian sensor noise; one seed gives the same noise on every machine.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <random>

#include "pmg/types.hpp"
#include "sim/world.hpp"

namespace pmg::sim {

/// Standard normal numbers by Marsaglia's polar method (SIAM Review 6:260, 1964). std::normal_distribution may differ
/// between standard libraries; the engine may not.
class NormalSource {
 public:
  explicit NormalSource(std::uint64_t seed) : engine_(seed) {}
  double next() noexcept;

 private:
  std::mt19937_64 engine_;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

/// Everything that the sensors add to the truth, drawn once per bus sample.
class SensorNoise {
 public:
  SensorNoise(const WorldOptions& options, int joints);
  void draw() noexcept;

  const JointVector& encoder_rad() const { return encoder_rad_; }
  const JointVector& velocity_rad_s() const { return velocity_rad_s_; }
  const Eigen::Vector3d& gyro_rad_s() const { return gyro_rad_s_; }
  const Eigen::Quaterniond& orientation() const { return orientation_; }

 private:
  Eigen::Vector3d vector(double standard_deviation) noexcept;

  NormalSource normal_;
  double gyro_deviation_rad_s_, encoder_deviation_rad_, orientation_deviation_rad_, velocity_deviation_rad_s_;
  JointVector encoder_rad_, velocity_rad_s_;
  Eigen::Vector3d gyro_rad_s_ = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation_ = Eigen::Quaterniond::Identity();  ///< a small rotation
};

}  // namespace pmg::sim
