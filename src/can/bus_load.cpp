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

BusLoad planned_load(const drives::BusSetup& bus) {
  BusLoad load;
  load.frames = 2 * static_cast<int>(bus.motors.size());
  load.time_s = load.frames * frame_time_s(kFrameBytes, bus.bitrate, bus.data_bitrate);
  if (bus.imu) {  // the IMU sends classic frames
    load.frames += kImuFrames;
    load.time_s += kImuFrames * frame_time_s(kFrameBytes, bus.bitrate, 0);
  }
  load.share = load.time_s / kPeriod_s;
  return load;
}

void check_load(const drives::DriveSetup& setup) {
  for (const drives::BusSetup& bus : setup.buses) {
    const BusLoad load = planned_load(bus);
    if (load.share <= 1.0) continue;
    throw std::invalid_argument(
        fmt::format("{}: {} frames a cycle take {:.2f} ms at {} bit/s with the worst bit stuffing; expected {:.0f} ms "
                    "at most: fewer "
                    "motors on this bus, or CAN FD (data_bitrate)",
                    bus.name, load.frames, 1e3 * load.time_s, bus.bitrate, 1e3 * kPeriod_s));
  }
}

}  // namespace pmg::can
