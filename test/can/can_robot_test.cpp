// The whole controller walks with MuJoCo behind emulated drives. PMG_CAN_SOCKETS=1 in the environment: over the CAN
// interfaces that robot.yaml names (test/can/canrun makes them); otherwise over memory.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "can/can_backend.hpp"
#include "can/emulated_robot.hpp"
#include "can/memory_link.hpp"
#include "can/socket_link.hpp"
#include "control/control_setup.hpp"
#include "control/fixtures.hpp"
#include "sil/lockstep.hpp"
#include "sil/sil_hal.hpp"
#include "sil/simulated_robot.hpp"

namespace pmg::sil {
namespace {

bool over_sockets() { return std::getenv("PMG_CAN_SOCKETS") != nullptr; }

std::pair<test::Links, test::Links> links(const drives::DriveSetup& setup) {
  if (!over_sockets()) return test::link_pairs<test::MemoryLink>(setup.buses.size());
  std::pair<test::Links, test::Links> ends;
  for (const drives::BusSetup& bus : setup.buses) {
    ends.first.push_back(std::make_unique<can::SocketLink>(
        bus.name,
        std::vector<std::uint32_t>{can::kReplyId, can::kImuQuaternion, can::kImuRateOfTurn, can::kImuAcceleration},
        false));
    ends.second.push_back(std::make_unique<can::SocketLink>(bus.name, std::vector<std::uint32_t>{}, false));
  }
  return ends;
}

/// Z1, its policy and its world, once more for each run.
struct Stage {
  explicit Stage(std::uint64_t seed, bool over_can) : loaded(load()) {
    if (over_can) take_backend_limits();
    world.emplace(loaded.robot, world_with_noise(seed, false));
    if (!over_can) return;
    setup = drives::load_drives(loaded.robot);
    auto [host, far] = links(setup);
    robot.emplace(setup, loaded.robot, *world, std::move(host), std::move(far));
  }
  static control::LoadedControl load() {
    control::ControlSetup setup;
    setup.robot = test::kZ1Folder;
    return control::load_control(setup);
  }
  void take_backend_limits() {
    hal::BackendFactory factory;
    can::register_backend(factory);
    const auto backend = factory.kind("can").make({.robot = loaded.robot,
                                                   .clock = clock,
                                                   .name = "z1",
                                                   .lcm_url = "memq://",
                                                   .benched_joint = "",
                                                   .keeps_truth = false,
                                                   .options = {}});
    control::take_limits(backend->limits(), loaded.options);
  }
  RunOutcome run(const Scenario& scenario) {
    SilHal in_process(*world);
    hal::Hal& bus = robot ? static_cast<hal::Hal&>(*robot) : in_process;
    WorldPlant plant(*world);
    const std::unique_ptr<control::Tick> tick = control::make_tick(loaded, clock);
    Lockstep lockstep(loaded.robot, bus, plant, *tick, scenario, nullptr, {.balanced_by_policy = true});
    lockstep.after_tick = [&](const RunProgress& progress) {
      if (progress.result.mode == control::Mode::kFault) fault = progress.result.fault.code;
      sat_down |= progress.result.sitting;
    };
    return lockstep.run();
  }

