#include "sil/lockstep.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstddef>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>

#include "control/fixtures.hpp"
#include "folders.hpp"
#include "io/log_reader.hpp"
#include "sil/scripted_plant.hpp"
#include "sil/sil_hal.hpp"
#include "sil/summary.hpp"

namespace pmg::sil {
namespace {

Scenario walk(double duration_s, bool hoist = false) {
  Scenario scenario;
  scenario.name = "walk";
  ScenarioStep step;
  step.duration_s = duration_s;
  step.mode = control::Mode::kWalk;
  step.hoist_without_policy = hoist;
  step.command = Command{{0.5, 0.0, 0.2, 0.1, 0.0, -0.03}};
  scenario.steps.push_back(step);
  return scenario;
}

class LockstepRun : public testing::Test {
 protected:
  LockstepRun() { std::filesystem::create_directories(folder_); }
  ~LockstepRun() override { std::filesystem::remove_all(folder_); }

  control::Tick make_tick(const model::RobotModel& robot) {
    return control::Tick(robot, test::clips(robot), std::make_unique<policy::ReferencePolicy>(), clock_,
                         control::tick_options(robot));
  }
  std::string bytes(const std::string& name) {
    std::ifstream file(folder_ / name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  }
  /// A whole simulated run with a log.
  RunOutcome simulate(const model::RobotModel& robot, const Scenario& scenario, const std::string& log_name,
                      std::uint64_t seed) {
    sim::WorldOptions options;
    options.seed = seed;
    options.encoder_noise_rad = 0.0004;
    options.gyro_noise_rad_s = 0.01;
    sim::World world(robot, options);
    sil::SilHal bus(world);
    WorldPlant plant(world);
    control::Tick tick = make_tick(robot);
    io::LogWriter writer(folder_ / log_name);
    recording::TickLog log(writer, robot, {.robot = robot.name}, 100.0);
    return Lockstep(robot, bus, plant, tick, scenario, &log, {}).run();
  }

  io::SimulationClock clock_;
  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("pmg_lockstep_test_" + std::to_string(getpid()));
};

TEST_F(LockstepRun, HoldingACommandForATickTakesAsLongAsATick) {
  sim::World world(test::biped(), {});
  model::JointCommand command;
  command.q = test::biped().q_stand();
  command.dq = command.kp = command.kd = command.tau_ff = JointVector::Zero(test::biped().joint_index.size());
  const double start_s = world.time_s();
  hold_for_one_tick(world, command);
  EXPECT_NEAR(world.time_s() - start_s, control::tick_options(test::biped()).dt_s, 1e-12) << "rounding of five sums";
}

TEST_F(LockstepRun, TheBusGuardHasTheTicksOptions) {
  const model::RobotModel& robot = test::z1();
  test::IdealBus bus(robot);
  test::ScriptedPlant plant;
  plant.value.p_WB.z() = robot.standing_height_m;
  control::TickOptions options = control::tick_options(robot);
  options.guard.hold_cycles = 2;  // fewer than a tick has
  control::Tick tick(robot, test::clips(robot), std::make_unique<policy::ReferencePolicy>(), clock_, options);
  const Scenario scenario = walk(0.5);
  const RunOutcome outcome = Lockstep(robot, bus, plant, tick, scenario, nullptr, {}).run();
  ASSERT_EQ(outcome.faults.size(), 1U);
  EXPECT_EQ(outcome.faults[0].code, faults::FaultCode::kControlFrozen);
}

TEST_F(LockstepRun, OneTickPerFiveBusStepsAndCommandsActFromTheNextStepOn) {
  const model::RobotModel& robot = test::z1();
  test::IdealBus bus(robot);
  test::ScriptedPlant plant;
  plant.value.p_WB.z() = robot.standing_height_m;
  control::Tick tick = make_tick(robot);
  const Scenario scenario = walk(2.0);
  Lockstep lockstep(robot, bus, plant, tick, scenario, nullptr, {});
  std::uint64_t ticks = 0;
  JointVector commanded = robot.q_stand();
  lockstep.after_tick = [&](const RunProgress& progress) {
    ++ticks;
    EXPECT_EQ(progress.result.command.bus_sample, 5 * ticks);
    // In the five steps before this tick the bus got the command of the tick before.
    EXPECT_EQ(bus.last_command.bus_sample, 5 * (ticks - 1));
    EXPECT_EQ(bus.last_command.q, commanded);
    commanded = progress.result.command.q;
  };
  const RunOutcome outcome = lockstep.run();
  EXPECT_EQ(ticks, 200u);
  EXPECT_NEAR(outcome.duration_s, 2.0, 1e-9);
  EXPECT_FALSE(outcome.fell);
}

TEST_F(LockstepRun, SameSeedSameLogByteForByte) {
  const Scenario scenario = walk(3.0, true);
  simulate(test::z1(), scenario, "a.lcm", 7);
  simulate(test::z1(), scenario, "b.lcm", 7);
  simulate(test::z1(), scenario, "c.lcm", 8);
  ASSERT_GT(bytes("a.lcm").size(), 500'000u);
  EXPECT_TRUE(bytes("a.lcm") == bytes("b.lcm"));
  EXPECT_FALSE(bytes("a.lcm") == bytes("c.lcm")) << "the seed must matter";
}

TEST_F(LockstepRun, AnotherRobotNeedsNoOtherCode) {
  const RunOutcome outcome = simulate(test::biped(), walk(4.0, true), "biped.lcm", 0);
  EXPECT_FALSE(outcome.diverged);
  EXPECT_TRUE(outcome.faults.empty());
  EXPECT_GT(outcome.hoisted_s, 3.9);
}

TEST_F(LockstepRun, TheTruthOfTheSimulationReachesNoDrive) {
  const model::RobotModel& robot = test::z1();
  const auto commands = [&](double truth) {
    test::IdealBus bus(robot);
    test::ScriptedPlant plant;
    plant.value.p_WB.setConstant(truth);
    plant.value.v_WB_W.setConstant(truth);
    plant.value.omega_WB_B.setConstant(truth);
    plant.value.q_WB.coeffs().setConstant(truth);
    plant.value.q_WT.coeffs().setConstant(truth);
    plant.value.foot_force_N.fill(truth);
    plant.value.foot_slip_m_s.fill(truth);
    control::Tick tick = make_tick(robot);
    const Scenario scenario = walk(3.0);
    Lockstep lockstep(robot, bus, plant, tick, scenario, nullptr, {});
    std::string all;  // every byte of the ticks' commands and of the drives' commands
    lockstep.after_tick = [&](const RunProgress& progress) {
      for (const model::JointCommand& command : {progress.result.command, bus.last_command}) {
        for (const JointVector* values : {&command.q, &command.dq, &command.kp, &command.kd, &command.tau_ff}) {
          const auto bytes = std::as_bytes(std::span(values->data(), static_cast<std::size_t>(values->size())));
          for (const std::byte byte : bytes) all.push_back(static_cast<char>(byte));
        }
      }
    };
    lockstep.run();
    return all;
  };
  const std::string plain = commands(0.5);
  EXPECT_EQ(plain.size(), 300u * 2u * 5u * 31u * sizeof(double));
  EXPECT_TRUE(plain == commands(std::numeric_limits<double>::quiet_NaN()));
}

TEST_F(LockstepRun, GantryTimeIsReportedAndNotJudged) {
  const model::RobotModel& robot = test::z1();
  Scenario scenario = walk(3.0, true);
  ScenarioStep down = scenario.steps[0];
  down.start_s = 3.0;
  down.hoist_without_policy = false;
  down.command = Command{};
  scenario.steps.push_back(down);
  test::ScriptedPlant plant;
  plant.value.p_WB.z() = robot.standing_height_m;
  for (const bool policy : {false, true}) {
    test::IdealBus bus(robot);
    control::Tick tick = make_tick(robot);
    const RunOutcome outcome =
        Lockstep(robot, bus, plant, tick, scenario, nullptr, {.balanced_by_policy = policy}).run();
    // Three seconds, and two to set the robot down.
    EXPECT_NEAR(outcome.hoisted_s, policy ? 0.0 : 5.0, 0.03);
    EXPECT_NEAR(outcome.tracking.followed_s, policy ? 6.0 : 1.0, 0.05);
    EXPECT_EQ(plant.hold, 0.0);
  }
}

/// Needs the ground: it runs unsent for half a second before it gets the drives.
class Rehearsed final : public policy::Policy {
 public:
  policy::Status act(const model::RobotState& /*state*/, const Reference& reference, const Command& /*observed*/,
                     JointVector& q_des) noexcept override {
    q_des = reference.q;
    return policy::Status::kOk;
  }
};

TEST_F(LockstepRun, APolicyThatIsStillRehearsedIsNoReasonToTakeTheGantryAway) {
  const model::RobotModel& robot = test::z1();
  test::IdealBus bus(robot);
  test::ScriptedPlant plant;
  plant.value.p_WB.z() = robot.standing_height_m;
  control::Tick tick(robot, test::clips(robot), std::make_unique<Rehearsed>(), clock_, control::tick_options(robot));
  const Scenario scenario = walk(2.0, true);
  const RunOutcome outcome = Lockstep(robot, bus, plant, tick, scenario, nullptr, {.balanced_by_policy = true}).run();
  EXPECT_GT(outcome.hoisted_s, 0.5) << "as long as it runs unsent";
  EXPECT_LT(outcome.hoisted_s, 1.5) << "and no longer than the gantry needs to let go";
}

TEST_F(LockstepRun, InterruptionKeepsWhatWasDone) {
  const model::RobotModel& robot = test::z1();
  test::IdealBus bus(robot);
  test::ScriptedPlant plant;
  control::Tick tick = make_tick(robot);
  const Scenario scenario = walk(3.0);
  Lockstep lockstep(robot, bus, plant, tick, scenario, nullptr, {});
  int asked = 0;
  lockstep.interrupted = [&] { return ++asked > 100; };
  const RunOutcome outcome = lockstep.run();
  EXPECT_TRUE(outcome.interrupted);
  EXPECT_NEAR(outcome.duration_s, 1.0, 1e-9);
}

TEST_F(LockstepRun, AFaultIsInTheLogAndInTheSummary) {
  const model::RobotModel& robot = test::z1();
  test::IdealBus bus(robot);
  bus.status = hal::BusStatus::kLost;
  test::ScriptedPlant plant;
  plant.value.p_WB.z() = robot.standing_height_m;
  control::Tick tick = make_tick(robot);
  const Scenario scenario = walk(0.5);
  RunOutcome outcome;
  {
    io::LogWriter writer(folder_ / "fault.lcm");
    recording::TickLog log(writer, robot, {.robot = robot.name}, 100.0);
    Lockstep lockstep(robot, bus, plant, tick, scenario, &log, {});
    outcome = lockstep.run();
    const auto summary = summary_json({robot.name, scenario.name, "none", 0, 0.1}, outcome, lockstep.timing(), robot);
    ASSERT_EQ(summary["faults"].size(), 1u);
    EXPECT_EQ(summary["faults"][0]["code"], "bus_lost");
    for (const char* key : {"fell", "duration_s", "realtime_factor", "tracking", "reference_slip", "timing_us"}) {
      EXPECT_TRUE(summary.contains(key)) << key;
    }
  }
  ASSERT_EQ(outcome.faults.size(), 1u);
  int faults = 0, states = 0;
  io::LogReader reader(folder_ / "fault.lcm");
  ASSERT_TRUE(reader.next());
  EXPECT_EQ(reader.channel(), "ROBOT_INFO");
  while (reader.next()) {
    faults += reader.channel() == "FAULT" ? 1 : 0;
    states += reader.channel() == "STATE" ? 1 : 0;
  }
  EXPECT_EQ(faults, 1);
  EXPECT_EQ(states, 50);
}

TEST_F(LockstepRun, TheTourDoesNotFallAndItsReferenceKeepsTheFeetOnTheGround) {
  const Scenario tour =
      load_scenario(std::filesystem::path(pmg::test::project_folder()) / "config/scenarios/tour.yaml");
  const RunOutcome outcome = simulate(test::z1(), tour, "tour.lcm", 0);
  EXPECT_FALSE(outcome.fell) << "at " << outcome.fell_at_s << " s";
  EXPECT_TRUE(outcome.faults.empty());
  EXPECT_GT(outcome.duration_s - outcome.hoisted_s, 15.0) << "on its own feet";
  EXPECT_GT(outcome.hoisted_s, 60.0) << "walking on the gantry";
  // The project's guarantee for the ground-aware optimisation: postures, walking in every direction, turning and
  // mixtures.
  const gco::SlipSummary& slip = outcome.reference_slip;
  EXPECT_LE(slip.single_support_max_m_s, 1e-3);
  EXPECT_LE(slip.double_support_mean_m_s, 0.03);
  EXPECT_LE(slip.double_support_p95_m_s, 0.10);
  EXPECT_LE(slip.lower_foot_height_max_m, 1e-3);
  EXPECT_LE(slip.other_foot_height_max_m, 1e-2);
  EXPECT_GT(slip.before_mean_m_s, slip.double_support_mean_m_s);
  EXPECT_EQ(slip.not_converged_ticks, 0);
  EXPECT_GT(slip.single_support_ticks, 1000);
  EXPECT_GT(slip.double_support_ticks, 300);
}

TEST(StageTiming, PercentilesAreNearestRanksOverTicksThatRan) {
  StageTiming timing;
  for (int k = 1; k <= 100; ++k)
    timing.add(0.01 * k, {.tick_ns = 1000 * k, .generator_ns = 10, .gco_ns = 0, .policy_ns = 0});
  timing.add(2.0, {.tick_ns = 9'000'000});  // released drives: no stage ran
  EXPECT_DOUBLE_EQ(timing.percentiles(&control::StageTimes::tick_ns).p50_us, 50.0);
  EXPECT_DOUBLE_EQ(timing.percentiles(&control::StageTimes::tick_ns).p99_us, 99.0);
  EXPECT_DOUBLE_EQ(StageTiming().percentiles(&control::StageTimes::tick_ns).p99_us, 0.0);
}

}  // namespace
}  // namespace pmg::sil
