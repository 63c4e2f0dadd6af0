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

std::string refusal(const drives::DriveSetup& setup) {
  try {
    check_ids(setup);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "taken";
}

drives::MitRanges& mit(drives::MotorSetup& motor) { return std::get<drives::MitRanges>(motor.drive); }

TEST(BusIds, RobotsWithOneSenderOfEachIdentifierAreTaken) {
  EXPECT_EQ(refusal(drives::load_drives(z1())), "taken") << "all MIT drives of a bus may reply with one identifier";
  EXPECT_EQ(refusal(test::mixed_drives(z1())), "taken");
}

TEST(BusIds, TwoSendersOfOneIdentifierAreNamed) {
  drives::DriveSetup setup = drives::load_drives(z1());
  drives::BusSetup& with_imu = *std::ranges::find(setup.buses, true, &drives::BusSetup::imu);
  ASSERT_GE(with_imu.motors.size(), 2u);
  drives::MotorSetup& motor = with_imu.motors[0];
  const int node = motor.node;
  motor.node = 0x21;
  EXPECT_EQ(refusal(setup), with_imu.name + ": " + motor.joint +
                                "'s commands and the IMU have the identifier 0x21; expected one sender: another "
                                "`node`, or `reply_id`");
  motor.node = node;
  mit(motor).reply_id = 0x34;
  EXPECT_THAT(refusal(setup), testing::HasSubstr("'s replies and the IMU have the identifier 0x34"));
  mit(motor).reply_id = static_cast<std::uint32_t>(with_imu.motors[1].node);
  EXPECT_THAT(refusal(setup), testing::HasSubstr(motor.joint + "'s replies and " + with_imu.motors[1].joint +
                                                 "'s commands have the identifier"));
  mit(motor).reply_id = static_cast<std::uint32_t>(node);
  EXPECT_THAT(refusal(setup), testing::HasSubstr("'s commands and " + motor.joint + "'s replies have"))
      << "a drive can't answer with its own command's identifier";
}

TEST(BusIds, CanopensIdentifiersAreNoOthers) {
  drives::DriveSetup setup = test::mixed_drives(z1());
  drives::BusSetup& bus = setup.buses[0];
  ASSERT_TRUE(bus.has_canopen());
  ASSERT_EQ(bus.motors[0].node, 1);
  for (const std::uint32_t taken : {0x000U, 0x080U, 0x081U, 0x181U, 0x201U, 0x281U, 0x581U, 0x601U, 0x701U, 0x77FU}) {
    mit(bus.motors[3]).reply_id = taken;
    EXPECT_THAT(refusal(setup), testing::HasSubstr("have the identifier")) << taken;
  }
  mit(bus.motors[3]).reply_id = 0x500;
  EXPECT_EQ(refusal(setup), "taken");
}

}  // namespace
}  // namespace pmg::can
