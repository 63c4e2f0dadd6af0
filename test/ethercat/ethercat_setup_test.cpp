// What robot.yaml says of bridges, and what it may not say.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>

#include "../sim/robots.hpp"
#include "ethercat/cabled_drives.hpp"
#include "files/config_reader.hpp"
#include "temporary_folder.hpp"

namespace pmg::ethercat {
namespace {

class BridgeSetup : public testing::Test {
 protected:
  BridgeSetup() {
    robot_.directory = folder_.path();
    std::ofstream(folder_.file("robot.yaml"))
        << "buses: {can0: {}}\nethercat: {interface: eth9, frames_out: 8, frames_in: 12, vendor_id: 0x1234}\n";
  }
  std::string refusal() {
    try {
      load_ethercat(robot_, drives_);
    } catch (const files::ConfigError& error) {
      return error.what();
    }
    return "loaded";
  }

  test::TemporaryFolder folder_;
  model::RobotModel robot_ = z1();
  can::DriveSetup drives_ = test::CabledDrives(z1()).setup;
};

TEST_F(BridgeSetup, EachBusHasAChannelOfItsOwn) {
  EXPECT_EQ(refusal(), "loaded");
  EXPECT_EQ(load_ethercat(robot_, drives_).vendor_id, 0x1234u);
  const std::vector<SlaveSetup> slaves = expected_slaves(load_ethercat(robot_, drives_), drives_, {});
  ASSERT_EQ(slaves.size(), 5u);
  EXPECT_EQ(slaves[1].alias, test::CabledDrives::kFirstAlias + 2);
  EXPECT_EQ(slaves[1].output_bytes, 4u + 13 * 8);
  EXPECT_EQ(slaves[1].input_bytes, 4u + 13 * 12);
}

TEST_F(BridgeSetup, SlavesThatCannotBeToldApartAreRefused) {
  drives_.buses[1].bridge_alias = 0;
  EXPECT_THAT(refusal(), testing::HasSubstr("don't tell slave 2 (can1's bridge) from the others"));
  drives_.buses[1].bridge_alias = drives_.buses[0].bridge_alias;
  EXPECT_THAT(refusal(), testing::HasSubstr("don't tell slave 1 (can0's bridge) from the others"));
}

TEST_F(BridgeSetup, WhatABridgeCannotCarryIsRefused) {
  const auto with = [this](const std::function<void(can::BusSetup&)>& change) {
    const can::BusSetup kept = drives_.buses[1];
    change(drives_.buses[1]);
    const std::string said = refusal();
    drives_.buses[1] = kept;
    return said;
  };
  EXPECT_THAT(with([](auto& bus) { bus.bridge_slave = 0; }), testing::HasSubstr("can1: has no `bridge`"));
  EXPECT_THAT(with([](auto& bus) { bus.bridge_slave = 1; }), testing::HasSubstr("the bridge's channel of another bus"));
  EXPECT_THAT(with([](auto& bus) { bus.bridge_slave = 9; }), testing::HasSubstr("have nobody as slave 2"));
  EXPECT_THAT(with([](auto& bus) { bus.data_bitrate = 5'000'000; }), testing::HasSubstr("CAN FD behind a bridge"));
  EXPECT_THAT(with([](auto& bus) { bus.motors.resize(9, bus.motors[0]); }), testing::HasSubstr("sends 9 frames"));
}

}  // namespace
}  // namespace pmg::ethercat
