// Stalls of the host on a robot whose physics go on: which ones Z1 stands, on its feet and walking. The drives hold
// their last targets, and brake by themselves after 0.1 s.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "sil/failing_parts.hpp"
#include "sil/varied_robot.hpp"

namespace pmg::sil {
namespace {

struct Stalled {
  bool fell = false;
  faults::FaultCode fault = faults::FaultCode::kNone;
  control::Mode mode = control::Mode::kPassive;
};

/// (robot, stall of both threads) => (3 s later). With the limits of a robot's bus.
Stalled after_stall(std::uint64_t seed, double stall_s, bool walks) {
  std::mt19937_64 random(seed + 77);
  const double at_s = 4.0 + 1.2 * static_cast<double>(random() >> 11) * 0x1p-53;  // at any phase of the gait
  test::VariedRobot it(seed);
  FailureClock clock;
  FailingBus bus(it.drives, {{.kind = FailureKind::kStall, .at_s = at_s, .for_s = stall_s}}, it.robot, clock, false);
  test::ScriptedOperator driver;
  driver.then(1.5, control::Mode::kStand);
  driver.then(at_s + stall_s + 3.0 - 1.5, walks ? control::Mode::kWalk : control::Mode::kStand,
              Command{{0.4, 0.0, 0.0, 0.0, 0.0, 0.0}});
  Lockstep lockstep(it.robot, bus, it.plant, *it.tick, driver.scenario, nullptr, {.balanced_by_policy = true});
  lockstep.bus_sleeps = [&] { return bus.bus_sleeps(); };
  lockstep.control_sleeps = [&] { return bus.control_sleeps(); };
  lockstep.while_bus_sleeps = [&] { bus.idle(); };
  const RunOutcome outcome = lockstep.run();
  return {.fell = outcome.fell,
          .fault = outcome.faults.empty() ? faults::FaultCode::kNone : outcome.faults[0].code,
          .mode = it.tick->result().mode};
}

class RobotStall : public testing::TestWithParam<bool> {};

TEST_P(RobotStall, OfUpToFiftyMillisecondsIsStoodByEveryRobot) {
  const bool walks = GetParam();
  const bool campaign = test::campaign_robots(0) > 0;
  const std::uint64_t robots = test::campaign_robots(2);
  const std::vector<double> lengths_s =
      campaign ? std::vector<double>{0.03, 0.05, 0.08, 0.1, 0.15, 0.2, 0.25, 0.5, 1.0} : std::vector<double>{0.05};
  for (const double stall_s : lengths_s) {
    std::uint64_t stood = 0;
    for (std::uint64_t seed = 1; seed <= robots; ++seed) {
      const Stalled it = after_stall(seed, stall_s, walks);
      const bool well = !it.fell && it.fault == faults::FaultCode::kNone;
      stood += well ? 1 : 0;
      EXPECT_TRUE(well || stall_s > 0.05) << "robot " << seed << ", " << to_string(it.fault);
    }
    fmt::print("{}, stall of {:g} s: {} of {} go on\n", walks ? "walking" : "standing", stall_s, stood, robots);
  }
}

INSTANTIATE_TEST_SUITE_P(Postures, RobotStall, testing::Bool(),
                         [](const auto& row) { return std::string(row.param ? "Walking" : "Standing"); });

}  // namespace
}  // namespace pmg::sil
