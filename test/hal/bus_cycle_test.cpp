#include "hal/bus_cycle.hpp"

#include <gtest/gtest.h>

#include "../sim/robots.hpp"

namespace pmg::hal {
namespace {

/// A bus whose answers the test scripts.
class ScriptedHal final : public Hal {
 public:
  BusStatus exchange(const model::JointCommand& command, model::RobotState& state) noexcept override {
    given = command;
    if (status == BusStatus::kOk) state.bus_sample = ++answers;
    state.age_ns = age_ns;
    return status;
  }
  BusStatus status = BusStatus::kOk;
  model::JointCommand given;
  std::uint64_t answers = 0;
  std::int64_t age_ns = 0;
};

struct OneBus {
  void cycle() {
    clock.advance_to(clock.now_ns() + BusCycle::kPeriod_ns);
    bus.run();
  }
  BusSample sample() {
    BusSample sample;
    EXPECT_TRUE(link.samples.take(sample)) << "one in every cycle";
    return sample;
  }
  ScriptedHal hal;
  BusLink link;
  io::SimulationClock clock;
  BusCycle bus{hal, link, z1(), clock};
};

TEST(BusCycle, AStateKeepsItsStampUntilTheDrivesAnswerAgain) {
  OneBus one;
  one.cycle();
  EXPECT_EQ(one.sample().state.stamp_ns, 2'000'000);
  for (const BusStatus silent : {BusStatus::kStale, BusStatus::kLost}) {
    one.hal.status = silent;
    one.cycle();
    const BusSample sample = one.sample();
    EXPECT_EQ(sample.status, silent);
    EXPECT_EQ(sample.state.stamp_ns, 2'000'000);
    EXPECT_EQ(sample.state.bus_sample, 1u);
  }
  one.hal.status = BusStatus::kOk;
  one.cycle();
  EXPECT_EQ(one.sample().state.stamp_ns, 8'000'000);
}

TEST(BusCycle, AStampIsThatOfTheOldestMotorsPartOfTheState) {
  OneBus one;
  one.hal.age_ns = 1'500'000;
  one.cycle();
  EXPECT_EQ(one.sample().state.stamp_ns, 500'000);
}

TEST(BusCycle, TheDrivesGetTheNewestCommandInTheNextCycle) {
  OneBus one;
  one.cycle();
  EXPECT_EQ(one.hal.given.kp.sum(), 0.0);
  ControlOutput output;
  output.joints = standing_command(z1());
  output.joints.bus_sample = 1;
  one.link.commands.put(output);
  output.joints.bus_sample = 2;
  one.link.commands.put(output);
  one.cycle();
  EXPECT_EQ(one.hal.given.bus_sample, 2u);
  EXPECT_GT(one.hal.given.kp.sum(), 0.0);
  one.link.stop.pull();
  one.cycle();
  EXPECT_EQ(one.hal.given.kp.sum(), 0.0);
  EXPECT_GT(one.hal.given.kd.minCoeff(), 0.0);
}

TEST(BusCycle, TellsTheControlThreadWhatTheGuardDid) {
  OneBus one;
  ControlOutput output;
  output.joints = standing_command(z1());
  one.link.commands.put(output);
  for (int k = 0; k < 27; ++k) one.cycle();
  const BusSample sample = one.sample();
  EXPECT_EQ(sample.trips, 1u);
  EXPECT_EQ(sample.trip_cause, TripCause::kControlFrozen);
}

}  // namespace
}  // namespace pmg::hal
