// A hand-written policy balances Z1 in MuJoCo on drives that are too soft to stand without it, and Z1's own policy
// walks. Sabotaged, both trip a fault.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ostream>

#include "control/control_setup.hpp"
#include "control/fixtures.hpp"
#include "sil/lockstep.hpp"
#include "sil/sil_hal.hpp"

namespace pmg::sil {
namespace {

/// Ankles that push back when the pelvis leans: residuals from the IMU's tilt and gyro.
class AnkleBalance final : public policy::Policy {
 public:
  AnkleBalance(const model::RobotModel& robot, double action_factor) : action_factor_(action_factor) {
    const Eigen::Index n = robot.joint_index.size();
    gains_ = {JointVector(n), JointVector(n)};
    for (Eigen::Index i = 0; i < n; ++i) {
      const model::Joint& joint = robot.joints[static_cast<std::size_t>(i)];
      gains_.kp_Nm_per_rad[i] = joint.kp_Nm_per_rad;
      gains_.kd_Nm_s_per_rad[i] = joint.kd_Nm_s_per_rad;
    }
    for (const char* side : {"left", "right"}) {
      const int pitch = robot.joint_index.at(std::string(side) + "_ankle_pitch");
      const int roll = robot.joint_index.at(std::string(side) + "_ankle_roll");
      pitch_joints_.push_back(pitch);
      roll_joints_.push_back(roll);
      // Both ankles together have less than half of m g h = 260 Nm/rad, so without balancing the robot falls.
      gains_.kp_Nm_per_rad[pitch] = gains_.kp_Nm_per_rad[roll] = 60.0;
      gains_.kd_Nm_s_per_rad[pitch] = gains_.kd_Nm_s_per_rad[roll] = 2.0;
    }
  }

  std::optional<policy::DriveGains> gains() const override { return gains_; }

  policy::Status act(const model::RobotState& state, const Reference& reference, const Command&,
                     JointVector& q_des) noexcept override {
    const Eigen::Matrix3d R_WI = state.orientation_WI.toRotationMatrix();
    const double pitch_rad = std::asin(std::clamp(-R_WI(2, 0), -1.0, 1.0));
    const double roll_rad = std::atan2(R_WI(2, 1), R_WI(2, 2));
    q_des = reference.q;
    for (const int joint : pitch_joints_) q_des[joint] += action(pitch_rad, state.gyro_rad_s.y());
    for (const int joint : roll_joints_) q_des[joint] += action(roll_rad, state.gyro_rad_s.x());
    return policy::Status::kOk;
  }

 private:
  double action(double lean_rad, double rate_rad_s) const noexcept {
    return action_factor_ * (kLean * lean_rad + kRate_s * rate_rad_s);
  }

  static constexpr double kLean = 4.0, kRate_s = 0.8;
  double action_factor_;
  policy::DriveGains gains_;
  std::vector<int> pitch_joints_, roll_joints_;
};

struct Outcome {
  RunOutcome lockstep;
  control::Mode mode = control::Mode::kPassive;
  model::JointCommand command;
};

Outcome play(std::unique_ptr<policy::Policy> policy, const Scenario& scenario) {
  const model::RobotModel& robot = test::z1();
  sim::WorldOptions options;
  options.seed = 3;
  options.encoder_noise_rad = 0.0004;
  options.gyro_noise_rad_s = 0.01;
  options.orientation_noise_rad = 0.002;
  sim::World world(robot, options);
  sil::SilHal bus(world);
  WorldPlant plant(world);
  const io::SimulationClock stopwatch;
  control::Tick tick(robot, test::clips(robot), std::move(policy), stopwatch, control::tick_options(robot));
  Lockstep lockstep(robot, bus, plant, tick, scenario, nullptr, {.balanced_by_policy = true});
  Outcome outcome;
  outcome.lockstep = lockstep.run();
  outcome.mode = tick.result().mode;
  outcome.command = tick.result().command;
  return outcome;
}

Outcome stand_for_10_s(std::unique_ptr<policy::Policy> policy) {
  Scenario scenario;
  scenario.name = "stand";
  scenario.steps.resize(1);
  scenario.steps[0].duration_s = 10.0;
  scenario.steps[0].mode = control::Mode::kStand;
  return play(std::move(policy), scenario);
}

Outcome stand_for_10_s(double action_factor) {
  return stand_for_10_s(std::make_unique<AnkleBalance>(test::z1(), action_factor));
}

/// Balances until one of its targets is not a number.
class BreaksDown final : public policy::Policy {
 public:
  explicit BreaksDown(int after_ticks) : left_(after_ticks) {}
  std::optional<policy::DriveGains> gains() const override { return sound_.gains(); }
  policy::Status act(const model::RobotState& state, const Reference& reference, const Command& observed,
                     JointVector& q_des) noexcept override {
    const policy::Status status = sound_.act(state, reference, observed, q_des);
    if (--left_ < 0) q_des[3] = std::numeric_limits<double>::quiet_NaN();
    return status;
  }

