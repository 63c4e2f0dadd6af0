#include "drives/motor_channel.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>

#include "../sim/robots.hpp"
#include "can/mixed_drives.hpp"
#include "drive_protocols/canopen.hpp"
#include "drive_protocols/damiao.hpp"
#include "drive_protocols/mit_drive.hpp"

namespace pmg::drives {
namespace {

struct MonitoredMotor {
  explicit MonitoredMotor(const MotorSetup& setup) : monitor(setup.limits), motor(setup, monitor, false) {}
  std::size_t ask(const MotorChannel::Cycle& cycle) {
    Outbox out;
    motor.ask({}, cycle, out);
    return out.messages().size();
  }
  MotorMonitor monitor;
  MotorChannel motor;
};

/// A motor of which three requests are unanswered, and which answers: it is paused.
template <typename Ask>
void bring_to_pause(MonitoredMotor& one, const Message& answer, Ask ask) {
  for (int k = 0; k < 3; ++k) {
    one.monitor.begin();
    ask();
  }
  one.motor.hear(answer);
  one.monitor.begin();
}

TEST(MotorChannel, AnMitDriveInAPauseGetsAStopAllTheSame) {
  const can::BusSetup bus = can::load_drives(z1()).buses[0];
  const MotorSetup& knee = bus.motors[3];
  const Message answer = as_mit(knee.drive)->reply({static_cast<std::uint8_t>(knee.node), {}});
  const auto paused = [&] {
    auto one = std::make_unique<MonitoredMotor>(knee);
    bring_to_pause(*one, answer, [&] { EXPECT_EQ(one->ask({}), 1u); });
    return one;
  };
  const auto waits = paused(), stops = paused(), off = paused();
  EXPECT_EQ(waits->ask({}), 0u);
  EXPECT_EQ(stops->ask({.urgent = true}), 1u);
  Outbox disable;
  off->motor.ask_off(false, disable);
  ASSERT_EQ(disable.messages().size(), 1u);
  EXPECT_TRUE(std::ranges::equal(disable.messages()[0].bytes(), kMitDisable));
}

TEST(MotorChannel, ACanopenDriveInAPauseGetsItsTargetsAndNoSync) {
  const can::BusSetup bus = test::mixed_drives(z1()).buses[0];
  MonitoredMotor one(bus.motors[0]);
  const auto node = static_cast<std::uint32_t>(bus.motors[0].node);
  one.motor.hear(Message::of(canopen::kTransmit1 + node, std::array<std::uint8_t, 8>{0x50, 0x02}));
  bring_to_pause(one, Message::of(canopen::kTransmit2 + node, std::array<std::uint8_t, 8>{}),
                 [&] { one.ask({.synced = true}); });
  EXPECT_TRUE(one.motor.pauses_sync());
  one.ask({.synced = false});
  Outbox targets;
  one.motor.follow_up(targets);
  EXPECT_EQ(targets.messages().size(), 1u);
}

TEST(MotorChannel, AfterAPauseOfThisComputerOnlyADriveThatDoesNotSayWhetherItFollowsIsEnabledAnew) {
  MotorSetup knee = can::load_drives(z1()).buses[0].motors[3];
  const MitRanges ranges = as_mit(knee.drive)->ranges();
  const auto enabled_after_pause = [&](const DriveKind& kind) {
    knee.drive = kind;
    MonitoredMotor one(knee);
    one.monitor.begin();
    one.ask({});
    const MitReply on = {.node = static_cast<std::uint8_t>(knee.node), .reading = {.follows = Follows::kYes}};
    one.motor.hear(as_mit(kind)->reply(on));
    EXPECT_TRUE(one.monitor.enabled());
    one.motor.interrupt();
    return one.monitor.enabled();
  };
  EXPECT_FALSE(enabled_after_pause(std::make_shared<MitDrive>(ranges)));
  EXPECT_TRUE(enabled_after_pause(std::make_shared<DamiaoDrive>(ranges)));
}

TEST(MotorChannel, WhatNeverLeftThisComputerIsNotAskedFor) {
  const can::BusSetup bus = can::load_drives(z1()).buses[0];
  MonitoredMotor one(bus.motors[3]);
  one.monitor.begin();
  one.ask({});
  one.motor.not_asked();
  one.motor.not_asked();
  EXPECT_TRUE(one.monitor.settled());
  EXPECT_FALSE(one.monitor.enabled());
}

}  // namespace
}  // namespace pmg::drives
