#include "can/bus_load.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "hal/bus_cycle.hpp"

namespace pmg::can {

namespace {
constexpr double kPeriod_s = static_cast<double>(hal::BusCycle::kPeriod_ns) * 1e-9;
constexpr int kFrameBytes = 8, kImuFrames = 3;
}  // namespace

double frame_time_s(int bytes, int bitrate, int data_bitrate) {
  const int payload = 8 * bytes;
  if (data_bitrate == 0) {
    const int stuffed = (34 + payload - 1) / 4, bits = 47 + payload + stuffed;
    return static_cast<double>(bits) / bitrate;
  }
  const int crc = bytes > 16 ? 32 : 27, stuffed = (5 + payload) / 4, fast_bits = 5 + payload + stuffed + crc;
  return 34.0 / bitrate + static_cast<double>(fast_bits) / data_bitrate;
}

BusLoad planned_load(const BusSetup& bus) {
  BusLoad load;
  const auto add = [&](int frames, int bytes, int data_bitrate) {
    load.frames += frames;
    load.time_s += frames * frame_time_s(bytes, bus.bitrate, data_bitrate);
  };
  for (const drives::MotorSetup& motor : bus.motors) {
    add(motor.drive->messages_a_cycle(), kFrameBytes, bus.data_bitrate);
  }
  if (const auto network = drives::network_of(bus)) {
    for (const drives::NetworkMessage& message : network->messages()) {
      if (message.in_cycle) add(1, message.bytes, 0);
    }
  }
  if (bus.imu) add(kImuFrames, kFrameBytes, 0);  // the IMU sends classic frames
  load.share = load.time_s / kPeriod_s;
  return load;
}

void check_load(const DriveSetup& setup) {
  for (const BusSetup& bus : setup.buses) {
    if (!bus.on_can) continue;
    const BusLoad load = planned_load(bus);
    if (load.share <= 1.0) continue;
    throw std::invalid_argument(
        fmt::format("{}: {} frames a cycle take {:.2f} ms at {} bit/s with the worst bit stuffing; expected {:.0f} ms "
                    "at most: fewer "
                    "motors on this bus{}",
                    bus.name, load.frames, 1e3 * load.time_s, bus.bitrate, 1e3 * kPeriod_s,
                    bus.has_canopen() ? "" : ", or CAN FD (data_bitrate)"));
  }
}

}  // namespace pmg::can
