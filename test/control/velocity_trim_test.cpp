// What a robot does, by its legs; and what is added to its command until it does what it was asked for.
#include "control/velocity_trim.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "control/fixtures.hpp"
#include "gco/motion_composition.hpp"

namespace pmg::control {
namespace {

const model::RobotModel& z1() { return test::z1(); }

/// A robot whose joints do exactly what a motion tells them, and which moves as the ground-aware optimisation says.
class PerfectWalker {
 public:
  explicit PerfectWalker(double heading_rad = 0.0)
      : heading_rad_(heading_rad), state_(test::standing_state(z1())), attitude_(z1()) {}

  void step(const Command& user, const std::array<double, kVelocityChannels>& correction = {}) {
    motion_.set_correction(correction);
    const Reference& reference = motion_.advance(user, test::kTick_s);
    const Command& does = motion_.ground().command;
    state_.q = reference.q;
    state_.dq = reference.dq;
    const auto base = attitude_.compute(reference.q, reference.dq, reference.command[kPitch], reference.command[kRoll],
                                        reference.command_rate[kPitch], reference.command_rate[kRoll]);
    heading_rad_ += does[kOmega] * test::kTick_s;
    const Eigen::Matrix3d R_LI = z1().imu.T_LI.linear();  // Z1's IMU is in its base link
    state_.orientation_WI = Eigen::AngleAxisd(heading_rad_, Eigen::Vector3d::UnitZ()) * base.R_HB * R_LI;
    const Eigen::Vector3d omega_H = base.omega_HB_H + does[kOmega] * Eigen::Vector3d::UnitZ();
    state_.gyro_rad_s = R_LI.transpose() * base.R_HB.transpose() * omega_H;
  }

  const model::RobotState& state() const { return state_; }
  const Reference& reference() const { return motion_.reference(); }
  Command does() { return motion_.ground().command; }

