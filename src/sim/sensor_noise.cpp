#include "sim/sensor_noise.hpp"

#include <cmath>

namespace pmg::sim {

double NormalSource::next() noexcept {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  double u = 0.0, v = 0.0, s = 0.0;
  do {
    u = 2.0 * (static_cast<double>(engine_() >> 11) * 0x1p-53) - 1.0;  // 53 random bits in [-1, 1)
    v = 2.0 * (static_cast<double>(engine_() >> 11) * 0x1p-53) - 1.0;
    s = u * u + v * v;
  } while (s >= 1.0 || s == 0.0);
  const double scale = std::sqrt(-2.0 * std::log(s) / s);
  spare_ = v * scale;
  has_spare_ = true;
  return u * scale;
}

SensorNoise::SensorNoise(const WorldOptions& options, int joints)
    : normal_(options.seed),
      gyro_deviation_rad_s_(options.gyro_noise_rad_s),
      encoder_deviation_rad_(options.encoder_noise_rad),
      orientation_deviation_rad_(options.orientation_noise_rad),
      velocity_deviation_rad_s_(options.velocity_noise_rad_s),
      encoder_rad_(JointVector::Zero(joints)),
      velocity_rad_s_(JointVector::Zero(joints)) {
  draw();
}

void SensorNoise::draw() noexcept {
  if (encoder_deviation_rad_ > 0.0)
    for (double& e : encoder_rad_) e = encoder_deviation_rad_ * normal_.next();
  gyro_rad_s_ = vector(gyro_deviation_rad_s_);
  const Eigen::Vector3d half_rotation = 0.5 * vector(orientation_deviation_rad_);
  orientation_ = Eigen::Quaterniond(1.0, half_rotation.x(), half_rotation.y(), half_rotation.z()).normalized();
  if (velocity_deviation_rad_s_ > 0.0)
    for (double& v : velocity_rad_s_) v = velocity_deviation_rad_s_ * normal_.next();
}

Eigen::Vector3d SensorNoise::vector(double standard_deviation) noexcept {
  if (standard_deviation <= 0.0) return Eigen::Vector3d::Zero();
  Eigen::Vector3d v;
  for (double& e : v) e = standard_deviation * normal_.next();
  return v;
}

}  // namespace pmg::sim
