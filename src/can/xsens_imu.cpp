#include "can/xsens_imu.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::can {

namespace {

constexpr double kQuaternionStep = 0x1p-15, kRateStep_rad_s = 0x1p-9, kAccelerationStep_m_s2 = 0x1p-8;

double word(const drives::Message& frame, std::size_t index) noexcept {
  const auto bits = static_cast<std::uint16_t>(frame.data[2 * index] << 8U | frame.data[2 * index + 1]);
  return static_cast<std::int16_t>(bits);
}

Eigen::Vector3d vector(const drives::Message& frame, double step) noexcept {
  return step * Eigen::Vector3d(word(frame, 0), word(frame, 1), word(frame, 2));
}

template <typename Values>
drives::Message frame_of(std::uint32_t id, const Values& values, double step) noexcept {
  drives::Message frame;
  frame.id = id;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const auto code = static_cast<std::uint16_t>(std::lround(std::clamp(values[i] / step, -32768.0, 32767.0)));
    frame.data[frame.length++] = static_cast<std::uint8_t>(code >> 8U);
    frame.data[frame.length++] = static_cast<std::uint8_t>(code & 0xFFU);
  }
  return frame;
}

}  // namespace

void XsensImu::begin_cycle() noexcept {
  for (int& age : ages_) age = std::min(age + 1, kNever);
  age_ = *std::ranges::max_element(ages_);
}

bool XsensImu::hear(const drives::Message& frame) noexcept {
  if (frame.extended) return false;
  if (frame.id == kImuQuaternion && frame.length == 8) {
    const Eigen::Quaterniond read(word(frame, 0), word(frame, 1), word(frame, 2), word(frame, 3));
    const double norm = read.norm() * kQuaternionStep;
    if (!(std::abs(norm - 1.0) < 0.01)) return false;  // rounding of the four moves the norm by 6e-5 at most
    orientation_WI_.coeffs() = read.coeffs() / read.norm();
    ages_[0] = 0;
  } else if (frame.id == kImuRateOfTurn && frame.length == 6) {
    gyro_rad_s_ = vector(frame, kRateStep_rad_s);
    ages_[1] = 0;
  } else if (frame.id == kImuAcceleration && frame.length == 6) {
    acceleration_m_s2_ = vector(frame, kAccelerationStep_m_s2);
    ages_[2] = 0;
  } else {
    return false;
  }
  age_ = *std::ranges::max_element(ages_);
  return true;
}

void XsensImu::read(model::RobotState& state) const noexcept {
  state.orientation_WI = orientation_WI_;
  state.gyro_rad_s = gyro_rad_s_;
  state.acceleration_m_s2 = acceleration_m_s2_;
}

std::array<drives::Message, 3> imu_frames(const model::RobotState& state) noexcept {
  const Eigen::Quaterniond& q = state.orientation_WI;
  return {frame_of(kImuQuaternion, Eigen::Vector4d(q.w(), q.x(), q.y(), q.z()), kQuaternionStep),
          frame_of(kImuRateOfTurn, state.gyro_rad_s, kRateStep_rad_s),
          frame_of(kImuAcceleration, state.acceleration_m_s2, kAccelerationStep_m_s2)};
}

}  // namespace pmg::can
