// Holding, stopping and braking besides the table of faults: frozen threads, stops from other sources, silent
// operators, late policies, through bus cycle, guard, control cycle and tick.
#include <gtest/gtest.h>

#include <limits>

#include "control/control_rig.hpp"
#include "generator_core/allocation_count.hpp"

namespace pmg::control {
namespace {

using test::BreakablePolicy;
using test::ControlRig;
using test::kCyclesPerTick;
using test::kNan;

constexpr double kCycle_s = 0.002;

/// Makes the policy take 12 ms for this many ticks.
void block_policy(ControlRig& rig, int ticks) {
  rig.policy->meanwhile = [&rig, left = ticks]() mutable {
    for (int cycle = 0; cycle < 6 && left > 0; ++cycle) rig.world();
    --left;
  };
}

TEST(Degradation, AFrozenBusFindsADampingCommandWhenItReturns) {
  for (int moment = 0; moment < kCyclesPerTick; ++moment) {
    ControlRig rig(test::biped());
    rig.reach_walk();
    rig.align(moment);
    rig.bus_frozen = true;
    rig.run(0.1);
    rig.bus_frozen = false;
    rig.cycle();
    EXPECT_TRUE(rig.bus.damping());
    EXPECT_EQ(rig.fault(), faults::FaultCode::kStaleState);
  }
}

/// Lengths of a stall of the host: half a tick up to what no robot stands.
constexpr double kStalls_s[] = {0.005, 0.05, 0.25, 1.0, 10.0};

/// Both threads sleep for so long; the control thread wakes before the bus and runs whatever its schedule makes due.
void stall_host(ControlRig& rig, double stall_s, int delay_us) {
  rig.clock.advance_to(rig.clock.now_ns() + io::nanoseconds(stall_s) + delay_us * 1000);
  for (int wake = 0; wake < 3; ++wake) {
    rig.wake_control();
    rig.clock.advance_to(rig.clock.now_ns() + 70'000);  // how long a tick takes
  }
}

TEST(Degradation, AHostThatStopsEverythingForAWhileIsNoFault) {
  for (const Mode mode : {Mode::kStand, Mode::kWalk}) {
    for (const double stall_s : kStalls_s) {
      for (int moment = 0; moment < 10; ++moment) {
        SCOPED_TRACE(testing::Message() << to_string(mode) << ", stall of " << stall_s << " s, moment " << moment);
        ControlRig rig(test::biped());
        rig.reach_walk();
        rig.ask(mode);
        rig.run(1.0);
        rig.align(moment % kCyclesPerTick);
        stall_host(rig, stall_s, 977 * moment);
        rig.run(0.5);
        EXPECT_EQ(rig.mode(), mode);
      }
    }
  }
}

TEST(Degradation, AfterAStallNoTwoTicksSeeOneOldSample) {
  for (const double stall_s : kStalls_s) {
    for (int moment = 0; moment < 10; ++moment) {
      ControlRig rig(test::biped());
      rig.reach_walk();
      rig.align(moment % kCyclesPerTick);
      std::int64_t last_sample_ns = 0, last_tick = -1;
      int repeated = 0;
      const auto look = [&] {
        const TickRecord& record = rig.control_cycle.record();
        if (record.tick == last_tick) return;
        const bool old = record.now_ns - record.state.stamp_ns > hal::BusCycle::kPeriod_ns;
        repeated += old && record.state.stamp_ns == last_sample_ns ? 1 : 0;
        last_sample_ns = record.state.stamp_ns;
        last_tick = record.tick;
      };
      rig.policy->meanwhile = look;  // within a tick: the record of the one before
      stall_host(rig, stall_s, 977 * moment);
      rig.run(0.1);
      EXPECT_EQ(repeated, 0) << "stall of " << stall_s << " s, moment " << moment;
    }
  }
}

TEST(Degradation, AControlThreadThatStallsAloneIsDampedFromThePagesLengthOn) {
  // docs/reference/safety.md: up to 40 ms nothing happens; from 52 ms on the guard damps.
  for (int cycles = 1; cycles <= 35; ++cycles) {
    for (int moment = 0; moment < kCyclesPerTick; ++moment) {
      ControlRig rig(test::biped());
      rig.reach_walk();
      rig.align(moment);
      for (int cycle = 0; cycle < cycles; ++cycle) rig.world();
      rig.run(0.1);
      SCOPED_TRACE(testing::Message() << cycles << " cycles from moment " << moment);
      if (cycles <= 20) {
        EXPECT_EQ(rig.mode(), Mode::kWalk);
      }
      if (cycles >= 26) {
        EXPECT_EQ(rig.fault(), faults::FaultCode::kControlFrozen);
      }
    }
  }
}

TEST(Degradation, ABusThreadThatStallsAloneIsAFaultFromThePagesLengthOn) {
  // docs/reference/safety.md: up to 20 ms nothing happens; from 40 ms on the first command afterwards is damping.
  for (int cycles = 1; cycles <= 30; ++cycles) {
    for (int moment = 0; moment < kCyclesPerTick; ++moment) {
      ControlRig rig(test::biped());
      rig.reach_walk();
      rig.align(moment);
      rig.bus_frozen = true;
      for (int cycle = 0; cycle < cycles; ++cycle) rig.cycle();
      rig.bus_frozen = false;
      rig.cycle();
      SCOPED_TRACE(testing::Message() << cycles << " cycles from moment " << moment);
      if (cycles <= 10) {
        EXPECT_EQ(rig.mode(), Mode::kWalk);
      }
      if (cycles >= 20) {
        EXPECT_EQ(rig.fault(), faults::FaultCode::kStaleState);
      }
      if (cycles >= 20) {
        EXPECT_TRUE(rig.bus.damping());
      }
    }
  }
}

TEST(Degradation, AGlitchThatTwoTicksSeeIsStillOneGlitch) {
  for (int moment = 0; moment < kCyclesPerTick; ++moment) {
    ControlRig rig(test::biped());
    rig.reach_walk();
    rig.align(moment);
    rig.bus.spoil = [](auto& state) { state.dq[3] = 1.6 * test::biped().joints[3].velocity_limit_rad_s; };
    rig.run(kCycle_s);
    rig.bus_frozen = true;  // for three ticks, all of which see this sample
    rig.run(8 * kCycle_s);
    rig.control_cycle.run(rig.clock.now_ns());
    rig.bus_frozen = false;
    rig.bus.spoil = nullptr;
    rig.run(0.1);
    EXPECT_EQ(rig.mode(), Mode::kWalk) << moment;
  }
}

TEST(Degradation, AStrangersStopBrakesInTheNextBusCycle) {
  for (const Mode stop : {Mode::kDamping, Mode::kPassive}) {
    for (int moment = 0; moment < kCyclesPerTick; ++moment) {
      ControlRig rig(test::biped());
      rig.reach_walk();
      rig.drive.command[kVx] = 0.3;
      rig.run(1.0);
      rig.align(moment);
      EXPECT_EQ(rig.cycles_to_damping([&] { rig.ask(Source::make("stranger", 77), stop, false); }), 0);
      rig.after_cycle = [&] { EXPECT_TRUE(rig.bus.damping()); };
      rig.run(0.2);
      EXPECT_EQ(rig.mode(), Mode::kDamping);
    }
  }
}

TEST(Degradation, AStopBrakesEvenWhenNobodyReadsIt) {
  ControlRig rig(test::biped());
  rig.reach_walk();
  rig.control_frozen = true;
  for (int k = 0; k < 100; ++k) rig.ask(Mode::kStand);  // a flood that fills the queue
  EXPECT_EQ(rig.cycles_to_damping([&] { rig.ask(Mode::kDamping); }), 0);
  rig.control_frozen = false;
  rig.run(0.2);
  EXPECT_EQ(rig.mode(), Mode::kDamping);
}

TEST(Degradation, AStopThatIsRepeatedUntilItIsAcknowledgedMakesNoRobotLimp) {
  ControlRig rig(test::biped());
  rig.reach_walk();
  for (int k = 0; k < 20; ++k) {
    rig.inbox.put(ModeRequest{.source = Source::make("stop", 1),
                              .sequence = 5,
                              .stamp_ns = rig.clock.now_ns(),
                              .received_ns = rig.clock.now_ns(),
                              .mode = Mode::kPassive});
    rig.run(0.02);
    EXPECT_EQ(rig.mode(), Mode::kDamping) << "limp only when told twice, and a repetition is no second time";
  }
  rig.ask(Mode::kPassive);
  rig.run(0.02);
  EXPECT_EQ(rig.mode(), Mode::kPassive);
}

TEST(Degradation, AKilledCommandSourceEndsInStandWithinItsTime) {
  ControlRig rig(test::biped());
  rig.reach_walk();
  rig.drive.command[kVx] = 0.4;
  rig.run(3.0);
  ASSERT_GT(rig.tick.result().reference.gain, 0.5);
  rig.silent = true;
  rig.run(0.2);
  EXPECT_EQ(rig.mode(), Mode::kWalk);
  // Half a second to stop, and two ticks: one notices, one changes the mode.
  rig.run(0.52);
  EXPECT_EQ(rig.mode(), Mode::kStand);
  EXPECT_NEAR(rig.tick.result().reference.gain, 0.0, 1e-9);
  EXPECT_FALSE(rig.bus.damping()) << "it stands";
  rig.silent = false;
  rig.run(0.5);
  EXPECT_EQ(rig.mode(), Mode::kStand) << "and walks only when asked again";
  rig.ask(Mode::kWalk);
  rig.run(0.1);
  EXPECT_EQ(rig.mode(), Mode::kWalk);
}

TEST(Degradation, AnOperatorsNanIsIgnoredAndCounted) {
  ControlRig rig(test::biped());
  rig.reach_walk();
  rig.drive.command[kVx] = 0.2;
  rig.run(0.1);
  Command good = rig.tick.result().user;
  rig.drive.command[kPitch] = kNan;
  rig.after_cycle = [&] { EXPECT_TRUE(rig.bus.finite()); };
  rig.run(0.1);
  EXPECT_EQ(rig.tick.result().ignored.not_finite, 10);
  EXPECT_EQ(rig.tick.result().user, good);
  EXPECT_EQ(rig.mode(), Mode::kWalk);
  rig.run(1.0);
  EXPECT_EQ(rig.mode(), Mode::kStand) << "nonsense is no sign of life";
}

TEST(Degradation, ASingleLateTickIsCountedAndNoFault) {
  ControlRig rig(test::biped());
  rig.reach_walk();
  for (int k = 0; k < 10; ++k) {
    block_policy(rig, 2);
    rig.run(0.1);
  }
  EXPECT_EQ(rig.mode(), Mode::kWalk);
  EXPECT_EQ(rig.tick.result().late_ticks, 20);
}

TEST(Degradation, APolicyThatBlocksIsNamedAndNotTheOverrunThatItCauses) {
  ControlRig rig(test::biped());
  rig.reach_walk();
  ASSERT_GE(rig.cycles_to_damping([&] { block_policy(rig, 100); }), 0);
  EXPECT_EQ(rig.fault(), faults::FaultCode::kStalePolicy);
}

TEST(Degradation, ALatePolicysLastTargetIsHeldFirst) {
  ControlRig rig(test::biped());
  rig.reach_walk();
  rig.drive.command[kVx] = 0.3;
  for (int episode = 0; episode < 3; ++episode) {
    rig.run(0.5);
    rig.align(0);
    rig.run(kCycle_s);
    const JointVector held = rig.bus.last_command.q;
    rig.policy->how = BreakablePolicy::Break::kLate;
    for (int tick = 0; tick < 2; ++tick) {
      rig.run(kCyclesPerTick * kCycle_s);
      EXPECT_TRUE(rig.tick.result().policy_held);
      EXPECT_EQ(rig.bus.last_command.q, held);
      EXPECT_EQ(rig.mode(), Mode::kWalk);
    }
    rig.policy->how = BreakablePolicy::Break::kNone;
  }
  rig.run(1.0);
  EXPECT_FALSE(rig.tick.result().policy_held);
  EXPECT_EQ(rig.mode(), Mode::kWalk);
}

TEST(Degradation, NoCycleOfEitherThreadUsesTheHeap) {
  if (test::allocation_count() < 0) GTEST_SKIP() << "allocations can't be counted in this build";
  ControlRig rig(test::biped());
  rig.drive.command = Command{{0.2, 0.1, 0.1, 0.1, 0.05, -0.02}};
  const auto run = [&](double duration_s) { rig.run(duration_s); };
  const long before = test::allocation_count();
  rig.ask(Mode::kWalk);
  run(3.0);
  rig.ask(Mode::kStand);
  run(1.0);
  rig.ask(Source::make("stranger", 1), Mode::kDamping, false);
  run(0.1);
  rig.ask(Mode::kWalk);
  run(1.0);
  rig.policy->how = BreakablePolicy::Break::kNotANumber;
  run(0.1);
  rig.policy->how = BreakablePolicy::Break::kNone;
  rig.reset();
  run(0.1);
  rig.bus.status = hal::BusStatus::kStale;
  run(0.1);
  rig.control_frozen = true;
  run(0.1);
  EXPECT_EQ(test::allocation_count(), before);
  rig.control_frozen = false;
  rig.bus.status = hal::BusStatus::kOk;
  run(0.1);
  rig.reset();
  rig.ask(Mode::kWalk);
  rig.policy->how = BreakablePolicy::Break::kHeap;
  run(1.0);
  rig.ask(Mode::kWalk);
  run(1.0);
  EXPECT_GT(test::allocation_count(), before + 50) << "the count must see one that does";
}

}  // namespace
}  // namespace pmg::control
