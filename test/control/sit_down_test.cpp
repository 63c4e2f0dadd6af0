// The soft end of a fault: where it is allowed, when it is broken off, and that it delays no stop.
#include "control/sit_down.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "control/control_rig.hpp"
#include "control/drive_gains.hpp"

namespace pmg::control {
namespace {

using test::BreakablePolicy;
using test::ControlRig;
using test::kNan;

void overheat(ControlRig& rig) {
  rig.bus.spoil = [](model::RobotState& state) { state.temperature_degC[2] = 95.0; };
}

/// A robot that sits down since 0.3 s.
void begin_to_sit(ControlRig& rig) {
  rig.reach_walk();
  overheat(rig);
  rig.run(0.3);
  ASSERT_TRUE(sitting_down(rig.tick.result().maker));
  ASSERT_EQ(rig.mode(), Mode::kFault);
}

TEST(SitDown, EndsInTheCrouchWithinASecondAndThenDamps) {
  ControlRig rig(test::biped());
  rig.reach_walk();
  JointVector last;
  rig.after_cycle = [&] {
    if (rig.sits()) last = rig.bus.last_command.q;
  };
  overheat(rig);
  rig.run(1.0 + 0.02);
  rig.after_cycle = nullptr;
  EXPECT_TRUE(rig.bus.damping());
  const SitDown expected(test::biped(), test::clips(test::biped()), {}, {});
  ASSERT_EQ(last.size(), expected.crouch().size());
  EXPECT_LT((last - expected.crouch()).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(SitDown, NobodysStopWaitsForIt) {
  for (const Mode stop : {Mode::kDamping, Mode::kPassive}) {
    ControlRig rig(test::biped());
    begin_to_sit(rig);
    EXPECT_EQ(rig.cycles_to_damping([&] { rig.ask(Source::make("stranger", 77), stop, false); }), 0);
    rig.after_cycle = [&] { EXPECT_TRUE(rig.bus.damping()); };
    rig.run(1.0);
    EXPECT_EQ(rig.mode(), Mode::kFault);
  }
}

TEST(SitDown, AStopTogetherWithTheFaultDampsAtOnce) {
  for (int moment = 0; moment < test::kCyclesPerTick; ++moment) {
    ControlRig rig(test::biped());
    rig.reach_walk();
    rig.align(moment);
    EXPECT_EQ(rig.cycles_to_damping([&] {
      overheat(rig);
      rig.ask(Mode::kDamping);
    }),
              0);
    rig.after_cycle = [&] { EXPECT_TRUE(rig.bus.damping()); };
    rig.run(0.5);
  }
}

TEST(SitDown, IsBrokenOffWhenTheRobotIsNotSound) {
  struct Row {
    const char* what;
    std::function<void(ControlRig&)> happen;
    int most_cycles;
  };
  const std::vector<Row> rows = {
      {"bus lost", [](ControlRig& rig) { rig.bus.status = hal::BusStatus::kLost; }, 5},
      {"stale", [](ControlRig& rig) { rig.bus.status = hal::BusStatus::kStale; }, 20},
      {"not finite", [](ControlRig& rig) { rig.bus.spoil = [](auto& s) { s.q[1] = kNan; }; }, 5},
      {"tilt",
       [](ControlRig& rig) {
         rig.bus.spoil = [](auto& s) {
           s.orientation_WI = Eigen::AngleAxisd(1.1, Eigen::Vector3d::UnitX()) * s.orientation_WI;
         };
       },
       5},
      {"lifted",
       [](ControlRig& rig) {
         rig.bus.carried = {0.0, 0.0};
       },
       100},
      {"control frozen", [](ControlRig& rig) { rig.control_frozen = true; }, 26},
      {"reset",
       [](ControlRig& rig) {
         rig.bus.spoil = nullptr;
         rig.reset();
       },
       5},
  };
  for (const Row& row : rows) {
    ControlRig rig(test::biped());
    begin_to_sit(rig);
    const int cycles = rig.cycles_to_damping([&] { row.happen(rig); });
    EXPECT_GE(cycles, 0) << row.what;
    EXPECT_LE(cycles, row.most_cycles) << row.what;
  }
}

TEST(SitDown, FeetThatCarryNothingAreNotSatOn) {
  ControlRig rig(test::biped());
  rig.reach_walk();
  rig.bus.carried = {0.0, 0.0};
  rig.run(1.5);
  ASSERT_TRUE(hanging(rig.tick.result().maker));
  const ControlRig::Reaction reaction = rig.reaction_to([&] { overheat(rig); });
  EXPECT_EQ(reaction.to_sit_down, -1);
  EXPECT_LE(reaction.to_damping, 5);
}

TEST(SitDown, ARobotOnItsRampIntoStandIsNotSatOn) {
  ControlRig rig(test::biped());
  rig.ask(Mode::kStand);
  rig.run(0.3);  // the shortest ramp takes 0.5 s
  ASSERT_EQ(rig.mode(), Mode::kStand);
  const ControlRig::Reaction reaction = rig.reaction_to([&] { overheat(rig); });
  EXPECT_EQ(rig.fault(), faults::FaultCode::kTemperature);
  EXPECT_EQ(reaction.to_sit_down, -1);
  EXPECT_LE(reaction.to_damping, 5);
}

TEST(SitDown, WithoutAPolicyThatNeedsTheGroundNothingSaysThatTheFeetCarry) {
  ControlRig rig(test::biped(), false);
  rig.reach_walk();
  const ControlRig::Reaction reaction = rig.reaction_to([&] { overheat(rig); });
  EXPECT_EQ(reaction.to_sit_down, -1);
  EXPECT_LE(reaction.to_damping, 5);
}

TEST(SitDown, NoTorqueJumpsWhenTheJointsAreLowered) {
  const ClipLibrary library = test::clips(test::biped());
  const Eigen::Index n = library.q_stand.size();
  SitDown sit_down(test::biped(), library, {}, {});
  const JointVector q = library.q_stand, q_des = q + JointVector::Constant(n, 0.2), kp = JointVector::Constant(n, 80.0);
  sit_down.start(0);
  sit_down.lower_joints(q, q_des, kp, 0);
  model::JointCommand command;
  sit_down.step(0, command);
  const JointVector before = kp.cwiseProduct(q_des - q), after = command.kp.cwiseProduct(command.q - q);
  EXPECT_LT((after - before).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(SitDown, TheWayOfTheJointsIsEvenAndEndsInTheCrouch) {
  const ClipLibrary library = test::clips(test::biped());
  SitDown sit_down(test::biped(), library, {.balanced = {0.9, 0.4, 0.35}, .settle_s = 0.1}, {});
  sit_down.start(0);
  const std::int64_t begin_ns = 400'000'000;
  sit_down.lower_joints(library.q_stand, library.q_stand, sit_down.gains().kp_Nm_per_rad, begin_ns);
  const double way_rad = (sit_down.crouch() - library.q_stand).norm();
  model::JointCommand command;
  JointVector last = library.q_stand;
  for (std::int64_t now_ns = begin_ns; now_ns <= 900'000'000; now_ns += 10'000'000) {
    sit_down.step(now_ns, command);
    // 1.25 times the mean speed of the half second, and rounding.
    EXPECT_LE((command.q - last).norm(), 1.2501 * way_rad * 0.01 / 0.5);
    last = command.q;
  }
  EXPECT_LT((last - sit_down.crouch()).norm(), 1e-9);
  EXPECT_EQ(sit_down.stage(990'000'000), SitDown::Stage::kJoints);
  EXPECT_EQ(sit_down.stage(1'000'000'000), SitDown::Stage::kDamped);
}

/// Ticks in which the policy was asked, of the sit-down's first 0.3 s.
int asked_while_sitting(const std::function<void(ControlRig&)>& inject) {
  ControlRig rig(test::biped());
  rig.reach_walk();
  rig.drive.command[kVx] = 0.3;
  rig.run(1.0);
  inject(rig);
  while (!sitting_down(rig.tick.result().maker)) rig.cycle();
  const int before = rig.policy->calls;
  rig.run(0.3);
  EXPECT_TRUE(sitting_down(rig.tick.result().maker));
  return rig.policy->calls - before;
}

TEST(SitDown, ASoundPolicyBalancesTheRobotUntilTheReferenceHasStopped) { EXPECT_GE(asked_while_sitting(overheat), 29); }

/// How a robot ends whose policy fails while it is asked for this speed: the last targets before the drives damp, and
/// the bus cycles until then.
std::pair<JointVector, int> end_without_policy(double speed_m_s) {
  ControlRig rig(test::biped());
  rig.reach_walk();
  rig.drive.command[kVx] = speed_m_s;
  rig.run(1.0);
  rig.align(0);
  rig.policy->how = BreakablePolicy::Break::kNotANumber;
  JointVector last;
  int cycles = 0;
  for (; cycles < 1000 && !rig.bus.damping(); ++cycles) {
    rig.cycle();
    if (rig.sits()) last = rig.bus.last_command.q;
  }
  EXPECT_EQ(rig.fault(), faults::FaultCode::kPolicyNotFinite);
  return {last, cycles};
}

TEST(SitDown, AWalkingRobotThatNoPolicyBalancesIsLowSoonerAndFartherAhead) {
  SitDown expected(test::biped(), test::clips(test::biped()), {}, {});
  const JointVector balanced = expected.crouch();
  expected.lose_balance();
  const JointVector unbalanced = expected.crouch();
  ASSERT_GT((unbalanced - balanced).norm(), 0.01);
  const auto [stood, stood_cycles] = end_without_policy(0.0);
  const auto [walked, walked_cycles] = end_without_policy(0.3);
  EXPECT_LT((stood - balanced).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT((walked - unbalanced).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_EQ(walked_cycles, stood_cycles - 100) << "docs/reference/safety.md";
}

/// The makers of targets in a walk's last tick and of the 1.2 s from what `inject` does, each once.
std::vector<TargetMaker> makers_after(const std::function<void(ControlRig&)>& inject) {
  ControlRig rig(test::biped());
  rig.reach_walk();
  rig.drive.command[kVx] = 0.3;
  rig.run(1.0);
  std::vector<TargetMaker> makers = {rig.tick.result().maker};
  rig.after_cycle = [&] {
    if (rig.tick.result().maker != makers.back()) makers.push_back(rig.tick.result().maker);
  };
  inject(rig);
  rig.run(1.2);
  rig.after_cycle = nullptr;
  return makers;
}

TEST(SitDown, TheMakersOfTargetsFollowOneAnother) {
  using enum TargetMaker;
  EXPECT_EQ(makers_after(overheat), (std::vector{kPolicy, kLoweredByPolicy, kLoweredToTheCrouch, kNobody}));
  const auto fail = [](ControlRig& rig) { rig.policy->how = BreakablePolicy::Break::kNotANumber; };
  EXPECT_EQ(makers_after(fail), (std::vector{kPolicy, kLoweredByReference, kLoweredToTheCrouch, kNobody}));
  EXPECT_EQ(makers_after([&](ControlRig& rig) {
              overheat(rig);
              rig.run(0.2);
              fail(rig);
            }),
            (std::vector{kPolicy, kLoweredByPolicy, kLoweredByReference, kLoweredToTheCrouch, kNobody}));
}

/// Spoils every reference once it is told to.
struct GeneratorThatFails final : TickSpoiler {
  void spoil(Reference& reference) noexcept override {
    if (fails) reference.q.setConstant(kNan);
  }
  void spoil(TickResult&) noexcept override {}
  bool fails = false;
};

TEST(SitDown, AGeneratorThatFailedForGoodIsReplacedByAWayDownThatThePolicyBalances) {
  GeneratorThatFails generator;
  TickOptions options = tick_options(test::biped());
  options.spoiler = &generator;
  ControlRig rig(test::biped(), test::clips(test::biped()), options);
  rig.reach_walk();
  rig.drive.command[kVx] = 0.3;
  rig.run(1.0);
  const Reference last = rig.tick.result().reference;
  ASSERT_GT(last.gain, 0.0);
  generator.fails = true;
  while (!sitting_down(rig.tick.result().maker)) rig.cycle();
  EXPECT_EQ(rig.fault(), faults::FaultCode::kReferenceNotFinite);
  const int before = rig.policy->calls;
  rig.after_cycle = [&] { EXPECT_TRUE(rig.bus.finite()); };
  rig.run(0.3);
  EXPECT_TRUE(sitting_down(rig.tick.result().maker));
  EXPECT_GE(rig.policy->calls - before, 29);
  const Reference& now = rig.tick.result().reference;
  EXPECT_LT(now.gain, 0.5 * last.gain);
  EXPECT_LT(now.command[kHeight], -0.05);
  rig.run(0.8);
  EXPECT_TRUE(rig.bus.damping());
  generator.fails = false;
  rig.reset();
  rig.run(0.1);
  rig.ask(Mode::kStand);
  rig.run(3.0);
  EXPECT_EQ(rig.mode(), Mode::kStand);
  EXPECT_EQ(rig.tick.result().reference.command[kHeight], 0.0) << "the generator's own again";
}

TEST(SitDown, APolicyThatFailedIsNotAskedAgain) {
  for (const BreakablePolicy::Break how : {BreakablePolicy::Break::kNotANumber, BreakablePolicy::Break::kLate}) {
    EXPECT_EQ(asked_while_sitting([&](ControlRig& rig) { rig.policy->how = how; }), 0);
  }
}

TEST(SitDown, APolicyThatFailsMeanwhileLeavesTheReferenceAlone) {
  ControlRig rig(test::biped());
  rig.reach_walk();
  rig.drive.command[kVx] = 0.3;
  rig.run(1.0);
  overheat(rig);
  rig.run(0.1);
  rig.policy->how = BreakablePolicy::Break::kNotANumber;
  rig.after_cycle = [&] {
    EXPECT_TRUE(rig.bus.finite());
    EXPECT_FALSE(rig.bus.damping());
  };
  rig.run(0.5);
  EXPECT_TRUE(sitting_down(rig.tick.result().maker));
  EXPECT_EQ(rig.fault(), faults::FaultCode::kTemperature);
}

/// Phases by which each of the next ticks goes on, in ticks at the speed of the gait.
std::vector<double> phases_per_tick(ControlRig& rig, double duration_s) {
  std::vector<double> advanced;
  const double per_tick = 0.01 * rig.tick.result().reference.phase_rate_per_s;
  double last = rig.tick.result().reference.phase;
  std::int64_t last_tick = rig.control_cycle.record().tick;
  rig.after_cycle = [&] {
    const TickRecord& record = rig.control_cycle.record();
    if (record.tick == last_tick || rig.tick.result().reference.gain == 0.0) return;
    const double phase = rig.tick.result().reference.phase;
    advanced.push_back((phase - last - std::floor(phase - last)) / per_tick);
    last = phase;
    last_tick = record.tick;
  };
  rig.run(duration_s);
  rig.after_cycle = nullptr;
  return advanced;
}

// A reference that jumps by two ticks is followed by joints that jump.
TEST(SitDown, OneTickAdvancesTheMotionOnce) {
  const auto walks = [](ControlRig& rig) {
    rig.reach_walk();
    rig.drive.command[kVx] = 0.3;
    rig.run(1.0);
  };
  for (const bool sits_already : {false, true}) {
    for (const BreakablePolicy::Break how : {BreakablePolicy::Break::kNotANumber, BreakablePolicy::Break::kLate}) {
      ControlRig rig(test::biped());
      walks(rig);
      if (sits_already) {
        overheat(rig);
        rig.run(0.1);
        ASSERT_TRUE(sitting_down(rig.tick.result().maker));
      }
      rig.policy->how = how;
      const std::vector<double> advanced = phases_per_tick(rig, 0.2);
      ASSERT_GT(advanced.size(), 10U);
      EXPECT_TRUE(sitting_down(rig.tick.result().maker));
      for (const double ticks : advanced) EXPECT_NEAR(ticks, 1.0, 0.2);
    }
  }
}

TEST(SitDown, TheReferenceStopsAndGoesDown) {
  ControlRig rig(test::biped());
  rig.reach_walk();
  rig.drive.command[kVx] = 0.3;
  rig.run(1.0);
  overheat(rig);
  rig.run(0.35);
  const Command& command = rig.tick.result().reference.command;
  EXPECT_LT(std::abs(command[kVx]), 0.15);
  const double lowest_m = SitDown(test::biped(), test::clips(test::biped()), {}, {}).lowest_m();
  ASSERT_LT(lowest_m, 0.0);
  // 0.25 s with the sit-down's rate of 0.5 m/s, or all the way; a driver's own rate is slower.
  EXPECT_LE(command[kHeight], std::max(-0.5 * 0.25, lowest_m));
}

TEST(SitDown, AfterItTheDrivesDampMoreAndAfterAStopAsEver) {
  const JointVector own = own_gains(test::biped()).kd_Nm_s_per_rad;
  for (const bool stopped : {false, true}) {
    ControlRig rig(test::biped());
    begin_to_sit(rig);
    if (stopped) rig.ask(Source::make("stranger", 77), Mode::kDamping, false);
    rig.run(1.0);
    ASSERT_TRUE(rig.bus.damping());
    const double factor = stopped ? 1.0 : 3.0;  // docs/reference/safety.md
    EXPECT_LT((rig.bus.last_command.kd - factor * own).cwiseAbs().maxCoeff(), 1e-9);
    rig.bus.spoil = nullptr;
    rig.reset();
    rig.run(0.1);
    ASSERT_EQ(rig.mode(), Mode::kDamping);
    EXPECT_LT((rig.bus.last_command.kd - own).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(SitDown, RefusesOptionsThatCannotBe) {
  const ClipLibrary library = test::clips(test::biped());
  const auto make = [&](const SitDownOptions& options) { SitDown(test::biped(), library, options, {}); };
  const auto way = [](double crouch_s, double reference_s, double ahead_share) {
    return WayDown{.crouch_s = crouch_s, .reference_s = reference_s, .ahead_share = ahead_share};
  };
  EXPECT_NO_THROW(make({.balanced = way(0.0, 0.4, 0.35)})) << "every fault damps at once";
  EXPECT_THROW(make({.balanced = way(1.0, 0.4, 0.35), .settle_s = 0.1}), std::invalid_argument);
  EXPECT_THROW(make({.balanced = way(-0.1, 0.4, 0.35)}), std::invalid_argument);
  EXPECT_THROW(make({.balanced = way(0.8, 0.8, 0.35)}), std::invalid_argument);
  EXPECT_THROW(make({.balanced = way(0.95, 0.4, -1.0)}), std::invalid_argument);
  EXPECT_THROW(make({.unbalanced = way(0.75, 0.8, 0.7)}), std::invalid_argument);
  EXPECT_THROW(make({.unbalanced = way(0.96, 0.35, 0.7)}), std::invalid_argument);
  EXPECT_THROW(make({.unbalanced = way(0.75, 0.35, 1.0)}), std::invalid_argument);
  EXPECT_THROW(make({.height_rate_m_s = 0.0}), std::invalid_argument);
  EXPECT_THROW(make({.brake_factor = 0.9}), std::invalid_argument);
}

}  // namespace
}  // namespace pmg::control