 private:
  AnkleBalance sound_{test::z1(), 1.0};
  int left_;
};

TEST(Sabotage, APolicyThatIsNoNumberInMidRunTripsItsFaultInThatTickAndDampsToTheEnd) {
  constexpr int kSoundTicks = 300;
  const Outcome outcome = stand_for_10_s(std::make_unique<BreaksDown>(kSoundTicks));
  ASSERT_EQ(outcome.lockstep.faults.size(), 1u) << "one fault, latched to the end";
  EXPECT_EQ(outcome.lockstep.faults[0].code, faults::FaultCode::kPolicyNotFinite);
  // Every tick asks the policy except the first ones: the robot isn't standing yet, and then its feet must carry for
  // 0.05 s.
  EXPECT_NEAR(static_cast<double>(outcome.lockstep.faults[0].stamp_ns) * 1e-9, 0.01 * kSoundTicks, 0.1);
  EXPECT_EQ(outcome.mode, control::Mode::kFault);
  EXPECT_TRUE(outcome.command.q.allFinite());
  EXPECT_EQ(outcome.command.kp.sum(), 0.0);
  EXPECT_GT(outcome.command.kd.minCoeff(), 0.0);
}

TEST(Sabotage, ThePolicyAsItIsBalances) {
  const Outcome outcome = stand_for_10_s(1.0);
  EXPECT_FALSE(outcome.lockstep.fell) << "at " << outcome.lockstep.fell_at_s << " s";
  for (const faults::Fault& fault : outcome.lockstep.faults) ADD_FAILURE() << describe(fault, test::z1());
  EXPECT_EQ(outcome.mode, control::Mode::kStand);
  EXPECT_LT(outcome.lockstep.tracking.pitch_mae_rad, 0.1);
}

struct Sabotaged {
  const char* name;
  double action_factor;
  double within_s;  ///< of the start or of the sabotage: a fall takes the time in which an unstable pendulum grows

