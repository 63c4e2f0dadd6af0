// The promises of one tick.
#include "control/tick.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <utility>

#include "control/drive_gains.hpp"
#include "control/fixtures.hpp"
#include "generator_core/allocation_count.hpp"

namespace pmg::control {
namespace {

using test::kTick_s;

TEST(Tick, BeforeAnyRequestTheDrivesGiveNoTorque) {
  test::DrivenTick driven(test::z1());
  const TickResult& result = driven.step(false);
  EXPECT_EQ(result.mode, Mode::kPassive);
  EXPECT_EQ(result.command.kp.sum(), 0.0);
  EXPECT_EQ(result.command.kd.sum(), 0.0);
  EXPECT_EQ(result.command.tau_ff.sum(), 0.0);
}

TEST(Tick, DampingBrakesWithoutPosition) {
  test::DrivenTick driven(test::z1());
  driven.request.mode = Mode::kDamping;
  const TickResult& result = driven.run(0.05);
  EXPECT_EQ(result.mode, Mode::kDamping);
  EXPECT_EQ(result.command.kp.sum(), 0.0);
  EXPECT_EQ(result.command.kd, own_gains(test::z1()).kd_Nm_s_per_rad);
}

TEST(Tick, StandIsEnteredFromTheMeasuredPostureWithoutAJump) {
  test::DrivenTick driven(test::z1());
  std::mt19937_64 random(3);
  for (Eigen::Index i = 0; i < driven.state.q.size(); ++i) {
    driven.state.q[i] += 0.3 * (static_cast<double>(random() >> 11) * 0x1p-53 - 0.5);
  }
  const model::RobotModel& robot = test::z1();
  driven.state.q = driven.state.q.cwiseMax(robot.q_lower()).cwiseMin(robot.q_upper());
  driven.request.mode = Mode::kStand;
  JointVector previous = driven.state.q;
  for (int k = 0; k < 300; ++k) {
    const TickResult& result = driven.step();
    if (result.mode != Mode::kStand) continue;
    // 0.5 rad/s on average, 1.5 times that in the middle of the smooth step.
    ASSERT_LE((result.command.q - previous).cwiseAbs().maxCoeff(), 0.75 * kTick_s + 1e-9) << "tick " << k;
    previous = result.command.q;
  }
  EXPECT_EQ(driven.tick.result().mode, Mode::kStand);
  EXPECT_LT((previous - robot.q_stand()).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Tick, StandIgnoresCommandsAndWalkFollowsAllSix) {
  test::DrivenTick driven(test::z1());
  driven.drive.command = Command{{0.4, 0.1, 0.2, 0.1, 0.05, -0.04}};
  driven.request.mode = Mode::kStand;
  driven.run(2.0);
  EXPECT_EQ(driven.tick.result().user, Command{});
  EXPECT_LT((driven.tick.result().command.q - test::z1().q_stand()).cwiseAbs().maxCoeff(), 1e-9);
  driven.request.mode = Mode::kWalk;
  const TickResult& result = driven.run(3.0);
  EXPECT_EQ(result.mode, Mode::kWalk);
  EXPECT_EQ(result.user, driven.drive.command);
  for (std::size_t i = 0; i < kChannels; ++i) {
    EXPECT_GT(result.reference.command.u[i] * driven.drive.command.u[i], 0.0) << kChannelNames[i];
  }
  EXPECT_GT(result.reference.phase_rate_per_s, 0.0);
  EXPECT_EQ(result.command.kp, own_gains(test::z1()).kp_Nm_per_rad) << "of a policy without gains of its own";
  EXPECT_EQ(result.command.kd, own_gains(test::z1()).kd_Nm_s_per_rad);
  EXPECT_EQ(result.command.dq.cwiseAbs().maxCoeff(), 0.0) << "the drives' own damping only";
  for (const Channel channel : {kVx, kVy, kOmega}) driven.drive.command[channel] = 0.0;
  driven.run(3.0);
  EXPECT_EQ(result.mode, Mode::kWalk);
  EXPECT_NEAR(result.reference.gain, 0.0, 1e-9) << "zero velocity means standing";
  EXPECT_EQ(result.reference.phase_rate_per_s, 0.0);
  for (const Channel channel : {kPitch, kRoll, kHeight}) {
    EXPECT_GT(result.reference.command[channel] * driven.drive.command[channel], 0.0) << "with a posture";
  }
}

TEST(Tick, ASilentOperatorBringsTheRobotToAStandstillWithinItsTime) {
  test::DrivenTick driven(test::z1());
  driven.drive.command[kVx] = 0.8;
  driven.request.mode = Mode::kWalk;
  driven.run(4.0);
  ASSERT_GT(driven.tick.result().reference.gain, 0.9);
  driven.run(0.2, false);
  EXPECT_EQ(driven.tick.result().mode, Mode::kWalk);
  // 0.2 s until it is stale, 0.5 s to stop, and two ticks: one notices, one changes the mode.
  driven.run(0.52, false);
  EXPECT_EQ(driven.tick.result().mode, Mode::kStand);
  EXPECT_NEAR(driven.tick.result().reference.gain, 0.0, 1e-9);
}

TEST(Tick, DampingComesInTheTickThatAsksForItEvenFromAStranger) {
  test::DrivenTick driven(test::z1());
  driven.drive.command[kVx] = 0.8;
  driven.request.mode = Mode::kWalk;
  driven.run(3.0);
  ASSERT_EQ(driven.tick.result().mode, Mode::kWalk);
  driven.request.source = Source::make("bystander", 9);
  driven.request.mode = Mode::kDamping;
  const TickResult& result = driven.step();
  EXPECT_EQ(result.mode, Mode::kDamping);
  EXPECT_EQ(result.command.kp.sum(), 0.0);
  EXPECT_GT(result.command.kd.minCoeff(), 0.0);
  ASSERT_EQ(result.ack_count, 1u) << "and it is acknowledged";
  EXPECT_EQ(result.acks[0].source, Source::make("bystander", 9));
  EXPECT_EQ(result.acks[0].mode, Mode::kDamping);
}

TEST(Tick, AStopIsCarriedOutHoweverOldItIs) {
  test::DrivenTick driven(test::z1());
  driven.request.mode = Mode::kWalk;
  driven.run(2.0);
  ASSERT_EQ(driven.tick.result().mode, Mode::kWalk);
  driven.request.mode = Mode::kDamping;
  driven.request.sequence = -1000;  // older than all earlier requests
  const TickResult& result = driven.step();
  EXPECT_EQ(result.acks[0].verdict, Verdict::kTaken);
  EXPECT_EQ(result.mode, Mode::kDamping);
}

TEST(Tick, ATorsoThatIsFoundBentMayRiseIntoStand) {
  const model::RobotModel& robot = test::z1();
  test::DrivenTick driven(robot);
  driven.state.q[robot.joint_index.at("waist_pitch")] += 0.45;
  driven.state.orientation_WI = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY()) * driven.state.orientation_WI;
  driven.request.mode = Mode::kStand;
  driven.run(3.0);
  EXPECT_EQ(driven.tick.result().mode, Mode::kStand) << faults::describe(driven.tick.result().fault, robot);
  driven.state.orientation_WI = Eigen::AngleAxisd(0.35, Eigen::Vector3d::UnitY()) * driven.state.orientation_WI;
  driven.run(0.05);
  EXPECT_EQ(driven.tick.result().fault.code, faults::FaultCode::kTorsoAttitude) << "once it stands it must stay there";
}

TEST(Tick, APolicyThatIsNotFiniteNeverReachesTheDrives) {
  for (const auto how : {test::BreakablePolicy::Break::kNotANumber, test::BreakablePolicy::Break::kStatus}) {
    test::DrivenTick driven(test::z1());
    driven.request.mode = Mode::kWalk;
    driven.run(2.0);
    driven.policy->how = how;
    const TickResult& result = driven.step();
    EXPECT_EQ(result.mode, Mode::kFault);
    EXPECT_EQ(result.fault.code, faults::FaultCode::kPolicyNotFinite);
    EXPECT_TRUE(sitting_down(result.maker)) << "in the very tick that failed";
    EXPECT_TRUE(result.command.q.allFinite());
    EXPECT_LT((result.command.q - driven.state.q).cwiseAbs().maxCoeff(), 0.05) << "it goes on from where it is";
  }
}

TEST(Tick, ABrokenStateGivesAFiniteDampingCommand) {
  test::DrivenTick driven(test::z1());
  driven.request.mode = Mode::kWalk;
  driven.run(2.0);
  driven.state.q.setConstant(std::numeric_limits<double>::quiet_NaN());
  const TickResult& result = driven.step();
  EXPECT_EQ(result.mode, Mode::kFault);
  EXPECT_TRUE(result.command.q.allFinite());
  EXPECT_EQ(result.command.kp.sum(), 0.0);
  EXPECT_GT(result.command.kd.minCoeff(), 0.0);
}

TEST(Tick, CommandsSayWhichSampleTheyWereComputedFrom) {
  test::DrivenTick driven(test::z1());
  driven.step();
  EXPECT_EQ(driven.tick.result().command.bus_sample, driven.state.bus_sample);
}

TEST(Tick, APolicyBringsItsOwnGainsButBrakesWithTheRobots) {
  const model::RobotModel& robot = test::z1();
  const Eigen::Index n = robot.joint_index.size();
  auto policy = std::make_unique<test::BreakablePolicy>();
  policy->own_gains = policy::DriveGains{JointVector::Constant(n, 90.0), JointVector::Constant(n, 2.5)};
  test::DrivenTick driven(robot, std::move(policy));
  driven.request.mode = Mode::kStand;
  const TickResult& result = driven.run(1.0);
  EXPECT_EQ(result.command.kp, JointVector::Constant(n, 90.0));
  EXPECT_EQ(result.command.kd, JointVector::Constant(n, 2.5));
  driven.request.mode = Mode::kDamping;
  driven.step();
  EXPECT_EQ(result.command.kd[0], robot.joints[0].kd_Nm_s_per_rad);
}

TEST(Tick, TorqueIsLimitedWithTheGainsInForce) {
  const model::RobotModel& robot = test::z1();
  const Eigen::Index n = robot.joint_index.size();
  const int knee = robot.joint_index.at("left_knee");
  const double effort_Nm = robot.joints[static_cast<std::size_t>(knee)].effort_limit_Nm;
  auto policy = std::make_unique<test::BreakablePolicy>();
  policy->own_gains = policy::DriveGains{JointVector::Constant(n, 2000.0), JointVector::Constant(n, 1.0)};
  test::DrivenTick driven(robot, std::move(policy));
  driven.request.mode = Mode::kStand;
  driven.run(1.5);
  driven.state.q[knee] += 0.5;
  const double held_rad = driven.state.q[knee];
  const TickResult& result = driven.step();
  ASSERT_EQ(result.mode, Mode::kStand);
  EXPECT_LE(std::abs(2000.0 * (result.command.q[knee] - held_rad)), effort_Nm + 1e-6);
  EXPECT_GT(result.limited.torque, 0);
}

TEST(Tick, RefusesGainsThatDoNotFitTheRobot) {
  const model::RobotModel& robot = test::z1();
  const Eigen::Index n = robot.joint_index.size();
  const auto expect_refusal = [&](Eigen::Index kp_count, double kp, double kd) {
    auto policy = std::make_unique<test::BreakablePolicy>();
    policy->own_gains = policy::DriveGains{JointVector::Constant(kp_count, kp), JointVector::Constant(n, kd)};
    EXPECT_THROW(test::DrivenTick(robot, std::move(policy)), std::invalid_argument)
        << kp_count << " " << kp << " " << kd;
  };
  expect_refusal(n - 1, 90.0, 0.0);
  expect_refusal(n, -1.0, 0.0);
  expect_refusal(n, 90.0, 101.0);
  expect_refusal(n, std::nan(""), 0.0);
  expect_refusal(n, 90.0, 0.0);  // undamped
}

TEST(Tick, GainsAreCheckedAgainstTheGuardInForce) {
  const model::RobotModel& robot = test::z1();
  const Eigen::Index n = robot.joint_index.size();
  const auto make = [&](double kp, double max_kp) {
    auto policy = std::make_unique<test::BreakablePolicy>();
    policy->own_gains = policy::DriveGains{JointVector::Constant(n, kp), JointVector::Constant(n, 2.0)};
    TickOptions options = tick_options(robot);
    options.guard.max_kp_Nm_per_rad = max_kp;
    io::SimulationClock clock;
    return Tick(robot, test::clips(robot), std::move(policy), clock, options).guard().max_kp_Nm_per_rad;
  };
  EXPECT_EQ(make(90.0, 100.0), 100.0);
  EXPECT_THROW(make(90.0, 80.0), std::invalid_argument) << "that guard would clamp them in silence";
  EXPECT_EQ(make(2500.0, 3000.0), 3000.0) << "drives that take more than the default";
  TickOptions weak = tick_options(robot);
  weak.guard.max_kp_Nm_per_rad = 1.0;
  const io::SimulationClock clock;
  EXPECT_THROW(Tick(robot, test::clips(robot), std::make_unique<policy::ReferencePolicy>(), clock, weak),
               std::invalid_argument)
      << "robot.yaml's gains";
}

TEST(Tick, APolicyForgetsItsHistoryOnEveryEntryIntoStand) {
  test::DrivenTick driven(test::z1());
  driven.request.mode = Mode::kWalk;
  driven.run(1.0);
  EXPECT_EQ(driven.policy->resets, 1);
  driven.request.mode = Mode::kStand;
  driven.run(1.0);
  EXPECT_EQ(driven.policy->resets, 1) << "from Walk it goes on";
  driven.request.mode = Mode::kDamping;
  driven.run(0.1);
  driven.request.mode = Mode::kStand;
  driven.run(0.1);
  EXPECT_EQ(driven.policy->resets, 2);
}

TEST(Tick, APolicyIsNotRunInTheAirAndWalkingAgainNeedsANewRequest) {
  test::DrivenTick driven(test::z1());
  driven.drive.command[kVx] = 0.5;
  driven.request.mode = Mode::kWalk;
  driven.run(4.0);
  ASSERT_EQ(driven.tick.result().mode, Mode::kWalk);
  ASSERT_FALSE(hanging(driven.tick.result().maker));
  driven.asking = false;  // one request is enough to walk on
  driven.carried = {0.0, 0.0};
  const int resets = driven.policy->resets;
  for (int k = 0; k < 20 && !hanging(driven.tick.result().maker); ++k) driven.step();
  ASSERT_TRUE(hanging(driven.tick.result().maker));
  EXPECT_EQ(driven.tick.result().mode, Mode::kStand) << "nobody steps in the air";
  EXPECT_EQ(driven.tick.result().reference.gain, 0.0);
  const int calls = driven.policy->calls;
  driven.run(0.6);
  EXPECT_EQ(driven.tick.result().mode, Mode::kStand);
  EXPECT_NEAR(driven.tick.result().reference.gain, 0.0, 1e-9);
  EXPECT_EQ(driven.policy->calls, calls) << "not once";
  driven.asking = true;
  driven.run(0.3);
  EXPECT_EQ(driven.tick.result().mode, Mode::kStand) << "nobody walks in the air";
  driven.asking = false;
  driven.carried = {0.5, 0.5};
  driven.run(1.0);
  EXPECT_FALSE(hanging(driven.tick.result().maker));
  EXPECT_EQ(driven.tick.result().mode, Mode::kStand) << "what was refused in the air is forgotten";
  EXPECT_GT(driven.policy->calls, calls);
  EXPECT_GT(driven.policy->resets, resets) << "it knows nothing of what it last did";
  driven.asking = true;
  driven.run(0.1);
  EXPECT_EQ(driven.tick.result().mode, Mode::kWalk);
}

TEST(Tick, LegsThatAreStillBroughtToRestAreNotTakenForFeetThatCarry) {
  test::DrivenTick driven(test::z1());
  driven.request.mode = Mode::kStand;
  driven.run(2.0);
  driven.carried = {0.0, 0.0};
  for (int k = 0; k < 20 && !hanging(driven.tick.result().maker); ++k) driven.step();
  ASSERT_TRUE(hanging(driven.tick.result().maker));
  driven.carried = {0.5, 0.5};
  driven.run(0.15);
  EXPECT_TRUE(hanging(driven.tick.result().maker)) << "the change-over takes 0.2 s at least";
  driven.run(0.45);
  EXPECT_FALSE(hanging(driven.tick.result().maker));
}

TEST(Tick, BeforeTheFeetAreJudgedTheReferenceDrivesAndNobodySaysThatTheRobotHangs) {
  test::DrivenTick driven(test::z1());
  driven.request.mode = Mode::kStand;
  int unknown_ticks = 0;
  for (int k = 0; k < 100; ++k) {
    driven.step();
    const TickResult& result = driven.tick.result();
    EXPECT_FALSE(hanging(result.maker)) << k;
    if (result.maker != TargetMaker::kReferenceUnjudged) continue;
    ++unknown_ticks;
    EXPECT_EQ(driven.policy->calls, 0) << k;
  }
  EXPECT_GE(unknown_ticks, 5);
  EXPECT_LE(unknown_ticks, 10) << "0.05 s and the filter";
  EXPECT_GT(driven.policy->calls, 0);
}

TEST(Tick, APolicyRunsUnsentForHalfASecondBeforeItGetsTheDrives) {
  test::DrivenTick driven(test::z1());
  driven.request.mode = Mode::kStand;
  while (driven.policy->calls == 0 && driven.now_ns < 3'000'000'000) driven.step();
  EXPECT_EQ(driven.policy->unsent_calls, 49) << "the fiftieth is sent";
  EXPECT_EQ(driven.policy->resets, 1) << "what it saw meanwhile is its history";

  driven.carried = {0.0, 0.0};
  driven.run(2.0);
  ASSERT_TRUE(hanging(driven.tick.result().maker));
  driven.carried = {0.5, 0.5};
  int ticks = 0;
  for (; policy_waits(driven.tick.result().maker) && ticks < 100; ++ticks) driven.step();
  EXPECT_LE(ticks, 10) << "it ran unsent while it hung: nothing delays it on the ground";

  driven.request.mode = Mode::kDamping;
  driven.run(0.1);
  driven.request.mode = Mode::kStand;
  const int calls = driven.policy->calls, unsent = driven.policy->unsent_calls;
  while (driven.policy->calls == calls && driven.now_ns < 10'000'000'000) driven.step();
  EXPECT_EQ(driven.policy->unsent_calls - unsent, 49) << "every time that Stand begins";
}

TEST(Tick, ARequestForWalkWaitsUntilThePolicyIsKnown) {
  test::DrivenTick driven(test::z1());
  driven.request.mode = Mode::kStand;
  driven.run(0.1);
  driven.request.mode = Mode::kWalk;
  driven.step();
  driven.asking = false;                                     // once
  driven.policy->how = test::BreakablePolicy::Break::kLate;  // what gives no result makes nobody known
  driven.run(0.7);
  ASSERT_EQ(driven.tick.result().mode, Mode::kStand);
  ASSERT_FALSE(driven.tick.result().entering) << "the ramp is over";
  ASSERT_TRUE(policy_waits(driven.tick.result().maker));
  driven.policy->how = test::BreakablePolicy::Break::kNone;
  driven.run(1.0);
  EXPECT_EQ(driven.tick.result().mode, Mode::kWalk);
}

TEST(Tick, APolicyWhoseFirstStepIsFarIsRefusedWithItsJointBeforeAnythingMoves) {
  const model::RobotModel& robot = test::z1();
  test::DrivenTick driven(robot), sound(robot);
  driven.policy->pull_rad = 1.0;
  driven.request.mode = sound.request.mode = Mode::kStand;
  for (int k = 0; k < 300 && driven.tick.result().mode != Mode::kFault; ++k) {
    driven.step();
    if (driven.tick.result().mode == Mode::kFault) break;
    // Until the sound one, which asks for nothing, has the drives, both send the reference.
    EXPECT_LT((driven.tick.result().command.q - sound.step().command.q).cwiseAbs().maxCoeff(), 1e-12) << k;
  }
  const faults::Fault& fault = driven.tick.result().fault;
  EXPECT_EQ(fault.code, faults::FaultCode::kActionOutOfRange);
  EXPECT_NEAR(fault.value, 1.0, 1e-12);
  EXPECT_NE(faults::describe(fault, robot).find(robot.joint_index.name(3)), std::string::npos);
  EXPECT_EQ(driven.policy->calls, 0) << "nothing of it was sent";
}

TEST(Tick, AFirstStepThatPassesIsRampedIn) {
  test::DrivenTick driven(test::z1());
  driven.policy->pull_rad = 0.45;
  driven.request.mode = Mode::kStand;
  driven.run(0.3);
  double moved_rad = 0.0, before_rad = driven.tick.result().command.q[3];
  for (int k = 0; k < 150; ++k) {
    const double now_rad = driven.step().command.q[3];
    moved_rad = std::max(moved_rad, std::abs(now_rad - std::exchange(before_rad, now_rad)));
  }
  ASSERT_EQ(driven.tick.result().mode, Mode::kStand);
  EXPECT_NEAR(before_rad - driven.tick.result().reference.q[3], 0.45, 1e-9) << "all of it, in the end";
  // Within 0.2 s, at half as much again as the mean speed: 1.5 * 0.45 rad / 20 ticks.
  EXPECT_LE(moved_rad, 0.035);
}

TEST(Tick, APolicyThatIsNoNumberIsAFaultWhileNothingOfItIsSent) {
  test::DrivenTick driven(test::z1());
  driven.policy->how = test::BreakablePolicy::Break::kNotANumber;
  driven.request.mode = Mode::kStand;
  driven.run(0.2);
  EXPECT_EQ(driven.tick.result().fault.code, faults::FaultCode::kPolicyNotFinite);
  EXPECT_EQ(driven.policy->calls, 1) << "the failed one alone";
}

TEST(Tick, FaultsStayInForceInTheAir) {
  const model::RobotModel& robot = test::z1();
  test::DrivenTick driven(robot);
  driven.carried = {0.0, 0.0};
  driven.request.mode = Mode::kStand;
  driven.run(2.0);
  ASSERT_TRUE(hanging(driven.tick.result().maker));
  driven.state.orientation_WI = Eigen::AngleAxisd(1.2, Eigen::Vector3d::UnitX()) * driven.state.orientation_WI;
  driven.run(0.05);
  EXPECT_EQ(driven.tick.result().fault.code, faults::FaultCode::kTilt);
  EXPECT_FALSE(hanging(driven.tick.result().maker)) << "a sub-state of Stand and of Walk alone";
  EXPECT_FALSE(driven.tick.result().foot_load.has_value());
}

TEST(Tick, WhatNeedsNoGroundIsRunInTheAir) {
  auto policy = std::make_unique<test::BreakablePolicy>();
  policy->balances = false;
  test::DrivenTick driven(test::z1(), std::move(policy));
  driven.carried = {0.0, 0.0};
  driven.drive.command[kVx] = 0.5;
  driven.request.mode = Mode::kWalk;
  driven.run(4.0);
  EXPECT_EQ(driven.tick.result().mode, Mode::kWalk);
  EXPECT_FALSE(hanging(driven.tick.result().maker));
}

/// Steps so short that speeds are finite but their squares are not: the optimisation can't converge while feet move.
ClipLibrary hopeless_clips(const model::RobotModel& robot) {
  ClipLibrary library = test::clips(robot);
  for (auto* clips : {&library.positive, &library.negative}) {
    for (auto& clip : *clips) {
      if (clip) clip->period_s = 1e-200;
    }
  }
  return library;
}

TEST(Tick, WithoutConvergenceTheLastSolutionIsHeldAndThenWalkingEnds) {
  const model::RobotModel& robot = test::biped();
  test::DrivenTick driven(robot, std::make_unique<test::BreakablePolicy>(), hopeless_clips(robot));
  driven.request.mode = Mode::kWalk;
  driven.run(2.0);
  ASSERT_EQ(driven.tick.result().mode, Mode::kWalk);
  ASSERT_EQ(driven.tick.result().optimised.status, gco::Status::kConverged);
  const Command feasible = driven.tick.result().optimised.command;
  driven.drive.command[kVx] = 0.2;
  for (int k = 0; k < 100; ++k) {
    const TickResult& result = driven.step();
    ASSERT_EQ(result.mode, Mode::kWalk) << k;
    ASSERT_EQ(result.optimised.status, gco::Status::kNotConverged);
    ASSERT_EQ(driven.policy->seen_command, feasible) << "what the policy is told";
  }
  driven.asking = false;  // no one requests walking, but a source still drives: the stop is the controller's own
  const TickResult& result = driven.run(0.6);
  EXPECT_EQ(result.mode, Mode::kStand);
  EXPECT_EQ(result.fault.code, faults::FaultCode::kNone);
  EXPECT_EQ(result.optimised.status, gco::Status::kConverged) << "at rest it converges again";
}

/// Heap allocations of a run with every mode change, a walk with all channels, and a fault.
long allocations_of_a_run(test::BreakablePolicy::Break how) {
  test::DrivenTick driven(test::z1());
  driven.drive.command = Command{{0.4, 0.1, 0.2, 0.1, 0.05, -0.04}};
  driven.policy->how = how;
  const long before = test::allocation_count();
  driven.request.mode = Mode::kWalk;
  driven.run(3.0);
  driven.request.mode = Mode::kStand;
  driven.run(1.0);
  driven.carried = {0.0, 0.0};
  driven.run(0.5);
  driven.carried = {0.5, 0.5};
  driven.run(0.5);
  driven.request.mode = Mode::kDamping;
  driven.run(0.1);
  driven.state.q[3] = std::numeric_limits<double>::quiet_NaN();
  driven.run(0.1);
  return test::allocation_count() - before;
}

TEST(Tick, NeverUsesTheHeap) {
  if (test::allocation_count() < 0) GTEST_SKIP() << "allocations can't be counted in this build";
  EXPECT_EQ(allocations_of_a_run(test::BreakablePolicy::Break::kNone), 0);
  EXPECT_GT(allocations_of_a_run(test::BreakablePolicy::Break::kHeap), 300) << "the count must see one that does";
}

}  // namespace
}  // namespace pmg::control
