// A backend of drives, and the IMU beside it on a line of its own.
#pragma once

#include <atomic>
#include <memory>

#include "hal/backend.hpp"
#include "hal/phase_source.hpp"
#include "imu/serial_imu.hpp"

namespace pmg::imu {

/// One bus cycle of drives and IMU. The state is whole: drives' and IMU's values together, or as it was.
class HalWithImu final : public hal::Hal, public hal::PhaseSource {
 public:
  /// Keeps references.
  HalWithImu(hal::Hal& drives, SerialImu& imu)
      : drives_(drives), phase_source_(dynamic_cast<const hal::PhaseSource*>(&drives)), imu_(imu) {}

  /// The drives' status, or the IMU's if that is worse: kStale when it has not spoken for more than 10 ms, kLost for
  /// more than 20 ms.
  hal::BusStatus exchange(const model::JointCommand& command, model::RobotState& state) noexcept override;

  std::int64_t phase_shift_ns() const noexcept override {
    return phase_source_ == nullptr ? 0 : phase_source_->phase_shift_ns();
  }

  bool imu_silent() const noexcept { return silent_.load(std::memory_order_relaxed); }  ///< for any thread
  std::uint64_t damaged() const noexcept {
    return damaged_.load(std::memory_order_relaxed);
  }  ///< messages; for any thread

 private:
  hal::Hal& drives_;
  const hal::PhaseSource* phase_source_;
  SerialImu& imu_;
  model::RobotState whole_;
  std::atomic<bool> silent_{false};
  std::atomic<std::uint64_t> damaged_{0};
};

/// The backend itself where robot.yaml has no `imu.serial` or the robot is simulated; else one whose connect() connects
/// the IMU, too. wait: as SerialImu's; robot outlives it.
std::unique_ptr<hal::Backend> with_imu(std::unique_ptr<hal::Backend> backend, const model::RobotModel& robot,
                                       Wait wait);
Wait sleeping();  ///< for a millisecond

}  // namespace pmg::imu
