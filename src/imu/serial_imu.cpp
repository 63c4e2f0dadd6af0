#include "imu/serial_imu.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "imu/at_rest.hpp"

namespace pmg::imu {

namespace {

constexpr std::uint16_t kNoRate = 0xFFFF;         // of what comes with every message
constexpr std::uint16_t kInertialSensors = 0x3F;  // bits 0 to 5: accelerometers and gyroscopes; then magnetometers,
                                                  // whose heading nothing here uses

/// Pairs of identifier and rate: what the device is to send, in this order.
std::vector<std::uint8_t> wanted_outputs(int rate_Hz) {
  const auto rate = static_cast<std::uint16_t>(rate_Hz);
  std::vector<std::uint8_t> data;
  for (const auto& [id, at] :
       {std::pair{kPacketCounter, kNoRate}, std::pair{kQuaternion, rate}, std::pair{kAcceleration, rate},
        std::pair{kRateOfTurn, rate}, std::pair{kStatusWord, kNoRate}}) {
    for (const std::uint16_t value : {id, at}) {
      data.push_back(static_cast<std::uint8_t>(value >> 8U));
      data.push_back(static_cast<std::uint8_t>(value & 0xFFU));
    }
  }
  return data;
}

std::string names_of(std::uint16_t failed) {
  constexpr std::array<const char*, 6> kNames = {"accelerometer x", "accelerometer y", "accelerometer z",
                                                 "gyroscope x",     "gyroscope y",     "gyroscope z"};
  std::string text;
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if ((failed >> i & 1U) != 0) text += (text.empty() ? "" : ", ") + std::string(kNames[i]);
  }
  return text;
}

}  // namespace

SerialImu::SerialImu(const model::SerialImuModel& setup, const Wait& wait)
    : setup_(setup), port_(setup.device, setup.baud) {
  ask(MtiId::kGoToConfig, {}, wait);
  configure(wait);
  test_itself(wait);
  ask(MtiId::kGoToMeasurement, {}, wait);
  for (int k = 0; k < kWaits && age_ != 0; ++k) {
    hear();
    if (age_ != 0) wait();
  }
  if (age_ != 0)
    throw std::runtime_error(
        fmt::format("IMU on {}: sends no sample; expected {} a second", setup.device, setup.rate_Hz));
  check_at_rest(sample_, fmt::format("IMU on {}", setup.device));
}

std::vector<std::uint8_t> SerialImu::ask(MtiId id, Bytes data, const Wait& wait) {
  constexpr int kTries = 3;  // a device that sends data may miss the first request
  const auto answer = static_cast<MtiId>(static_cast<std::uint8_t>(id) + 1);
  for (int k = 0; k < kTries * kWaits; ++k) {
    if (k % kWaits == 0) port_.write(mti_message(id, data));
    wait();
    for (std::size_t got = port_.read(incoming_); got > 0; got = port_.read(incoming_)) {
      framer_.hear(Bytes(incoming_).first(got));
      while (const auto message = framer_.next()) {
        if (message->id == answer) return {message->data.begin(), message->data.end()};
        if (message->id != MtiId::kError) continue;
        throw std::runtime_error(fmt::format("IMU on {}: refuses message 0x{:02X} with error {}", setup_.device,
                                             static_cast<int>(id), message->data.empty() ? 0 : message->data[0]));
      }
    }
  }
  throw std::runtime_error(
      fmt::format("IMU on {}: does not answer; expected an Xsens MTi at {} baud", setup_.device, setup_.baud));
}

void SerialImu::configure(const Wait& wait) {
  const std::vector<std::uint8_t> wanted = wanted_outputs(setup_.rate_Hz);
  if (ask(MtiId::kOutputConfiguration, {}, wait) == wanted) return;
  if (ask(MtiId::kOutputConfiguration, wanted, wait) == wanted) return;
  throw std::runtime_error(
      fmt::format("IMU on {}: doesn't send quaternion, acceleration and rate of turn at {} Hz; expected `rate_Hz` to "
                  "be a rate of this device",
                  setup_.device, setup_.rate_Hz));
}

void SerialImu::test_itself(const Wait& wait) {
  const std::vector<std::uint8_t> result = ask(MtiId::kRunSelfTest, {}, wait);
  if (result.size() < 2) throw std::runtime_error(fmt::format("IMU on {}: its self-test has no result", setup_.device));
  // The last two bytes; newer devices send four.
  const std::size_t last = result.size() - 1;
  const auto passed = static_cast<std::uint16_t>(result[last - 1] << 8U | result[last]);
  const auto failed = static_cast<std::uint16_t>(~passed & kInertialSensors);
  if (failed != 0)
    throw std::runtime_error(fmt::format("IMU on {}: its self-test failed: {}; expected every sensor to pass",
                                         setup_.device, names_of(failed)));
}

void SerialImu::begin_cycle() noexcept { age_ = std::min(age_ + 1, kNever); }

void SerialImu::hear() noexcept {
  // A read may return before everything that waits in the kernel has reached it; only one that finds nothing ends.
  for (int k = 0; k < kReads; ++k) {
    const std::size_t got = port_.read(incoming_);
    if (got == 0) return;
    Bytes rest = Bytes(incoming_).first(got);
    do {
      rest = rest.subspan(framer_.hear(rest));
      while (const auto message = framer_.next()) take(*message);
    } while (!rest.empty());
  }
}

void SerialImu::take(const MtiMessage& message) noexcept {
  if (message.id != MtiId::kData) return;
  const auto sample = decode_mti_sample(message.data);
  if (!sample) {
    ++counts_.not_believed;
    return;
  }
  if (counts_.samples > 0) counts_.lost += static_cast<std::uint16_t>(sample->counter - sample_.counter - 1);
  ++counts_.samples;
  if (!sample->certain) ++counts_.uncertain;
  sample_ = *sample;
  age_ = 0;
}

ImuCounts SerialImu::counts() const noexcept {
  ImuCounts counts = counts_;
  counts.checksum_errors = framer_.checksum_errors();
  counts.skipped_bytes = framer_.skipped_bytes();
  return counts;
}

}  // namespace pmg::imu
