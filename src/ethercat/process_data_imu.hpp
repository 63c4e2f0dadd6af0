// An IMU that is an EtherCAT slave: its sample in each cycle's inputs.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "can/bus_setup.hpp"
#include "imu/mti_messages.hpp"

namespace pmg::ethercat {

/// No heap; one thread.
class ProcessDataImu {
 public:
  /// In bus cycles since the last sample, as with an IMU on CAN.
  static constexpr int kLateCycles = 5, kSilentCycles = 10;

  explicit ProcessDataImu(const can::ImuSlave& setup) noexcept : setup_(setup) {}

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

  can::ImuSlave setup_;
  imu::MtiSample sample_;
  std::optional<std::uint16_t> counter_;
  std::uint16_t status_ = 0;
  std::uint64_t not_believed_ = 0;
  int age_ = kNever;
};

}  // namespace pmg::ethercat