 private:
  double heading_rad_;
  model::RobotState state_;
  model::BaseAttitude attitude_;
  gco::MotionComposition motion_{z1(), test::clips(z1()), Variant::kPmg, gco::generator_options(z1())};
};

TEST(LegOdometry, MeasuresWhatTheGroundAwareOptimisationFinds) {
  for (const Command& user : {Command{{0.5}}, Command{{0.0, 0.2}}, Command{{0.2, 0.1, 0.4, 0.1, 0.05, -0.03}}}) {
    PerfectWalker walker(2.0);
    LegOdometry odometry(z1());
    double largest = 0.0, moved = 0.0;
    for (int k = 0; k < 400; ++k) {
      walker.step(user);
      const Reference& reference = walker.reference();
      if (k < 200 || reference.contact_weight[kLeft] * reference.contact_weight[kRight] > 0.0) continue;
      const auto measured = odometry.velocity_H(walker.state(), reference.contact_weight);
      ASSERT_TRUE(measured.has_value());
      for (std::size_t c = 0; c < kVelocityChannels; ++c) {
        largest = std::max(largest, std::abs((*measured)[c] - walker.does().u[c]));
        moved = std::max(moved, std::abs((*measured)[c]));
      }
    }
    EXPECT_GT(moved, 0.15);
    EXPECT_LT(largest, 0.01) << user[kVx] << ' ' << user[kVy] << ' ' << user[kOmega];
  }
}

TEST(LegOdometry, InTheAirAndOfABrokenStateThereIsNone) {
  LegOdometry odometry(z1());
  model::RobotState state = test::standing_state(z1());
  EXPECT_FALSE(odometry.velocity_H(state, {0.0, 0.0}).has_value());
  EXPECT_TRUE(odometry.velocity_H(state, {1.0, 0.0}).has_value());
  state.dq[z1().leg_joints[kLeft][0]] = test::kNan;
  EXPECT_FALSE(odometry.velocity_H(state, {1.0, 0.0}).has_value());
}

VelocityTrim trim_of(const VelocityTrimOptions& options) {
  return {z1(), options, GeneratorOptions{}.double_support_rate, test::kTick_s};
}

/// A robot that does this share of what is asked of its clips, for so long: (the trim, what is asked of its clips).
struct Trimmed {
  std::array<double, kVelocityChannels> correction{};
  Command does;
};

Trimmed lame(VelocityTrim& trim, PerfectWalker& walker, const Command& user, double share, double duration_s) {
  Trimmed last;
  double mean = 0.0;
  for (int k = 0; k < std::lround(duration_s / test::kTick_s); ++k) {
    model::RobotState state = walker.state();
    state.dq *= share;
    state.gyro_rad_s *= share;
    last.correction = trim.step(state, user, walker.reference(), true);
    walker.step(user, last.correction);
    mean += share * walker.does()[kVx];
  }
  last.does[kVx] = mean * test::kTick_s / duration_s;
  return last;
}

TEST(VelocityTrim, ARobotThatDoesAFifthTooLittleComesToDoWhatItIsAskedFor) {
  VelocityTrim trim = trim_of({});
  PerfectWalker walker;
  const Command user{{0.4}};
  lame(trim, walker, user, 0.85, 12.0);
  EXPECT_NEAR(lame(trim, walker, user, 0.85, 4.0).does[kVx], 0.4, 0.012);
  EXPECT_NEAR(user_command(walker.reference())[kVx], 0.4, 1e-9) << "the user's command as it was";
  EXPECT_GT(walker.reference().command[kVx], 0.45) << "the policy observes what its clips are asked for";
  EXPECT_FALSE(walker.reference().command_limited);

  VelocityTrim none = trim_of({.gain_per_s = 0.0});
  PerfectWalker untrimmed;
  lame(none, untrimmed, user, 0.85, 12.0);
  EXPECT_LT(lame(none, untrimmed, user, 0.85, 4.0).does[kVx], 0.36);
}

TEST(VelocityTrim, ARobotThatTakesItsTimeIsNotTakenForOneThatDoesTooLittle) {
  VelocityTrim trim = trim_of({});
  PerfectWalker walker;
  const Command user{{0.7}};
  double largest = 0.0;
  for (int k = 0; k < 500; ++k) {
    const double share = 1.0 - std::exp(-k * test::kTick_s / 0.5);
    largest = std::max(largest, std::abs(lame(trim, walker, user, share, test::kTick_s).correction[kVx]));
  }
  EXPECT_LT(largest, 0.01);
}

TEST(VelocityTrim, IsBoundedAndOfWhatIsNoLongerAskedNothingIsKept) {
  VelocityTrim trim = trim_of({});
  PerfectWalker walker;
  lame(trim, walker, {{0.4}}, 0.85, 8.0);
  const double learnt = lame(trim, walker, {{0.4}}, -3.0, 0.5).correction[kVx];
  EXPECT_LE(lame(trim, walker, {{0.4}}, -3.0, 20.0).correction[kVx], 0.25 * 0.8 + 1e-12);
  EXPECT_GT(learnt, 0.02);
  EXPECT_LT(std::abs(lame(trim, walker, {{-0.4}}, 1.0, 0.8).correction[kVx]), 0.5 * learnt) << "another command";
  lame(trim, walker, {}, 1.0, 1.0);
  EXPECT_EQ(lame(trim, walker, {}, 1.0, 0.1).correction, (std::array<double, kVelocityChannels>{}));
  EXPECT_EQ(walker.reference().gain, 0.0) << "it stands";
}

TEST(VelocityTrim, FadesWithoutAJumpWhereNoPolicyWalks) {
  VelocityTrim trim = trim_of({});
  PerfectWalker walker;
  double before = lame(trim, walker, {{0.4}}, 0.8, 8.0).correction[kVx];
  EXPECT_GT(before, 0.03);
  for (int k = 0; k < 25; ++k) {
    const double now = trim.step(walker.state(), {{0.4}}, walker.reference(), false)[kVx];
    EXPECT_LE(std::abs(now - before), 0.8 * test::kTick_s + 1e-12);
    before = now;
  }
  EXPECT_EQ(before, 0.0);
}

}  // namespace
}  // namespace pmg::control
