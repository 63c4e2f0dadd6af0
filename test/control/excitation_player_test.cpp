// One joint is excited while the others hold: in order, complete, within stops and limits, and never again.
#include "control/excitation_player.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "control/fixtures.hpp"
#include "runtime/excitation_recorder.hpp"

namespace pmg::control {
namespace {

using test::kTick_s;

ExcitationPlan plan(const model::RobotModel& robot) {
  ExcitationPlan excitation;
  excitation.joint = robot.joint_index.at("left_elbow");
  std::vector<double> steps(60, -0.3), sine;
  std::fill(steps.begin() + 30, steps.end(), -0.5);
  for (int k = 0; k < 100; ++k) sine.push_back(-0.4 + 0.1 * std::sin(0.1 * k));
  excitation.runs = {{steps, 60.0, 2.0}, {sine, 30.0, 1.0}};
  return excitation;
}

/// A tick that shall excite, and its recorder.
struct Bench {
  Bench() : joint(test::z1().joint_index.at("left_elbow")), recorder(joint, {60, 100}) {
    const model::RobotModel& robot = test::z1();
    TickOptions options = tick_options(robot);
    options.excitation = plan(robot);
    tick =
        std::make_unique<Tick>(robot, test::clips(robot), std::make_unique<policy::ReferencePolicy>(), clock, options);
    record.state = test::standing_state(robot);
    request.source = Source::make("test", 1);
    request.mode = Mode::kStand;
  }
  const TickResult& step() {
    record.now_ns += 10'000'000;
    record.state.stamp_ns = record.now_ns;
    record.state.bus_sample += 5;
    record.requests[0] = request;
    record.requests[0].sequence = ++sequence;
    record.requests[0].stamp_ns = record.requests[0].received_ns = record.now_ns;
    record.request_count = 1;
    record.result = tick->step(record.input());
    recorder.add(record);
    if (record.result.command.kp.sum() > 0.0) record.state.q = record.result.command.q;
    return record.result;
  }
  const TickResult& until_run(int run) {
    for (int k = 0; k < 2000 && step().excitation.run != run;) ++k;
    return record.result;
  }
  io::SimulationClock clock;
  std::unique_ptr<Tick> tick;
  TickRecord record;
  ModeRequest request;
  std::int64_t sequence = 0;
  int joint;
  runtime::ExcitationRecorder recorder;
};

TEST(Excitation, IsPlayedRunByRunWithItsGainsWhileTheOthersHold) {
  Bench bench;
  const JointVector stand = test::z1().q_stand();
  const ExcitationPlan excitation = plan(test::z1());
  for (int k = 0; k < 2000 && !bench.step().excitation.over; ++k) {
    const TickResult& result = bench.record.result;
    JointVector others = result.command.q - stand;
    others[bench.joint] = 0.0;
    ASSERT_LT(others.cwiseAbs().maxCoeff(), 1e-9) << "tick " << k;
    if (result.excitation.run < 0) continue;
    const ExcitationRun& run = excitation.runs[static_cast<std::size_t>(result.excitation.run)];
    EXPECT_EQ(result.command.q[bench.joint], run.q_cmd_rad[static_cast<std::size_t>(result.excitation.sample)]);
    EXPECT_EQ(result.command.kp[bench.joint], run.kp_Nm_per_rad);
    EXPECT_EQ(result.command.kd[bench.joint], run.kd_Nm_s_per_rad);
  }
  ASSERT_TRUE(bench.record.result.excitation.over);
  EXPECT_FALSE(bench.record.result.excitation.given_up);
  ASSERT_EQ(bench.recorder.complete().size(), 2U);
  EXPECT_EQ(bench.recorder.complete()[0].q_cmd_rad, excitation.runs[0].q_cmd_rad);
  EXPECT_NEAR(bench.recorder.complete()[1].t_s.back(), 0.99, 1e-9);
  EXPECT_EQ(bench.step().command.kp[bench.joint],
            test::z1().joints[static_cast<std::size_t>(bench.joint)].kp_Nm_per_rad);
  EXPECT_NEAR(bench.step().command.q[bench.joint], stand[bench.joint], 1e-9);
}

TEST(Excitation, TakesAsLongAsItSays) {
  const model::RobotModel& robot = test::z1();
  const ExcitationPlan excitation = plan(robot);
  ExcitationPlayer player(excitation, robot, {-0.35, 60.0, 2.0}, kTick_s);
  int ticks = 0;
  while (!player.progress().over && ticks < 10000) player.step(), ++ticks;
  EXPECT_NEAR(ticks * kTick_s, player.duration_s(), 0.1);
}

TEST(Excitation, EndsWithAStopAndDoesNotBeginAgainByItself) {
  Bench bench;
  bench.until_run(1);
  bench.request.mode = Mode::kDamping;
  EXPECT_EQ(bench.step().mode, Mode::kDamping);
  EXPECT_EQ(bench.record.result.command.kp.sum(), 0.0);
  EXPECT_TRUE(bench.record.result.excitation.given_up);
  EXPECT_EQ(bench.recorder.complete().size(), 1U) << "what was whole is kept";
  bench.request.mode = Mode::kStand;
  for (int k = 0; k < 500; ++k) ASSERT_EQ(bench.step().excitation.run, -1);
  EXPECT_EQ(bench.record.result.mode, Mode::kStand);
}

TEST(Excitation, EndsWithAFault) {
  Bench bench;
  bench.until_run(0);
  bench.record.state.temperature_degC[3] = 150.0;
  bench.step();
  EXPECT_EQ(bench.record.result.mode, Mode::kFault);
  EXPECT_TRUE(bench.record.result.excitation.given_up);
  EXPECT_EQ(bench.recorder.complete().size(), 0U);
}

TEST(Excitation, ARunWithAHoleIsNotRecordedAndTheNextOneIs) {
  for (const double pause_s : {0.1, -kTick_s}) {  // the host paused; the bus had no new sample
    Bench bench;
    bench.until_run(0);
    const auto pause_ns = static_cast<std::int64_t>(pause_s * 1e9);
    bench.record.now_ns += pause_ns;
    bench.step();
    if (pause_ns < 0) bench.record.now_ns -= pause_ns;
    for (int k = 0; k < 2000 && !bench.step().excitation.over;) ++k;
    ASSERT_EQ(bench.recorder.complete().size(), 1U) << pause_s;
    EXPECT_EQ(bench.recorder.complete()[0].run, 1);
  }
}

TEST(Excitation, NeverWalks) {
  Bench bench;
  bench.until_run(0);
  bench.request.mode = Mode::kWalk;
  for (int k = 0; k < 50; ++k) ASSERT_EQ(bench.step().mode, Mode::kStand);
  EXPECT_EQ(bench.record.result.acks[0].verdict, Verdict::kNoMode);
  EXPECT_GE(bench.record.result.excitation.run, 0) << "and goes on";
}

TEST(Excitation, StaysWithinTheLimiter) {
  Bench bench;
  bench.until_run(0);
  bench.record.state.q[bench.joint] -= 0.8;  // the joint was pushed away: the spring's torque is cut
  const double pushed_rad = bench.record.state.q[bench.joint];
  const TickResult& result = bench.step();
  EXPECT_GT(result.limited.torque, 0);
  EXPECT_NEAR(result.command.kp[bench.joint] * (result.command.q[bench.joint] - pushed_rad),
              test::z1().joints[static_cast<std::size_t>(bench.joint)].effort_limit_Nm, 1e-9);
}

TEST(Excitation, IsRefusedWhenTheJointMayNot) {
  const model::RobotModel& robot = test::z1();
  const auto with = [&](auto&& change) {
    ExcitationPlan changed = plan(robot);
    change(changed);
    return changed;
  };
  EXPECT_NO_THROW(check(plan(robot), robot));
  for (const ExcitationPlan& bad :
       {with([](auto& p) { p.runs[0].q_cmd_rad[7] = 3.0; }), with([](auto& p) { p.runs[1].kp_Nm_per_rad = 1e5; }),
        with([](auto& p) { p.runs.clear(); }), with([](auto& p) { p.joint = 99; })}) {
    EXPECT_THROW(check(bad, robot), std::invalid_argument);
  }
  EXPECT_THROW(check(plan(robot), robot, {.max_kp_Nm_per_rad = 50.0}), std::invalid_argument)
      << "the guard in force would clamp them";
}

TEST(Excitation, ATickChecksGainsAgainstItsOwnGuard) {
  const model::RobotModel& robot = test::z1();
  TickOptions options = tick_options(robot);
  options.excitation = plan(robot);
  options.excitation->runs[0].kp_Nm_per_rad = 2500.0;
  const io::SimulationClock clock;
  const auto make = [&] {
    Tick(robot, test::clips(robot), std::make_unique<policy::ReferencePolicy>(), clock, options);
  };
  EXPECT_THROW(make(), std::invalid_argument) << "the default guard allows 2000";
  options.guard.max_kp_Nm_per_rad = 3000.0;
  EXPECT_NO_THROW(make());
}

}  // namespace
}  // namespace pmg::control
