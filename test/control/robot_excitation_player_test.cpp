// All joints are excited at once: only on the footing that it needs, softly at both ends, and never past a stop.
#include "control/robot_excitation_player.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "control/fixtures.hpp"

namespace pmg::control {
namespace {

using test::kTick_s;

/// Five seconds: every joint swings by 0.05 rad, then under half the gains; the last command is far from rest.
RobotExcitationPlan plan(const model::RobotModel& robot, faults::Footing footing) {
  RobotExcitationPlan made;
  made.footing = footing;
  model::JointCommand rest;
  rest.q = robot.q_stand();
  rest.dq = rest.tau_ff = JointVector::Zero(rest.q.size());
  rest.kp.resize(rest.q.size());
  rest.kd.resize(rest.q.size());
  for (int j = 0; j < rest.q.size(); ++j) {
    rest.kp[j] = robot.joints[static_cast<std::size_t>(j)].kp_Nm_per_rad;
    rest.kd[j] = robot.joints[static_cast<std::size_t>(j)].kd_Nm_s_per_rad;
  }
  for (int k = 0; k < 500; ++k) {
    model::JointCommand command = rest;
    command.q.array() += 0.05 * std::sin(0.01 * k);
    command.q = command.q.cwiseMax(robot.q_lower()).cwiseMin(robot.q_upper());
    if (k > 0) command.dq.setConstant(0.05 * std::cos(0.01 * k));
    if (k >= 250) command.kp *= 0.5;
    made.commands.push_back(command);
  }
  return made;
}

/// A tick without a policy that shall excite a robot whose feet carry so much of its weight.
struct Excited {
  explicit Excited(faults::Footing footing, double weight_share) : feet(robot), carried{weight_share, weight_share} {
    TickOptions options = tick_options(robot);
    options.robot_excitation = plan(robot, footing);
    tick =
        std::make_unique<Tick>(robot, test::clips(robot), std::make_unique<policy::ReferencePolicy>(), clock, options);
    state = test::standing_state(robot);
    request.source = Source::make("test", 1);
  }
  /// One tick; asks for this mode in it.
  const TickResult& step(std::optional<Mode> ask = std::nullopt, bool stop = false) {
    now_ns += 10'000'000;
    state.stamp_ns = now_ns;
    state.bus_sample += 5;
    feet.apply(carried, state);
    request.mode = ask.value_or(Mode::kStand);
    ++request.sequence;
    request.stamp_ns = request.received_ns = now_ns;
    const std::span<const ModeRequest> requests(&request, ask ? 1U : 0U);
    const TickResult& result =
        tick->step({.state = state, .now_ns = now_ns, .drives = {}, .requests = requests, .stop = stop});
    if (result.command.kp.sum() > 0.0) state.q = result.command.q;
    return result;
  }
  /// Steps until the play has this sample; false if that doesn't happen within so many ticks.
  bool until_sample(int sample, int ticks = 2000) {
    for (int k = 0; k < ticks; ++k) {
      if (step(k < 5 ? std::optional(Mode::kStand) : std::nullopt).excitation.sample >= sample) return true;
    }
    return false;
  }
  const model::RobotModel& robot = test::z1();
  io::SimulationClock clock;
  std::unique_ptr<Tick> tick;
  test::LoadedFeet feet;
  PerFoot<double> carried;
  model::RobotState state;
  ModeRequest request;
  std::int64_t now_ns = 0;
};

constexpr double kOnTheGround = 0.5, kInTheAir = 0.0;

TEST(RobotExcitation, BeginsWhenTheRobotHasSettledOnItsFootingForSomeTime) {
  Excited hanging(faults::Footing::kHangs, kInTheAir);
  int stood = 0;
  for (int k = 0; k < 2000; ++k) {
    const TickResult& result = hanging.step(Mode::kStand);
    if (result.excitation.run == 0) break;
    stood += result.mode == Mode::kStand && !result.entering ? 1 : 0;
  }
  const RobotExcitationPlan told;
  EXPECT_GE(stood * kTick_s, told.settle_s - kTick_s);
  EXPECT_LE(stood * kTick_s, told.settle_s + 1.0) << "a second until the loads of the feet are judged";
}

TEST(RobotExcitation, NeverBeginsOnTheWrongFooting) {
  Excited set_down(faults::Footing::kHangs, kOnTheGround), hanging(faults::Footing::kStands, kInTheAir);
  EXPECT_FALSE(set_down.until_sample(0));
  EXPECT_FALSE(hanging.until_sample(0));
  Excited standing(faults::Footing::kStands, kOnTheGround);
  EXPECT_TRUE(standing.until_sample(0));
}

TEST(RobotExcitation, SendsEveryCommandAsItIsAndEndsAtRest) {
  Excited excited(faults::Footing::kHangs, kInTheAir);
  const RobotExcitationPlan told = plan(excited.robot, faults::Footing::kHangs);
  ASSERT_TRUE(excited.until_sample(0));
  for (std::size_t k = 1; k < told.commands.size(); ++k) {
    const TickResult& result = excited.step();
    ASSERT_EQ(result.excitation.sample, static_cast<int>(k));
    EXPECT_TRUE(result.command.q.isApprox(told.commands[k].q));
    EXPECT_EQ(result.command.dq, told.commands[k].dq);
    EXPECT_EQ(result.command.kp, told.commands[k].kp);
    EXPECT_EQ(result.command.kd, told.commands[k].kd);
  }
  model::JointCommand before = told.commands.back();
  int ticks = 0;
  for (; !excited.step().excitation.over && ticks < 1000; ++ticks) {
    const model::JointCommand& now = excited.tick->result().command;
    // A smooth way of 2 s moves by at most 1.5 / 200 of the whole in a tick.
    EXPECT_LE((now.q - before.q).cwiseAbs().maxCoeff(), 0.0076 * 0.1);
    EXPECT_LE((now.dq - before.dq).cwiseAbs().maxCoeff(), 0.0076 * 0.06);
    EXPECT_LE(((now.kp - before.kp).array() / told.commands.front().kp.array()).abs().maxCoeff(), 0.0076 * 0.5);
    before = now;
  }
  EXPECT_NEAR(ticks * kTick_s, told.return_s, 0.05);
  EXPECT_FALSE(excited.tick->result().excitation.given_up);
  const model::JointCommand& rest = excited.step().command;
  EXPECT_EQ(rest.q, told.commands.front().q);
  EXPECT_EQ(rest.kp, told.commands.front().kp);
  EXPECT_TRUE(rest.dq.isZero());
}

TEST(RobotExcitation, AStopDampsInTheSameTickAndNothingBeginsAgain) {
  Excited excited(faults::Footing::kHangs, kInTheAir);
  ASSERT_TRUE(excited.until_sample(300));
  const TickResult& stopped = excited.step(std::nullopt, true);
  EXPECT_EQ(stopped.mode, Mode::kDamping);
  EXPECT_TRUE(stopped.command.kp.isZero());
  EXPECT_TRUE(stopped.command.dq.isZero());
  EXPECT_GT(stopped.command.kd.minCoeff(), 0.0);
  EXPECT_TRUE(stopped.excitation.over && stopped.excitation.given_up);
  EXPECT_FALSE(excited.until_sample(0)) << "also after another Stand";
  EXPECT_EQ(excited.tick->result().mode, Mode::kStand);
}

TEST(RobotExcitation, ComesBackSoftlyWhenTheRobotIsSetDownInItsMidst) {
  Excited excited(faults::Footing::kHangs, kInTheAir);
  ASSERT_TRUE(excited.until_sample(200));
  excited.carried = {kOnTheGround, kOnTheGround};
  JointVector before = excited.tick->result().command.q;
  int ticks = 0;
  for (; !excited.step().excitation.over && ticks < 1000; ++ticks) {
    EXPECT_LE((excited.tick->result().command.q - before).cwiseAbs().maxCoeff(), 0.002);
    before = excited.tick->result().command.q;
  }
  EXPECT_LT(ticks * kTick_s, 4.0) << "a second without its footing, and two on the way back";
  EXPECT_TRUE(excited.tick->result().excitation.given_up);
  EXPECT_EQ(excited.tick->result().mode, Mode::kStand);
}

TEST(RobotExcitation, LegsThatSwingEndNothing) {
  Excited excited(faults::Footing::kHangs, kInTheAir);
  ASSERT_TRUE(excited.until_sample(0));
  for (int k = 1; k < 500; ++k) {  // a weight up and down at 2 Hz
    const double share = 0.5 * std::sin(2.0 * 3.1416 * 2.0 * 0.01 * k);
    excited.carried = {share, share};
    ASSERT_EQ(excited.step().excitation.sample, k);
  }
}

TEST(RobotExcitation, ComesBackWhenAStandingRobotIsLifted) {
  Excited excited(faults::Footing::kStands, kOnTheGround);
  ASSERT_TRUE(excited.until_sample(100));
  excited.carried = {kInTheAir, kInTheAir};
  int ticks = 0;
  while (!excited.step().excitation.over && ticks < 1000) ++ticks;
  EXPECT_LT(ticks * kTick_s, 4.0);
  EXPECT_TRUE(excited.tick->result().excitation.given_up);
}

TEST(RobotExcitation, NothingWalksMeanwhile) {
  Excited excited(faults::Footing::kStands, kOnTheGround);
  ASSERT_TRUE(excited.until_sample(10));
  EXPECT_EQ(excited.step(Mode::kWalk).acks.front().verdict, Verdict::kNoMode);
  EXPECT_EQ(excited.step().mode, Mode::kStand);
}

TEST(RobotExcitation, RefusesCommandsThatNoRobotShallGet) {
  const model::RobotModel& robot = test::z1();
  const RobotExcitationPlan good = plan(robot, faults::Footing::kHangs);
  EXPECT_NO_THROW(check(good, robot));
  const auto refused = [&](auto&& spoil) {
    RobotExcitationPlan bad = good;
    spoil(bad);
    EXPECT_THROW(check(bad, robot), std::invalid_argument);
  };
  refused([](RobotExcitationPlan& p) { p.commands.clear(); });
  refused([](RobotExcitationPlan& p) { p.commands[7].q.conservativeResize(3); });
  refused([](RobotExcitationPlan& p) { p.commands[7].dq[2] = std::numeric_limits<double>::quiet_NaN(); });
  refused([](RobotExcitationPlan& p) { p.commands[7].q[2] = 10.0; });
  refused([](RobotExcitationPlan& p) { p.commands[7].dq[2] = 1e3; });
  refused([](RobotExcitationPlan& p) { p.commands[7].kp[2] = 1e6; });
  refused([](RobotExcitationPlan& p) { p.commands[7].kd[2] = -1.0; });
  refused([](RobotExcitationPlan& p) { p.commands[7].tau_ff[2] = 1.0; });
  refused([](RobotExcitationPlan& p) { p.commands.front().q[2] += 0.01; });
}

}  // namespace
}  // namespace pmg::control
