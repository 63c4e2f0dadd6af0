// The soft end of a fault: where it is allowed, when it is broken off, and that it delays no stop.
#include "control/sit_down.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "control/control_rig.hpp"

namespace pmg::control {
namespace {

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
  ASSERT_TRUE(rig.tick.result().sitting);
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
  const SitDown expected(test::biped(), test::clips(test::biped()), {});
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
  ASSERT_TRUE(rig.tick.result().hanging);
  const ControlRig::Reaction reaction = rig.reaction_to([&] { overheat(rig); });
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

TEST(SitDown, NoTorqueJumpsWhenItBegins) {
  const ClipLibrary library = test::clips(test::biped());
  const Eigen::Index n = library.q_stand.size();
  SitDown sit_down(test::biped(), library, {});
  const JointVector q = library.q_stand, q_des = q + JointVector::Constant(n, 0.2), kp = JointVector::Constant(n, 80.0);
  sit_down.start(q, q_des, kp, 0);
  model::JointCommand command;
  sit_down.step(1e-6, command);
  const JointVector before = kp.cwiseProduct(q_des - q), after = command.kp.cwiseProduct(command.q - q);
  EXPECT_LT((after - before).cwiseAbs().maxCoeff(), 0.01);
}

TEST(SitDown, RefusesTimesThatAreTooLong) {
  const ClipLibrary library = test::clips(test::biped());
  EXPECT_THROW(SitDown(test::biped(), library, {.duration_s = 1.0, .settle_s = 0.1}), std::invalid_argument);
  EXPECT_THROW(SitDown(test::biped(), library, {.duration_s = -0.1}), std::invalid_argument);
}

}  // namespace
}  // namespace pmg::control
