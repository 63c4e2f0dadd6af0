// Z1 keeps its balance while an operator leads its arms: docs/how-to/operation.md says how far and how fast, and has
// this test's figures over more robots (PMG_CAMPAIGN_ROBOTS).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <tuple>

#include "arms/arm_chain.hpp"
#include "arms/collision_bodies.hpp"
#include "sil/varied_robot.hpp"

namespace pmg::sil {
namespace {

using control::ArmTarget;
using test::kTick_s;

enum class Leading { kCircles, kReaches, kSwings };
constexpr const char* kLeadingNames[] = {"Circles", "Reaches", "Swings"};

/// What an operator's hands do: one target for each palm a tick.
class LeadingHands {
 public:
  LeadingHands(const model::RobotModel& robot, const arms::ArmSetup& setup, Leading leading, std::uint64_t seed)
      : robot_(robot),
        chains_{arms::ArmChain(setup.palm[kLeft], arms::link_shapes(robot)),
                arms::ArmChain(setup.palm[kRight], arms::link_shapes(robot))},
        leading_(leading),
        random_(seed) {}

  arms::PerArm<ArmTarget> at(double time_s) {
    const auto turn = static_cast<std::int64_t>(std::floor(time_s / period_s()));
    if (turn != turn_) {
      turn_ = turn;
      for (const Foot side : {kLeft, kRight}) now_[side] = {.wish = control::ArmWish::kAim, .palm = next(side)};
      center_ = now_;
    }
    if (leading_ == Leading::kCircles) {
      const double angle_rad = 2.0 * std::numbers::pi * time_s / kCircle_s;
      const Eigen::Vector3d way(std::cos(angle_rad), 0.0, std::sin(angle_rad));
      for (const Foot side : {kLeft, kRight}) now_[side].palm.p_m = center_[side].palm.p_m + kCircle_m * way;
    }
    return now_;
  }

 private:
  static constexpr double kCircle_m = 0.15, kCircle_s = 1.0;  ///< 0.94 m/s: nearly the pose filter's bound
  double period_s() const {
    switch (leading_) {
      case Leading::kCircles:
        return 1e3;
      case Leading::kReaches:
        return 1.0;
      case Leading::kSwings:
        return 0.5;
    }
    return 1.0;
  }
  arms::PalmPose next(Foot side) {
    const std::vector<int>& joints = chains_[side].joints();
    arms::ArmVector q(static_cast<Eigen::Index>(joints.size()));
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      const int joint = joints[static_cast<std::size_t>(i)];
      const double stand = robot_.q_stand()[joint], lower = robot_.q_lower()[joint], upper = robot_.q_upper()[joint];
      q[i] = stand;
      if (leading_ == Leading::kReaches) {
        q[i] = std::uniform_real_distribution<double>(lower, upper)(random_);
      } else if (i == 0) {  // the shoulder's pitch: both arms up in front, and back, together
        q[i] += ((leading_ == Leading::kCircles || turn_ % 2 == 0 ? lower : upper) - stand) *
                (leading_ == Leading::kCircles ? 0.4 : 1.0);
      }
    }
    chains_[side].compute(q);
    return chains_[side].palm();
  }

