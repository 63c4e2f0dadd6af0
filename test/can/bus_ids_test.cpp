#include "can/bus_ids.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "../sim/robots.hpp"
#include "can/mixed_drives.hpp"

namespace pmg::can {
namespace {

std::string refusal(const can::DriveSetup& setup) {
  try {
    check_ids(setup);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "taken";
}

/// Its replies get another identifier.
void reply_as(drives::MotorSetup& motor, std::uint32_t id) { motor.drive = motor.drive->replying_as(id); }

TEST(BusIds, RobotsWithOneSenderOfEachIdentifierAreTaken) {
  EXPECT_EQ(refusal(can::load_drives(z1())), "taken") << "all MIT drives of a bus may reply with one identifier";
  EXPECT_EQ(refusal(test::mixed_drives(z1())), "taken");
}

TEST(BusIds, TwoSendersOfOneIdentifierAreNamed) {
  can::DriveSetup setup = can::load_drives(z1());
  can::BusSetup& with_imu = *std::ranges::find(setup.buses, true, &can::BusSetup::imu);
  ASSERT_GE(with_imu.motors.size(), 2u);
  drives::MotorSetup& motor = with_imu.motors[0];
  const int node = motor.node;
  motor.node = 0x21;
  EXPECT_EQ(refusal(setup), with_imu.name + ": " + motor.joint +
                                "'s commands and the IMU have the identifier 0x21; expected one sender: another "
                                "`node`, or `reply_id`");
  motor.node = node;
  reply_as(motor, 0x34);
  EXPECT_THAT(refusal(setup), testing::HasSubstr("'s replies and the IMU have the identifier 0x34"));
  reply_as(motor, static_cast<std::uint32_t>(with_imu.motors[1].node));
  EXPECT_THAT(refusal(setup), testing::HasSubstr(motor.joint + "'s replies and " + with_imu.motors[1].joint +
                                                 "'s commands have the identifier"));
  reply_as(motor, static_cast<std::uint32_t>(node));
  EXPECT_THAT(refusal(setup), testing::HasSubstr("'s commands and " + motor.joint + "'s replies have"))
      << "a drive can't answer with its own command's identifier";
}

TEST(BusIds, CanopensIdentifiersAreNoOthers) {
  can::DriveSetup setup = test::mixed_drives(z1());
  can::BusSetup& bus = setup.buses[0];
  ASSERT_TRUE(bus.has_canopen());
  ASSERT_EQ(bus.motors[0].node, 1);
  for (const std::uint32_t taken : {0x000U, 0x080U, 0x081U, 0x181U, 0x201U, 0x281U, 0x581U, 0x601U, 0x701U, 0x77FU}) {
    reply_as(bus.motors[3], taken);
    EXPECT_THAT(refusal(setup), testing::HasSubstr("have the identifier")) << taken;
  }
  reply_as(bus.motors[3], 0x500);
  EXPECT_EQ(refusal(setup), "taken");
}

}  // namespace
}  // namespace pmg::can