  io::WallClock clock;
  control::LoadedControl loaded;
  std::optional<sim::World> world;
  drives::DriveSetup setup;
  std::optional<test::EmulatedRobot> robot;
  faults::FaultCode fault = faults::FaultCode::kNone;
  bool sat_down = false;
};

Scenario walking(double stand_s, double walk_s) {
  Scenario scenario;
  scenario.name = "walk";
  scenario.steps.push_back(
      {.start_s = 0.0, .duration_s = stand_s, .text = "stand", .mode = control::Mode::kStand, .command = {}});
  scenario.steps.push_back({.start_s = stand_s,
                            .duration_s = walk_s,
                            .text = "walk",
                            .mode = control::Mode::kWalk,
                            .command = Command{{0.5, 0.0, 0.2, 0.0, 0.0, 0.0}}});
  return scenario;
}

std::string line(const char* name, const TrackingSummary& t) {
  return fmt::format("{}: velocity {:.4f} m/s, yaw {:.4f} rad/s, pitch {:.4f}, roll {:.4f} rad, height {:.4f} m", name,
                     t.lin_vel_mae_m_s, t.yaw_vel_mae_rad_s, t.pitch_mae_rad, t.roll_mae_rad, t.height_mae_m);
}

/// Walks and counts every frame of every bus.
void walk_and_count(Stage& stage, double walk_s) {
  const Scenario scenario = walking(2.0, walk_s);
  const RunOutcome outcome = stage.run(scenario);
  EXPECT_FALSE(outcome.fell);
  EXPECT_TRUE(outcome.faults.empty());
  EXPECT_LT(outcome.tracking.lin_vel_mae_m_s, 0.3);
  std::uint64_t sent = 0, received = 0;
  can::CanHal& hal = stage.robot->hal();
  model::RobotState last;
  hal.receive(last);  // answers that were under way
  for (std::size_t b = 0; b < stage.setup.buses.size(); ++b) {
    sent += hal.link(b).counts().sent;
    received += hal.link(b).counts().received;
    EXPECT_EQ(hal.link(b).counts().not_sent, 0u);
    for (std::size_t m = 0; m < stage.setup.buses[b].motors.size(); ++m)
      EXPECT_EQ(hal.motor(b, m).lost() + hal.motor(b, m).uncalled(), 0u);
  }
  const auto cycles = static_cast<std::uint64_t>(stage.robot->cycles);
  EXPECT_EQ(sent, 31 * cycles);
  EXPECT_EQ(received, (31 + 3) * cycles) << "31 replies and the IMU's three frames";
}

TEST(CanRobot, ItWalksBehindEmulatedDrivesAndEveryFrameIsAnswered) {
  Stage stage(1, true);
  walk_and_count(stage, 4.0);
}

// Campaign: 31 motors at 500 Hz for a minute, and what the bus thread's part of it costs.
TEST(CanRobot, DISABLED_AMinuteLosesNoFrame) {
  Stage stage(1, true);
  std::vector<std::int64_t>& costs_ns = stage.robot->costs_ns;
  costs_ns.reserve(40'000);
  walk_and_count(stage, 58.0);
  std::ranges::sort(costs_ns);
  const auto quantile_us = [&](double share) {
    return 1e-3 *
           static_cast<double>(costs_ns[static_cast<std::size_t>(share * static_cast<double>(costs_ns.size() - 1))]);
  };
  fmt::print("{} cycles; sending and receiving: p50 {:.1f} us, p99 {:.1f} us\n", costs_ns.size(), quantile_us(0.5),
             quantile_us(0.99));
}

// The campaign of docs/reference/safety.md: minutes. --gtest_also_run_disabled_tests
TEST(CanRobot, DISABLED_TheTourIsTrackedAsInProcess) {
  const Scenario tour = load_scenario(PMG_SOURCE_DIR "/config/scenarios/tour.yaml");
  std::array<double, 5> sums_can{}, sums_sil{};
  constexpr int kSeeds = 5;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    Stage can(static_cast<std::uint64_t>(seed), true), in_process(static_cast<std::uint64_t>(seed), false);
    const RunOutcome over_can = can.run(tour), sil = in_process.run(tour);
    EXPECT_FALSE(over_can.fell) << seed;
    EXPECT_TRUE(over_can.faults.empty()) << seed;
    fmt::print("seed {}\n  {}\n  {}\n", seed, line("can", over_can.tracking), line("sil", sil.tracking));
    const auto add = [](std::array<double, 5>& sums, const TrackingSummary& t) {
      const std::array<double, 5> values = {t.lin_vel_mae_m_s, t.yaw_vel_mae_rad_s, t.pitch_mae_rad, t.roll_mae_rad,
                                            t.height_mae_m};
      for (std::size_t i = 0; i < values.size(); ++i) sums[i] += values[i];
    };
    add(sums_can, over_can.tracking);
    add(sums_sil, sil.tracking);
  }
  for (std::size_t i = 0; i < sums_can.size(); ++i) {
    fmt::print("metric {}: can / sil = {:.4f}\n", i, sums_can[i] / sums_sil[i]);
    EXPECT_LT(std::abs(sums_can[i] / sums_sil[i] - 1.0), 0.05) << i;
  }
}

/// A fault while the robot walks, and how many bus cycles later every drive is damped, or the sit-down begins.
struct Row {
  const char* name = nullptr;
  void (*inject)(test::EmulatedRobot&) = nullptr;
  int least = 0, most = 0;  ///< bus cycles, as in docs/reference/safety.md
  faults::FaultCode code = faults::FaultCode::kNone;
  bool sits_down = false;
};

constexpr std::array kRows = {
    Row{"silent motor", [](test::EmulatedRobot& robot) { robot.drives().drive(0, 3).silent = true; }, 6, 10,
        faults::FaultCode::kBusLost},
    Row{"wrong id", [](test::EmulatedRobot& robot) { robot.drives().drive(0, 3).node = 99; }, 6, 10,
        faults::FaultCode::kBusLost},
    Row{"two motors of one id", [](test::EmulatedRobot& robot) { robot.drives().drive(0, 3).twice = true; }, 3, 7,
        faults::FaultCode::kBusLost},
    Row{"lost turn", [](test::EmulatedRobot& robot) { robot.drives().drive(0, 3).turn_rad = 0.7; }, 3, 7,
        faults::FaultCode::kBusLost},
    Row{"over-temperature in the drive",
        [](test::EmulatedRobot& robot) { robot.drives().drive(0, 3).fault = drives::DriveFault::kOverTemperature; }, 1,
        5, faults::FaultCode::kBusLost},
    Row{"under-voltage",
        [](test::EmulatedRobot& robot) { robot.drives().drive(1, 0).fault = drives::DriveFault::kUnderVoltage; }, 1, 5,
        faults::FaultCode::kBusLost},
    Row{"over-voltage",
        [](test::EmulatedRobot& robot) { robot.drives().drive(1, 0).fault = drives::DriveFault::kOverVoltage; }, 1, 5,
        faults::FaultCode::kBusLost},
    Row{"hot motor", [](test::EmulatedRobot& robot) { robot.drives().drive(0, 3).temperature_degC = 95.0; }, 1, 5,
        faults::FaultCode::kTemperature, true},
    Row{"silent IMU", [](test::EmulatedRobot& robot) { robot.drives().imu_silent = true; }, 11, 15,
        faults::FaultCode::kBusLost},
};

TEST(CanRobot, EachFaultDampsEveryDriveOrBeginsTheSitDownWithinItsCycles) {
  for (const Row& row : kRows) {
    for (const int offset : {0, 1, 2, 3, 4}) {  // between two ticks
      if (over_sockets() && offset != 2) continue;
      Stage stage(1, true);
      const int from = 1500 + offset;
      int reacted = -1;
      stage.robot->before = [&](int cycle) {
        if (cycle == from) row.inject(*stage.robot);
      };
      stage.robot->after = [&](int cycle, hal::BusStatus) {
        const bool reacts = row.sits_down ? stage.sat_down : stage.robot->limp_or_damped();
        if (reacted < 0 && cycle >= from && reacts) reacted = cycle - from;
      };
      stage.run(walking(2.0, 1.2));
      EXPECT_GE(reacted, row.least) << row.name;
      EXPECT_LE(reacted, row.most) << row.name;
      EXPECT_EQ(stage.fault, row.code) << row.name;
      if (offset != 2) continue;
      fmt::print("{}: {} {} cycles after the cause\n", row.name, row.sits_down ? "sits down" : "damped", reacted);
    }
  }
}

TEST(CanRobot, AKilledHostIsHeldByTheDrivesOwnWatchdogs) {
  Stage stage(1, true);
  int damped = -1;
  stage.robot->before = [&](int cycle) { stage.robot->frozen = cycle >= 1500; };
  stage.robot->after = [&](int cycle, hal::BusStatus) {
    if (damped < 0 && cycle >= 1500 && stage.robot->limp_or_damped()) damped = cycle - 1500;
  };
  stage.run(walking(2.0, 1.2));
  EXPECT_EQ(damped, test::DriveEmulator::kWatchdogCycles - 1) << "the tenth cycle without a frame";
}

}  // namespace
}  // namespace pmg::sil
