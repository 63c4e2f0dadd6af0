// Z1's own policy in MuJoCo: lifted, set down, dropped, with dead torque readings. Each row of the table in
// docs/reference/safety.md about feet that carry nothing.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <utility>

#include "control/control_setup.hpp"
#include "control/fixtures.hpp"
#include "folders.hpp"
#include "sil/lockstep.hpp"
#include "sil/sil_hal.hpp"
#include "sil/simulated_robot.hpp"
#include "sim/variation.hpp"

namespace pmg::sil {
namespace {

using test::kTick_s;
constexpr double kLift_m = 0.20;

/// Counts the calls whose targets were sent, and measures the first step of each time that it gets the drives.
class CountedPolicy final : public policy::Policy {
 public:
  CountedPolicy(std::unique_ptr<policy::Policy> own, int& calls, double& first_step_rad)
      : own_(std::move(own)), calls_(calls), first_step_rad_(first_step_rad) {}
  Variant variant() const override { return own_->variant(); }
  std::optional<policy::DriveGains> gains() const override { return own_->gains(); }
  std::optional<double> action_bound_rad() const override { return own_->action_bound_rad(); }
  bool needs_ground() const override { return own_->needs_ground(); }
  void reset() noexcept override { own_->reset(); }
  void unsent() noexcept override {
    --calls_;
    was_unsent_ = true;
    step_rad_ = 0.0;
    own_->unsent();
  }
  policy::Status act(const model::RobotState& state, const Reference& reference, const Command& observed,
                     JointVector& q_des) noexcept override {
    ++calls_;
    first_step_rad_ = std::max(first_step_rad_, step_rad_);  // of the call before, if nobody said that it was unsent
    const policy::Status status = own_->act(state, reference, observed, q_des);
    step_rad_ = std::exchange(was_unsent_, false) ? (q_des - reference.q).cwiseAbs().maxCoeff() : 0.0;
    return status;
  }

 private:
  std::unique_ptr<policy::Policy> own_;
  int& calls_;
  double& first_step_rad_;
  bool was_unsent_ = false;
  double step_rad_ = 0.0;
};

/// Drives whose torque readings are zero from some time on.
class DeadTorques final : public hal::Hal {
 public:
  DeadTorques(hal::Hal& bus, double from_s) : bus_(bus), from_ns_(static_cast<std::int64_t>(from_s * 1e9)) {}
  hal::BusStatus exchange(const model::JointCommand& command, model::RobotState& state) noexcept override {
    const hal::BusStatus status = bus_.exchange(command, state);
    if (state.stamp_ns >= from_ns_) state.tau.setZero();
    return status;
  }

