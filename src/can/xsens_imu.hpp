// An IMU on the CAN bus: Xsens MTi's CAN protocol, fixed-point integers, high byte first.
#pragma once

#include <array>
#include <cstdint>

#include "drives/message.hpp"
#include "model/robot_io.hpp"

namespace pmg::can {

/// Standard identifiers of the MTi's data messages (MT Low Level Communication Protocol, CAN section).
inline constexpr std::uint32_t kImuQuaternion = 0x21;    ///< w, x, y, z in 2^-15
inline constexpr std::uint32_t kImuRateOfTurn = 0x32;    ///< x, y, z in 2^-9 rad/s
inline constexpr std::uint32_t kImuAcceleration = 0x34;  ///< x, y, z in 2^-8 m/s^2

/// The three messages make one sample. No heap.
class XsensImu {
 public:
  /// In cycles, since all three messages last came: at 100 Hz and more, which the policy needs, the IMU is good.
  static constexpr int kLateCycles = 5, kSilentCycles = 10;

  void begin_cycle() noexcept;
  bool hear(const drives::Message& frame) noexcept;  ///< false: not the IMU's, or not believed
  void read(model::RobotState& state) const noexcept;
  int age_cycles() const noexcept { return age_; }

 private:
  static constexpr int kNever = 1'000'000;
  Eigen::Quaterniond orientation_WI_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d gyro_rad_s_ = Eigen::Vector3d::Zero(), acceleration_m_s2_ = Eigen::Vector3d::Zero();
  std::array<int, 3> ages_ = {kNever, kNever, kNever};
  int age_ = kNever;
};

/// The IMU's own three frames of a state.
std::array<drives::Message, 3> imu_frames(const model::RobotState& state) noexcept;

}  // namespace pmg::can
