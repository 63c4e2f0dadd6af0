// An emulated IMU that is an EtherCAT slave: counter, status, quaternion, rate of turn, acceleration.
#pragma once

#include <bit>

#include "ethercat/emulated_slave.hpp"
#include "ethercat/process_data_imu.hpp"
#include "model/robot_io.hpp"

namespace pmg::test {

class EmulatedImu final : public EmulatedSlave {
 public:
  static constexpr int kInputBytes = 44;
  static constexpr std::uint32_t kVendor = 0x4321, kProduct = 0x8765;
  static ethercat::ImuSlave model(int slave, int alias) {
    return {.slave = slave,
            .alias = alias,
            .vendor_id = kVendor,
            .product_code = kProduct,
            .input_bytes = kInputBytes,
            .counter_at = 0,
            .status_at = 2,
            .quaternion_at = 4,
            .rate_of_turn_at = 20,
            .acceleration_at = 32};
  }

  EmulatedImu()
      : EmulatedSlave({.name = "IMU", .vendor_id = kVendor, .product_code = kProduct, .input_bytes = kInputBytes}) {}

  void feel(const model::RobotState& state) noexcept {
    if (silent) return;
    ++counter_;
    const Eigen::Quaterniond& q = state.orientation_WI;
    values_ = {q.w(),
               q.x(),
               q.y(),
               q.z(),
               state.gyro_rad_s.x(),
               state.gyro_rad_s.y(),
               state.gyro_rad_s.z(),
               state.acceleration_m_s2.x(),
               state.acceleration_m_s2.y(),
               state.acceleration_m_s2.z()};
  }
  std::uint16_t status = 0;
  bool silent = false;  ///< its counter stays

 private:
  void take(std::span<const std::uint8_t>) override {}
  void give(std::span<std::uint8_t> inputs, std::span<const std::uint8_t>) override {
    put16(inputs, counter_);
    put16(inputs.subspan(2), status);
    for (std::size_t i = 0; i < values_.size(); ++i) {
      const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(values_[i]));
      put16(inputs.subspan(4 + 4 * i), static_cast<std::uint16_t>(bits));
      put16(inputs.subspan(6 + 4 * i), static_cast<std::uint16_t>(bits >> 16U));
    }
  }
  static void put16(std::span<std::uint8_t> to, std::uint16_t value) {
    to[0] = static_cast<std::uint8_t>(value);
    to[1] = static_cast<std::uint8_t>(value >> 8U);
  }

  std::uint16_t counter_ = 0;
  std::array<double, 10> values_{1.0};
};

}  // namespace pmg::test
