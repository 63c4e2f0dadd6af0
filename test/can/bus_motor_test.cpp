#include "can/bus_motor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "../sim/robots.hpp"
#include "can/mixed_drives.hpp"

namespace pmg::can {
namespace {

struct MonitoredMotor {
  MonitoredMotor(const drives::MotorSetup& setup, const drives::BusSetup& bus)
      : monitor(setup.limits), motor(setup, bus, monitor) {}
  drives::MotorMonitor monitor;
  BusMotor motor;
};

/// A motor of which three requests are unanswered, and which answers: it is paused.
template <typename Ask>
void bring_to_pause(MonitoredMotor& one, const Frame& answer, Ask ask) {
  for (int k = 0; k < 3; ++k) {
    one.monitor.begin();
    ask();
  }
  one.motor.hear(answer);
  one.monitor.begin();
}

TEST(BusMotor, AnMitDriveInAPauseGetsAStopAllTheSame) {
  const drives::BusSetup bus = drives::load_drives(z1()).buses[0];
  const drives::MotorSetup& knee = bus.motors[3];
  const Frame answer = Frame::of(
      0,
      drives::MitProtocol(std::get<drives::MitRanges>(knee.drive)).reply({static_cast<std::uint8_t>(knee.node), {}}));
  const auto paused = [&] {
    auto one = std::make_unique<MonitoredMotor>(knee, bus);
    bring_to_pause(*one, answer, [&] { EXPECT_TRUE(one->motor.ask({}, {})); });
    return one;
  };
  const auto waits = paused(), stops = paused(), off = paused();
  EXPECT_FALSE(waits->motor.ask({}, {}));
  EXPECT_TRUE(stops->motor.ask({}, {.urgent = true}));
  const auto disable = off->motor.ask_off(false);
  ASSERT_TRUE(disable);
  EXPECT_TRUE(std::ranges::equal(disable->bytes(), drives::kMitDisable));
}

TEST(BusMotor, ACanopenDriveInAPauseGetsItsTargetsAndNoSync) {
  const drives::BusSetup bus = test::mixed_drives(z1()).buses[0];
  MonitoredMotor one(bus.motors[0], bus);
  BusMotor& motor = one.motor;
  const auto node = static_cast<std::uint32_t>(bus.motors[0].node);
  motor.hear(Frame::of(canopen::kTransmit1 + node, std::array<std::uint8_t, 8>{0x50, 0x02}));
  bring_to_pause(one, Frame::of(canopen::kTransmit2 + node, std::array<std::uint8_t, 8>{}),
                 [&] { motor.ask({}, {.synced = true}); });
  EXPECT_TRUE(motor.pauses_sync());
  motor.ask({}, {.synced = false});
  EXPECT_TRUE(motor.targets());
}

TEST(BusMotor, WhatNeverLeftThisComputerIsNotAskedFor) {
  const drives::BusSetup bus = drives::load_drives(z1()).buses[0];
  MonitoredMotor one(bus.motors[3], bus);
  BusMotor& motor = one.motor;
  one.monitor.begin();
  motor.ask({}, {});
  motor.not_asked();
  motor.not_asked();
  EXPECT_TRUE(motor.monitor().settled());
  EXPECT_FALSE(motor.monitor().enabled());
}

}  // namespace
}  // namespace pmg::can