  friend void PrintTo(const Sabotaged& row, std::ostream* out) { *out << row.name; }
};

class Sabotage : public testing::TestWithParam<Sabotaged> {};

TEST_P(Sabotage, TripsAFaultThatDampsAndStaysLatched) {
  const Outcome outcome = stand_for_10_s(GetParam().action_factor);
  ASSERT_EQ(outcome.lockstep.faults.size(), 1u) << "one fault, latched to the end";
  const faults::Fault& fault = outcome.lockstep.faults[0];
  const double fault_s = static_cast<double>(fault.stamp_ns) * 1e-9;
  EXPECT_LT(fault_s, GetParam().within_s) << describe(fault, test::z1());
  EXPECT_EQ(outcome.mode, control::Mode::kFault);
  EXPECT_EQ(outcome.command.kp.sum(), 0.0);
  EXPECT_GT(outcome.command.kd.minCoeff(), 0.0);
  RecordProperty("fault", fmt::format("{:.2f} s: {}", fault_s, describe(fault, test::z1())));
}

INSTANTIATE_TEST_SUITE_P(Actions, Sabotage,
                         testing::Values(Sabotaged{"TimesFive", 5.0, 1.0}, Sabotaged{"Negated", -1.0, 1.5},
                                         Sabotaged{"Zero", 0.0, 3.0}),
                         [](const auto& row) { return std::string(row.param.name); });

/// Z1's policy; from some tick on its actions are multiplied and clamped to its network's range.
class GoesWild final : public policy::Policy {
 public:
  GoesWild(std::unique_ptr<policy::Policy> sound, double action_factor, int after_ticks)
      : sound_(std::move(sound)), action_factor_(action_factor), left_(after_ticks) {}
  std::optional<policy::DriveGains> gains() const override { return sound_->gains(); }
  std::optional<double> action_bound_rad() const override { return sound_->action_bound_rad(); }
  void reset() noexcept override { sound_->reset(); }
  void unsent() noexcept override { sound_->unsent(); }
  policy::Status act(const model::RobotState& state, const Reference& reference, const Command& observed,
                     JointVector& q_des) noexcept override {
    const policy::Status status = sound_->act(state, reference, observed, q_des);
    if (--left_ >= 0) return status;
    const double clamp_rad = *sound_->action_bound_rad() / 0.95;  // docs/reference/file-formats.md: action_limit
    q_des = reference.q + (action_factor_ * (q_des - reference.q)).cwiseMax(-clamp_rad).cwiseMin(clamp_rad);
    return status;
  }

 private:
  std::unique_ptr<policy::Policy> sound_;
  double action_factor_;
  int left_;
};

class WalkingSabotage : public testing::TestWithParam<Sabotaged> {};

TEST_P(WalkingSabotage, IsDampedBeforeTheRobotHasGoneFar) {
  constexpr double kSpoiltAt_s = 3.0;
  control::ControlSetup setup;
  setup.policy = "pmg";
  Scenario scenario;
  scenario.name = "walk";
  scenario.steps.resize(2);
  scenario.steps[0].duration_s = scenario.steps[1].start_s = 1.5;
  scenario.steps[0].mode = control::Mode::kStand;
  scenario.steps[1].duration_s = 4.5;
  scenario.steps[1].mode = control::Mode::kWalk;
  scenario.steps[1].command[kVx] = 0.5;
  control::LoadedControl loaded = control::load_control(setup);
  const Outcome outcome =
      play(std::make_unique<GoesWild>(std::move(loaded.policy), GetParam().action_factor, 300), scenario);
  ASSERT_EQ(outcome.lockstep.faults.size(), 1u) << "one fault, latched to the end";
  const faults::Fault& fault = outcome.lockstep.faults[0];
  const double after_s = static_cast<double>(fault.stamp_ns) * 1e-9 - kSpoiltAt_s;
  EXPECT_GT(after_s, 0.0) << "it walked until then";
  EXPECT_LT(after_s, GetParam().within_s) << describe(fault, test::z1());
  EXPECT_EQ(outcome.mode, control::Mode::kFault);
  EXPECT_EQ(outcome.command.kp.sum(), 0.0);
  RecordProperty("fault", fmt::format("after {:.2f} s: {}", after_s, describe(fault, test::z1())));
}

// docs/reference/safety.md has the measured times. Twice the median is allowed, because they depend on the moment in
// the gait.
INSTANTIATE_TEST_SUITE_P(Actions, WalkingSabotage,
                         testing::Values(Sabotaged{"TimesFive", 5.0, 1.82}, Sabotaged{"Negated", -1.0, 0.8},
                                         Sabotaged{"Zero", 0.0, 2.0}),
                         [](const auto& row) { return std::string(row.param.name); });

}  // namespace
}  // namespace pmg::sil