  const model::RobotModel& robot_;
  arms::PerArm<arms::ArmChain> chains_;
  Leading leading_;
  std::mt19937_64 random_;
  std::int64_t turn_ = -1;
  arms::PerArm<ArmTarget> now_, center_;
};

/// A campaign, of which the page tells, takes longer than a test has time for.
const double kLed_s = test::campaign_robots(0) > 0 ? 10.0 : 6.0;

struct Balance {
  bool fell = false;
  double fell_at_s = -1.0;
  double fastest_rad_s = 0.0;  ///< of an arm joint's reference
  double farthest_m = 0.0;     ///< of a palm from where it was when it was taken over
  double largest_step_rad = 0.0;
  std::string fault;
};

Balance lead(std::uint64_t seed, Leading leading, const Command& command) {
  test::VariedRobot it(seed);
  test::ScriptedOperator driver;
  driver.then(1.5, control::Mode::kStand).then(2.0, control::Mode::kWalk, command);
  driver.then(kLed_s, control::Mode::kWalk, command).then(1.0, control::Mode::kStand);
  Lockstep lockstep(it.robot, it.drives, it.plant, *it.tick, driver.scenario, nullptr, {.balanced_by_policy = true});
  LeadingHands hands(it.robot, *it.loaded.options.arms, leading, seed);
  lockstep.lead_arms = [&](double time_s) -> std::optional<arms::PerArm<ArmTarget>> {
    if (time_s < 3.5 || time_s >= 3.5 + kLed_s) return std::nullopt;
    return hands.at(time_s - 3.5);
  };
  Balance balance;
  JointVector before;
  std::optional<arms::PerArm<arms::PalmPose>> first;
  lockstep.after_record = [&](const control::TickRecord& record) {
    const control::TickResult& result = record.result;
    if (!control::led(result.arms)) return;
    if (!first) first = {result.arms.arm[kLeft].palm, result.arms.arm[kRight].palm};
    for (const Foot side : {kLeft, kRight}) {
      balance.farthest_m = std::max(balance.farthest_m, (result.arms.arm[side].palm.p_m - (*first)[side].p_m).norm());
      for (const int joint : it.loaded.options.arms->palm[side].joints) {
        balance.fastest_rad_s = std::max(balance.fastest_rad_s, std::abs(result.reference.dq[joint]));
        if (before.size() > 0) {
          const double step_rad = std::abs(result.command.q[joint] - before[joint]);
          balance.largest_step_rad = std::max(balance.largest_step_rad, step_rad);
        }
      }
    }
    before = result.command.q;
  };
  const RunOutcome outcome = lockstep.run();
  balance.fell = outcome.fell || outcome.diverged;
  balance.fell_at_s = outcome.fell_at_s;
  if (!outcome.faults.empty()) balance.fault = describe(outcome.faults.front(), it.robot);
  return balance;
}

struct Way {
  const char* name;
  Command command;
};
const Way kWays[] = {
    {"OnTheSpot", {}}, {"Forward", {{0.5, 0.0, 0.0, 0.0, 0.0, 0.0}}}, {"Turning", {{0.2, 0.0, 0.5, 0.0, 0.0, 0.0}}}};

class LedArmsBalance : public testing::TestWithParam<std::tuple<Leading, Way>> {};

TEST_P(LedArmsBalance, AsFarAsTheyReachAndAsFastAsTheyMayNoRobotFalls) {
  const auto& [leading, way] = GetParam();
  const double speed_rad_s = arms::read_arm_setup(test::z1())->speed_rad_s;
  const std::uint64_t robots = test::campaign_robots(5), first = test::campaign_first();
  double farthest_m = 0.0, fastest_rad_s = 0.0;
  for (std::uint64_t seed = first; seed < first + robots; ++seed) {
    SCOPED_TRACE(seed);
    const Balance balance = lead(seed, leading, way.command);
    EXPECT_FALSE(balance.fell) << "at " << balance.fell_at_s << " s";
    EXPECT_EQ(balance.fault, "");
    EXPECT_LE(balance.largest_step_rad, speed_rad_s * kTick_s + 1e-9);
    farthest_m = std::max(farthest_m, balance.farthest_m);
    fastest_rad_s = std::max(fastest_rad_s, balance.fastest_rad_s);
  }
  fmt::print("{} robots: palms up to {:.2f} m from where the gait has them, arm joints at up to {:.2f} rad/s\n", robots,
             farthest_m, fastest_rad_s);
  EXPECT_GT(farthest_m, 0.5) << "arms that hardly moved prove nothing";
  EXPECT_NEAR(fastest_rad_s, speed_rad_s, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Arms, LedArmsBalance,
                         testing::Combine(testing::Values(Leading::kCircles, Leading::kReaches, Leading::kSwings),
                                          testing::ValuesIn(kWays)),
                         [](const auto& row) {
                           return std::string(kLeadingNames[static_cast<int>(std::get<0>(row.param))]) +
                                  std::get<1>(row.param).name;
                         });

}  // namespace
}  // namespace pmg::sil
