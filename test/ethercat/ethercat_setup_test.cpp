// What robot.yaml says of bridges, and what it may not say.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <string>
#include <utility>
#include <vector>

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
    drives_ = test::CabledDrives(z1()).setup;
    for (int b = 0; b < 5; ++b) bridges_.push_back(fmt::format("{{slave: {}, alias: {}}}", b + 1, 101 + b));
  }
  EthercatSetup load() {
    std::ofstream file(folder_.file("robot.yaml"));
    file << "imu: {}\nethercat: {interface: eth9, frames_out: 8, frames_in: 12, vendor_id: 0x1234}\nbuses:\n";
    for (std::size_t b = 0; b < bridges_.size(); ++b)
      file << "  can" << b << ": {" << (bridges_[b].empty() ? "" : "bridge: " + bridges_[b]) << "}\n";
    file.close();
    return load_ethercat(robot_, drives_);
  }
  std::string refusal() {
    try {
      load();
    } catch (const files::ConfigError& error) {
      return error.what();
    }
    return "loaded";
  }
  std::string with_second_bridge(const std::string& bridge) {
    const std::string kept = std::exchange(bridges_[1], bridge);
    const std::string said = refusal();
    bridges_[1] = kept;
    return said;
  }

  test::TemporaryFolder folder_;
  model::RobotModel robot_ = z1();
  can::DriveSetup drives_;
  std::vector<std::string> bridges_;  // robot.yaml's, of can0 to can4; empty: none
};

TEST_F(BridgeSetup, EachBusHasAChannelOfItsOwn) {
  EXPECT_EQ(refusal(), "loaded");
  EXPECT_EQ(load().vendor_id, 0x1234u);
  const std::vector<SlaveSetup> slaves = expected_slaves(load(), drives_, {});
  ASSERT_EQ(slaves.size(), 5u);
  EXPECT_EQ(slaves[1].alias, 102);
  EXPECT_EQ(slaves[1].output_bytes, 4u + 13 * 8);
  EXPECT_EQ(slaves[1].input_bytes, 4u + 13 * 12);
}

TEST_F(BridgeSetup, SlavesThatCannotBeToldApartAreRefused) {
  EXPECT_THAT(with_second_bridge("{slave: 2}"),
              testing::HasSubstr("don't tell slave 2 (can1's bridge) from the others"));
  EXPECT_THAT(with_second_bridge("{slave: 2, alias: 101}"),
              testing::HasSubstr("don't tell slave 1 (can0's bridge) from the others"));
}

TEST_F(BridgeSetup, WhatABridgeCannotCarryIsRefused) {
  const auto with = [this](const std::function<void(can::BusSetup&)>& change) {
    const can::BusSetup kept = drives_.buses[1];
    change(drives_.buses[1]);
    const std::string said = refusal();
    drives_.buses[1] = kept;
    return said;
  };
  EXPECT_THAT(with_second_bridge(""), testing::HasSubstr("can1: has no `bridge`"));
  EXPECT_THAT(with_second_bridge("{slave: 1, alias: 101}"), testing::HasSubstr("the bridge's channel of another bus"));
  EXPECT_THAT(with_second_bridge("{slave: 9, alias: 102}"), testing::HasSubstr("have nobody as slave 2"));
  EXPECT_THAT(with_second_bridge("{slave: 2, alais: 102}"), testing::HasSubstr("buses.can1.bridge.alais: is unknown"));
  EXPECT_THAT(with([](auto& bus) { bus.data_bitrate = 5'000'000; }), testing::HasSubstr("CAN FD behind a bridge"));
  EXPECT_THAT(with([](auto& bus) { bus.motors.resize(9, bus.motors[0]); }), testing::HasSubstr("sends 9 frames"));
}

}  // namespace
}  // namespace pmg::ethercat
