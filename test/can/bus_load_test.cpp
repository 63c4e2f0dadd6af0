#include "can/bus_load.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "../sim/robots.hpp"
#include "drive_protocols/canopen_drive.hpp"

namespace pmg::can {
namespace {

TEST(BusLoad, AFrameOfEightBytesTakes135BitsAtWorst) {
  // 47 bits of frame and intermission, 64 of data, 24 of stuffing: (34 + 64 - 1) / 4.
  EXPECT_DOUBLE_EQ(frame_time_s(8, 1'000'000, 0), 135e-6);
  EXPECT_DOUBLE_EQ(frame_time_s(0, 500'000, 0), 2.0 * 55e-6);
  EXPECT_DOUBLE_EQ(frame_time_s(8, 1'000'000, 5'000'000), 34e-6 + (5 + 64 + 17 + 27) / 5e6);
}

TEST(BusLoad, Z1sBusesCarryTheirFrames) {
  const can::DriveSetup setup = can::load_drives(z1());
  check_load(setup);
  int motors = 0, fullest = 0;
  for (const can::BusSetup& bus : setup.buses) {
    motors += static_cast<int>(bus.motors.size());
    fullest = std::max(fullest, planned_load(bus).frames);
  }
  EXPECT_EQ(motors, 31);
  EXPECT_EQ(fullest, 14) << "an arm's seven drives";
}

TEST(BusLoad, TheImuTakesThreeFramesOfItsBus) {
  can::DriveSetup setup = can::load_drives(z1());
  can::BusSetup bus = setup.buses[0];
  const BusLoad without = planned_load(bus);
  bus.imu = true;
  EXPECT_EQ(planned_load(bus).frames, without.frames + 3);
  EXPECT_NEAR(planned_load(bus).time_s, without.time_s + 3 * 135e-6, 1e-12);
}

TEST(BusLoad, ACanopenDriveTakesThreeFramesAndItsBusSyncAndHeartbeat) {
  can::DriveSetup setup = can::load_drives(z1());
  setup.buses.resize(1);
  std::vector<drives::MotorSetup>& motors = setup.buses[0].motors;
  motors.erase(motors.begin() + 4, motors.end());
  for (drives::MotorSetup& motor : motors) motor.drive = drives::cia402_drive({});
  const BusLoad load = planned_load(setup.buses[0]);
  EXPECT_EQ(load.frames, 14);
  EXPECT_NEAR(load.time_s, 12 * 135e-6 + 55e-6 + 65e-6, 1e-12);
  check_load(setup);
  motors.push_back(motors.back());
  EXPECT_THROW(check_load(setup), std::invalid_argument);
}

TEST(BusLoad, ABusThatCantCarryItsFramesIsRefused) {
  can::DriveSetup setup = can::load_drives(z1());
  setup.buses[0].motors.push_back(setup.buses[0].motors.back());
  check_load(setup);  // seven
  setup.buses[0].motors.push_back(setup.buses[0].motors.back());
  try {
    check_load(setup);
    FAIL() << "eight motors at 1 Mbit/s";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "can0: 16 frames a cycle take 2.16 ms at 1000000 bit/s with the worst bit stuffing; expected 2 ms at "
                 "most: fewer motors on "
                 "this bus, or CAN FD (data_bitrate)");
  }
  setup.buses[0].data_bitrate = 5'000'000;
  check_load(setup);
  setup.buses[0].bitrate = 250'000;
  EXPECT_THROW(check_load(setup), std::invalid_argument);
}

}  // namespace
}  // namespace pmg::can
