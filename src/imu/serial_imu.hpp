// The robot's IMU on a serial line of its own: set-up and self-test at start, then one look a bus cycle.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>

#include "imu/mti_messages.hpp"
#include "imu/serial_port.hpp"
#include "model/robot_model.hpp"

namespace pmg::imu {

/// Called while an answer is awaited, for a millisecond or so. It sleeps; emulators answer in it.
using Wait = std::function<void()>;

struct ImuCounts {
  std::uint64_t samples = 0;
  std::uint64_t lost = 0;          ///< that the device's counter tells and that never came
  std::uint64_t not_believed = 0;  ///< whole messages whose values can't be
  std::uint64_t uncertain = 0;     ///< the device says that its filter or its sensors are at their limits
  std::uint64_t checksum_errors = 0, skipped_bytes = 0;
};

/// hear() has no heap, waits for nothing and takes no lock; one thread.
class SerialImu {
 public:
  /// In bus cycles since the last sample, as with an IMU on CAN.
  static constexpr int kLateCycles = 5, kSilentCycles = 10;
  static constexpr int kWaits = 200;  ///< for one answer, of some 1 ms; a self-test takes 0.1 s

  /// Opens the line, tells the device what to send (only if it sends something else: it keeps that in memory that
  /// wears), runs its self-test of gyroscopes and accelerometers, waits for the first sample and compares it with
  /// gravity: the robot hangs or stands still, so the specific force is 9.81 +- 2 m/s^2 and points up within 20
  /// degrees. Throws std::runtime_error, one line.
  SerialImu(const model::SerialImuModel& setup, const Wait& wait);

  void begin_cycle() noexcept;
  void hear() noexcept;  ///< everything that has come, in at most kReads reads: a line that floods doesn't hold the bus
  const MtiSample& sample() const noexcept { return sample_; }
  int age_cycles() const noexcept { return age_; }
  ImuCounts counts() const noexcept;

 private:
  static constexpr int kNever = 1'000'000;
  static constexpr int kReads = 16;  // of kRoom bytes: two seconds of samples at 400 Hz
  /// The device's answer to a request; throws when there is none.
  std::vector<std::uint8_t> ask(MtiId id, Bytes data, const Wait& wait);
  void configure(const Wait& wait);
  void test_itself(const Wait& wait);
  void take(const MtiMessage& message) noexcept;

  model::SerialImuModel setup_;
  SerialPort port_;
  MtiFramer framer_;
  std::array<std::uint8_t, MtiFramer::kRoom> incoming_{};
  MtiSample sample_;
  ImuCounts counts_;
  int age_ = kNever;
};

}  // namespace pmg::imu
