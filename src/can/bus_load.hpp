// What a bus has to carry, planned before anything is sent.
#pragma once

#include "can/bus_setup.hpp"

namespace pmg::can {

/// Time of one frame with an 11-bit identifier on the wire, intermission included, at the worst bit stuffing [s].
/// Classic (ISO 11898-1): 47 + 8 n + floor((34 + 8 n - 1) / 4) bits.
/// FD with bit rate switch: 30 + 4 bits at the nominal rate (17 before the switch, 4 stuff bits in them, 13 after it)
/// and 5 + 8 n + floor((5 + 8 n) / 4) + 27 at the data rate (27: stuff count, CRC-17 and their fixed stuff bits; CRC-21
/// has 5 more from 17 bytes on).
double frame_time_s(int bytes, int bitrate, int data_bitrate);

struct BusLoad {
  int frames = 0;       ///< a cycle, both directions
  double time_s = 0.0;  ///< of them at the worst stuffing
  double share = 0.0;   ///< of the bus cycle
};

/// In each cycle of 2 ms: a command and a reply of each MIT drive, RPDO1, TPDO1 and TPDO2 of each CANopen drive, SYNC
/// and a heartbeat on a bus with such drives, and three frames of the IMU.
BusLoad planned_load(const BusSetup& bus);

/// Throws std::invalid_argument when a CAN bus can't carry its frames in every cycle.
void check_load(const DriveSetup& setup);

}  // namespace pmg::can
