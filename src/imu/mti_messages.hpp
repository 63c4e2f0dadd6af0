// Messages of Xsens MTi devices on a serial line (MT Low Level Communication Protocol): framing and measured data.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace pmg::imu {

using Bytes = std::span<const std::uint8_t>;

/// Message identifiers; a device acknowledges a request with its identifier plus one.
enum class MtiId : std::uint8_t {
  kGoToMeasurement = 0x10,
  kRunSelfTest = 0x24,
  kGoToConfig = 0x30,
  kData = 0x36,  ///< MTData2
  kWakeUp = 0x3E,
  kError = 0x42,
  kOutputConfiguration = 0xC0,  ///< empty: asks; with data: sets
};

/// Identifiers of the data within MTData2. Values are 32-bit floats, high byte first; orientation in ENU (world z up).
inline constexpr std::uint16_t kPacketCounter = 0x1020, kQuaternion = 0x2010, kAcceleration = 0x4020,
                               kRateOfTurn = 0x8020, kStatusWord = 0xE020;

struct MtiMessage {
  MtiId id = MtiId::kData;
  Bytes data;  ///< valid until the framer hears more
};

/// 0xFA 0xFF ID LENGTH DATA CHECKSUM: all bytes but the first add up to 0 modulo 256.
std::vector<std::uint8_t> mti_message(MtiId id, Bytes data = {});

/// Finds messages in a stream of bytes. After garbage it takes the first whole message again. No heap.
class MtiFramer {
 public:
  static constexpr std::size_t kRoom = 4096;  ///< what a Linux serial line holds at most

  /// Takes so many of the bytes as there is room for; the number of these. All are taken once next() has given nullopt.
  std::size_t hear(Bytes bytes) noexcept;
  std::optional<MtiMessage> next() noexcept;

  std::uint64_t skipped_bytes() const noexcept { return skipped_; }            ///< that belonged to no message
  std::uint64_t checksum_errors() const noexcept { return checksum_errors_; }  ///< messages that were damaged

 private:
  std::array<std::uint8_t, kRoom> bytes_{};
  std::size_t begin_ = 0, end_ = 0;
  std::uint64_t skipped_ = 0, checksum_errors_ = 0;
};

struct MtiSample {
  Eigen::Quaterniond orientation_WI = Eigen::Quaterniond::Identity();  ///< unit length
  Eigen::Vector3d gyro_rad_s = Eigen::Vector3d::Zero(),
                  acceleration_m_s2 = Eigen::Vector3d::Zero();  ///< in the IMU's frame
  std::uint16_t counter = 0;
  bool certain = true;  ///< the device's filter is valid, and no sensor is at the end of its range
};

/// (w, x, y, z; rad/s; m/s^2) => the sample. Nullopt: a value isn't finite, or can't be: a quaternion whose length
/// differs by 1 % from 1, more than 100 rad/s, more than 1000 m/s^2.
std::optional<MtiSample> believed_sample(const Eigen::Vector4d& q_wxyz, const Eigen::Vector3d& gyro_rad_s,
                                         const Eigen::Vector3d& acceleration_m_s2) noexcept;

/// (data of an MTData2 message) => the sample. Nullopt: not whole, a value is missing, or not believed.
std::optional<MtiSample> decode_mti_sample(Bytes data) noexcept;

/// Back: the data of the message that decode_mti_sample() takes.
std::vector<std::uint8_t> encode_mti_sample(const MtiSample& sample);

}  // namespace pmg::imu
