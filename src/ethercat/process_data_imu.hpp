// An IMU that is an EtherCAT slave: its sample in each cycle's inputs.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "imu/mti_messages.hpp"

namespace pmg::ethercat {

/// An IMU that is a slave. Numbers are low byte first; offsets in bytes within its inputs.
struct ImuSlave {
  int slave = 0;                                  ///< position on the cable, the first being 1
  int alias = 0;                                  ///< configured station alias; 0: any
  std::uint32_t vendor_id = 0, product_code = 0;  ///< 0: any
  int input_bytes = 0, output_bytes = 0;
  int counter_at = 0;       ///< 2 bytes, another value with each sample
  int status_at = -1;       ///< 2 bytes, 0: self-test passed and sensors in their range; -1: not given
  int quaternion_at = 0;    ///< w, x, y, z; 32-bit floats, as all that follows
  int rate_of_turn_at = 0;  ///< x, y, z [rad/s]
  int acceleration_at = 0;  ///< x, y, z [m/s^2]
};

/// No heap; one thread.
class ProcessDataImu {
 public:
  /// In bus cycles since the last sample, as with an IMU on CAN.
  static constexpr int kLateCycles = 5, kSilentCycles = 10;

  explicit ProcessDataImu(const ImuSlave& setup) noexcept : setup_(setup) {}

  void begin_cycle() noexcept;
  /// This cycle's inputs. A counter that stays, a status other than 0, or values that can't be (imu::believed_sample())
  /// give no sample.
  void take(std::span<const std::uint8_t> inputs) noexcept;

  const imu::MtiSample& sample() const noexcept { return sample_; }
  int age_cycles() const noexcept { return age_; }
  std::uint16_t status() const noexcept { return status_; }  ///< the last that came; 0: good
  std::uint64_t not_believed() const noexcept { return not_believed_; }

 private:
  static constexpr int kNever = 1'000'000;

  ImuSlave setup_;
  imu::MtiSample sample_;
  std::optional<std::uint16_t> counter_;
  std::uint16_t status_ = 0;
  std::uint64_t not_believed_ = 0;
  int age_ = kNever;
};

}  // namespace pmg::ethercat