 private:
  hal::Hal& bus_;
  std::int64_t from_ns_;
};

/// Observations of one tick.
struct Seen {
  double time_s;
  control::Mode mode;
  bool hanging;
  int policy_calls;     ///< since the start
  double carried;       ///< true load of the feet, as a share of the weight
  double farthest_rad;  ///< largest distance of a joint from its reference
  double most_torque;   ///< largest torque of a joint, as a share of its effort limit
  double moved_rad;     ///< largest step of a target since the last tick
  double pelvis_m, walk_gain;
};

/// The rope's state at a time: height of the torso above standing, and share of its stiffness.
struct Rope {
  double lift_m = 0.0, engaged = 0.0;
};
using RopeAt = std::function<Rope(double time_s)>;

double ramp(double time_s, double from_s, double for_s) {
  const double t = std::clamp((time_s - from_s) / for_s, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// Tightens within 0.3 s, lifts within up_s, and later goes back.
RopeAt lifted_between(double from_s, double to_s, double up_s = 1.0) {
  return [=](double t) {
    const double up = ramp(t, from_s + 0.3, up_s) - ramp(t, to_s, 1.5);
    return Rope{kLift_m * up, std::clamp((t - from_s) / 0.3, 0.0, 1.0) * (1.0 - ramp(t, to_s + 1.6, 0.5))};
  };
}

struct Step {
  double from_s;
  control::Mode mode;
  Command command{};
};

Scenario scenario_of(const std::vector<Step>& steps, double end_s) {
  Scenario scenario;
  scenario.name = "hanging";
  for (std::size_t i = 0; i < steps.size(); ++i) {
    ScenarioStep step;
    step.start_s = steps[i].from_s;
    step.duration_s = (i + 1 < steps.size() ? steps[i + 1].from_s : end_s) - steps[i].from_s;
    step.mode = steps[i].mode;
    step.command = steps[i].command;
    scenario.steps.push_back(step);
  }
  return scenario;
}

struct Ride {
  std::vector<Seen> seen;
  RunOutcome outcome;
  double first_step_rad = 0.0;  ///< the policy's largest, of each time that it gets the drives

  bool stands() const {
    return !outcome.fell && outcome.faults.empty() && seen.back().mode == control::Mode::kStand && !seen.back().hanging;
  }
  template <typename Of>
  double most(double from_s, double to_s, Of&& of) const {
    double most = 0.0;
    for (const Seen& tick : seen) {
      if (tick.time_s >= from_s && tick.time_s < to_s) most = std::max(most, of(tick));
    }
    return most;
  }
  /// The first tick from from_s on of which this holds [s]; 1e9: none.
  template <typename Holds>
  double first(double from_s, Holds&& holds) const {
    for (const Seen& tick : seen) {
      if (tick.time_s >= from_s && holds(tick)) return tick.time_s;
    }
    return 1e9;
  }
  /// The first tick from from_s on after which the feet carry less than a tenth of the weight for 0.1 s.
  double lifted_at(double from_s) const {
    int ticks = 0;
    for (const Seen& tick : seen) {
      if (tick.time_s < from_s) continue;
      ticks = tick.carried < 0.1 ? ticks + 1 : 0;
      if (ticks == 10) return tick.time_s - 0.09;
    }
    return 1e9;
  }
  std::string told() const {
    std::string text = fmt::format("mode {}, {}, fell {} at {:.2f} s", to_string(seen.back().mode),
                                   seen.back().hanging ? "hanging" : "not hanging", outcome.fell, outcome.fell_at_s);
    for (const faults::Fault& fault : outcome.faults) {
      text += fmt::format("; {:.2f} s {}", static_cast<double>(fault.stamp_ns) * 1e-9, describe(fault, test::z1()));
    }
    return text;
  }
};

struct RideOptions {
  std::uint64_t seed = 0;  ///< 0: the nominal robot; else drawn from config/evaluation/variation.yaml
  std::string policy = "pmg";
  double torques_dead_from_s = 1e9;
};

Ride ride(const Scenario& scenario, const RopeAt& rope, const RideOptions& options = {}) {
  control::ControlSetup setup;
  setup.policy = options.policy;
  control::LoadedControl loaded = control::load_control(setup);
  const model::RobotModel& robot = loaded.robot;
  int calls = 0;
  Ride ride;
  loaded.policy = std::make_unique<CountedPolicy>(std::move(loaded.policy), calls, ride.first_step_rad);
  sim::WorldOptions world_options = world_with_noise(options.seed, false);
  if (options.seed > 0) {
    static const sim::VariationRanges ranges = sim::load_variation_ranges(
        std::filesystem::path(pmg::test::project_folder()) / "config/evaluation/variation.yaml");
    sim::vary(world_options, ranges, robot, options.seed);
  }
  sim::World world(robot, world_options);
  sil::SilHal drives(world);
  DeadTorques bus(drives, options.torques_dead_from_s);
  WorldPlant plant(world);
  const io::SimulationClock stopwatch;
  const std::unique_ptr<control::Tick> tick = control::make_tick(loaded, stopwatch);
  Lockstep lockstep(robot, bus, plant, *tick, scenario, nullptr, {.balanced_by_policy = true});
  JointVector effort_Nm(robot.joint_index.size());
  for (Eigen::Index i = 0; i < effort_Nm.size(); ++i) {
    effort_Nm[i] = robot.joints[static_cast<std::size_t>(i)].effort_limit_Nm;
  }
  JointVector target;
  const auto pull = [&](double time_s) {
    const Rope now = rope(time_s);
    world.set_hoist(now.lift_m, now.engaged);
  };
  lockstep.after_record = [&](const control::TickRecord& record) {
    const control::TickResult& result = record.result;
    const model::GroundTruth truth = world.truth();
    const double weight_N = robot.total_mass_kg * 9.81;
    const model::RobotState& state = record.state;
    ride.seen.push_back({.time_s = static_cast<double>(record.tick) * kTick_s,
                         .mode = result.mode,
                         .hanging = control::hanging(result.maker),
                         .policy_calls = calls,
                         .carried = (truth.foot_force_N[0] + truth.foot_force_N[1]) / weight_N,
                         .farthest_rad = (state.q - result.reference.q).cwiseAbs().maxCoeff(),
                         .most_torque = state.tau.cwiseAbs().cwiseQuotient(effort_Nm).maxCoeff(),
                         .moved_rad = target.size() == 0 ? 0.0 : (result.command.q - target).cwiseAbs().maxCoeff(),
                         .pelvis_m = truth.p_WB.z(),
                         .walk_gain = result.reference.gain});
    target = result.command.q;
  };
  lockstep.after_tick = [&](const RunProgress& now) { pull(now.time_s); };
  pull(0.0);
  ride.outcome = lockstep.run();
  return ride;
}

/// A walk at any speed from which a robot is lifted at any phase of the gait.
struct Lift {
  double at_s = 0.0, down_s = 0.0, end_s = 0.0;
  Ride ride;
};

/// held_s: on the hoist; stood_s: after that.
Lift lift_in_mid_walk(std::uint64_t seed, double held_s, double stood_s) {
  std::mt19937_64 random(seed);
  const auto draw = [&random](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  const double lift_s = draw(4.0, 5.0), down_s = lift_s + held_s, end_s = down_s + stood_s;
  const Command command{{draw(-0.3, 0.8), draw(-0.2, 0.2), draw(-0.5, 0.5), 0.0, 0.0, 0.0}};
  return {lift_s, down_s, end_s,
          ride(scenario_of({{0.0, control::Mode::kStand},
                            {1.5, control::Mode::kWalk, command},
                            {down_s - 0.5, control::Mode::kStand}},
                           end_s),
               lifted_between(lift_s, down_s, draw(0.4, 1.2)), {.seed = seed})};
}

/// From clear feet until the robot hangs.
double seen_after_s(const Lift& lift) {
  return lift.ride.first(lift.at_s, [](const Seen& tick) { return tick.hanging; }) - lift.ride.lifted_at(lift.at_s);
}

/// docs/reference/safety.md: 97 of 100 robots.
TEST(RobotsLiftedInMidWalk, AreSeenToHangWithinAQuarterOfASecondButForOneOfTwenty) {
  int late = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) late += seen_after_s(lift_in_mid_walk(seed, 1.6, 0.0)) >= 0.25;
  EXPECT_LE(late, 1);
}

class LiftedInMidWalk : public testing::TestWithParam<std::uint64_t> {};

TEST_P(LiftedInMidWalk, HangsStillInItsStandingPostureAndStandsWhenItIsSetDown) {
  const Lift lift = lift_in_mid_walk(GetParam(), 4.0, 6.0);
  const Ride& it = lift.ride;
  const double lift_s = lift.at_s, down_s = lift.down_s, end_s = lift.end_s;

  const double clear_s = it.lifted_at(lift_s);
  ASSERT_LT(clear_s, down_s - 2.0) << it.told();
  EXPECT_EQ(it.most(0.3, lift_s, [](const Seen& tick) { return tick.hanging ? 1.0 : 0.0; }), 0.0)
      << "on its feet it is never taken for a robot that hangs";
  const double seen_s = seen_after_s(lift);
  EXPECT_LT(seen_s, 0.6) << "docs/reference/safety.md";
  const auto all_hang = [](const Seen& tick) { return tick.hanging ? 0.0 : 1.0; };
  EXPECT_EQ(it.most(clear_s + 1.0, down_s, all_hang), 0.0);
  const double off_rad = it.most(clear_s + 1.0, down_s, [](const Seen& tick) { return tick.farthest_rad; });
  EXPECT_LT(off_rad, 0.1) << "joints near their reference from 1 s after lifting";
  EXPECT_EQ(it.most(clear_s + 1.0, down_s, [](const Seen& tick) { return tick.walk_gain; }), 0.0);
  EXPECT_EQ(
      it.most(clear_s + 1.0, down_s, [](const Seen& tick) { return tick.mode == control::Mode::kStand ? 0.0 : 1.0; }),
      0.0);
  EXPECT_LE(it.most(lift_s, end_s, [](const Seen& tick) { return tick.most_torque; }), 1.0 + 1e-9);
  const double torque = it.most(clear_s + 1.0, down_s, [](const Seen& tick) { return tick.most_torque; });
  EXPECT_LT(torque, 0.3) << "it holds its own legs and no more";
  EXPECT_TRUE(it.stands()) << it.told();
  EXPECT_GT(it.first_step_rad, 0.0);
  EXPECT_LT(it.first_step_rad, 0.5 * control::RehearsalOptions{}.largest_step_rad) << "far from being refused";
  RecordProperty("figures",
                 fmt::format("lifted {:.2f} s, seen {:.2f} s later, {:.3f} rad, torque {:.2f}, first step {:.3f} rad",
                             clear_s, seen_s, off_rad, torque, it.first_step_rad));
}

INSTANTIATE_TEST_SUITE_P(Robots, LiftedInMidWalk, testing::Range<std::uint64_t>(1, 21));

TEST(Hanging, ALimpRobotInTheHoistStandsUpWithoutItsPolicyWhichBeginsOnTheGround) {
  constexpr double kStand_s = 2.0, kDown_s = 6.0, kEnd_s = 11.0;
  const auto rope = lifted_between(-5.0, kDown_s);
  const Ride it = ride(scenario_of({{0.0, control::Mode::kPassive}, {kStand_s, control::Mode::kStand}}, kEnd_s), rope);
  int calls_in_the_air = 0;
  for (const Seen& tick : it.seen) {
    if (tick.time_s < kDown_s) calls_in_the_air = tick.policy_calls;
  }
  EXPECT_EQ(calls_in_the_air, 0);
  EXPECT_LT(it.most(kDown_s - 1.0, kDown_s, [](const Seen& tick) { return tick.farthest_rad; }), 0.1);
  EXPECT_GT(it.seen.back().policy_calls, 100);
  EXPECT_TRUE(it.stands()) << it.told();
}

TEST(Hanging, OnTheGantryItStandsWhateverItIsAsked) {
  const Ride it = ride(scenario_of({{0.0, control::Mode::kWalk, Command{{0.5, 0.0, 0.2, 0.0, 0.0, 0.0}}}}, 8.0),
                       lifted_between(-5.0, 100.0));
  EXPECT_EQ(it.seen.back().policy_calls, 0);
  EXPECT_EQ(it.seen.back().mode, control::Mode::kStand);
  EXPECT_TRUE(it.seen.back().hanging);
  EXPECT_EQ(it.most(0.0, 8.0, [](const Seen& tick) { return tick.walk_gain; }), 0.0);
  EXPECT_LT(it.most(2.0, 8.0, [](const Seen& tick) { return tick.most_torque; }), 0.3);
  EXPECT_TRUE(it.outcome.faults.empty()) << it.told();
}

TEST(Hanging, WithoutAPolicyItWalksInTheAirAsInAFirstStart) {
  const Ride it = ride(scenario_of({{0.0, control::Mode::kWalk, Command{{0.5, 0.0, 0.0, 0.0, 0.0, 0.0}}}}, 6.0),
                       lifted_between(-5.0, 100.0), {.policy = "none"});
  EXPECT_EQ(it.seen.back().mode, control::Mode::kWalk);
  EXPECT_FALSE(it.seen.back().hanging);
  EXPECT_GT(it.seen.back().walk_gain, 0.5);
}

TEST(Hanging, SetDownWhileDampedItStandsUpWithItsPolicy) {
  constexpr double kDown_s = 2.0;
  // Set down at once, and held upright until it stands.
  const auto rope = [](double t) { return Rope{kLift_m * (1.0 - ramp(t, kDown_s, 1.5)), 1.0 - ramp(t, 8.0, 0.5)}; };
  const Ride it = ride(scenario_of({{0.0, control::Mode::kDamping}, {4.0, control::Mode::kStand}}, 11.0), rope);
  EXPECT_GT(it.seen.back().policy_calls, 200);
  EXPECT_TRUE(it.stands()) << it.told();
}

TEST(Hanging, DroppedFromAHandsBreadthItsPolicyCatchesIt) {
  constexpr double kDrop_s = 5.0;
  const auto rope = [](double t) { return t < kDrop_s ? Rope{0.07, 1.0} : Rope{}; };  // 0.05 m: the rope sags by 0.02
  const Ride it = ride(scenario_of({{0.0, control::Mode::kStand}}, 10.0), rope);
  EXPECT_EQ(it.most(2.0, kDrop_s, [](const Seen& tick) { return tick.hanging ? 0.0 : 1.0; }), 0.0);
  const int calls = it.seen[static_cast<std::size_t>(kDrop_s / kTick_s)].policy_calls;
  const double down_s = it.first(kDrop_s, [](const Seen& tick) { return tick.carried > 0.1; });
  const double back_s = it.first(kDrop_s, [&](const Seen& tick) { return tick.policy_calls > calls; });
  EXPECT_LE(back_s - down_s, 0.1 + 1e-9) << "docs/reference/safety.md";
  RecordProperty("back_s", fmt::format("{:.2f}", back_s - down_s));
  EXPECT_TRUE(it.stands()) << it.told();
}

TEST(Hanging, TorqueReadingsThatVanishTakeNoPolicyFromARobotThatWalks) {
  const Ride it = ride(scenario_of({{0.0, control::Mode::kStand},
                                    {1.5, control::Mode::kWalk, Command{{0.5, 0.0, 0.0, 0.0, 0.0, 0.0}}},
                                    {8.0, control::Mode::kStand}},
                                   10.0),
                       [](double) { return Rope{}; }, {.torques_dead_from_s = 4.0});
  EXPECT_EQ(it.most(1.0, 10.0, [](const Seen& tick) { return tick.hanging ? 1.0 : 0.0; }), 0.0);
  EXPECT_TRUE(it.stands()) << it.told();
}

TEST(Hanging, WithoutTorqueReadingsItIsTakenUpAndSetDownAllTheSame) {
  const Ride it =
      ride(scenario_of({{0.0, control::Mode::kStand}}, 12.0), lifted_between(3.0, 7.0), {.torques_dead_from_s = 1.0});
  EXPECT_EQ(it.most(5.5, 7.0, [](const Seen& tick) { return tick.hanging ? 0.0 : 1.0; }), 0.0);
  EXPECT_TRUE(it.stands()) << it.told();
}

TEST(Hanging, NeitherChangeOverThrowsATarget) {
  const Command forward{{0.6, 0.0, 0.0, 0.0, 0.0, 0.0}};
  const Ride it = ride(
      scenario_of({{0.0, control::Mode::kStand}, {1.5, control::Mode::kWalk, forward}, {6.0, control::Mode::kStand}},
                  11.0),
      lifted_between(4.0, 7.0));
  double at_changes_rad = 0.0;
  int changes = 0;
  for (std::size_t i = 100; i < it.seen.size(); ++i) {
    if (it.seen[i].hanging == it.seen[i - 1].hanging) continue;
    ++changes;
    at_changes_rad = std::max(at_changes_rad, it.seen[i].moved_rad);
  }
  EXPECT_EQ(changes, 2);
  // A ramp of 0.2 s moves a target by 0.7 % of its way in the first tick, and the way is a few radians at most.
  EXPECT_LT(at_changes_rad, 0.02);
  EXPECT_TRUE(it.stands()) << it.told();
}

}  // namespace
}  // namespace pmg::sil
