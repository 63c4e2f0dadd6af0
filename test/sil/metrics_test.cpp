#include "sil/metrics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace pmg::sil {
namespace {

constexpr double kDt_s = 0.01, kHeight_m = 0.8, kPeriod_s = 1.0;
constexpr double kExact = 1e-9;

Eigen::Quaterniond attitude(double yaw_rad, double pitch_rad, double roll_rad) {
  return Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitX());
}

/// Upright at standing height, heading along yaw, with these velocities in its own heading frame.
model::GroundTruth moving(double yaw_rad, double vx_m_s, double vy_m_s, double omega_rad_s = 0.0) {
  model::GroundTruth truth;
  truth.p_WB.z() = kHeight_m;
  truth.q_WB = truth.q_WT = attitude(yaw_rad, 0.0, 0.0);
  truth.v_WB_W = truth.q_WB * Eigen::Vector3d(vx_m_s, vy_m_s, 0.0);
  truth.omega_WB_B = {0.0, 0.0, omega_rad_s};
  return truth;
}

TEST(Metrics, PerfectTrackingHasNoErrorWhateverTheHeading) {
  for (const double yaw_rad : {0.0, 1.0, 3.0, -2.5}) {
    Metrics metrics(kHeight_m, kDt_s);
    Command user;
    user[kVx] = 0.5;
    user[kVy] = -0.2;
    for (int k = 0; k < 300; ++k) metrics.add(moving(yaw_rad, 0.5, -0.2), user, kPeriod_s);
    const TrackingSummary summary = metrics.summary();
    EXPECT_NEAR(summary.lin_vel_mae_m_s, 0.0, kExact);
    EXPECT_NEAR(summary.yaw_vel_mae_rad_s, 0.0, kExact);
    EXPECT_NEAR(summary.height_mae_m, 0.0, kExact);
    EXPECT_NEAR(summary.followed_s, 3.0, kExact);
    EXPECT_FALSE(metrics.fell());
  }
}

TEST(Metrics, VelocityErrorIsTheNormOfTheXyError) {
  Metrics metrics(kHeight_m, kDt_s);
  Command user;
  user[kVx] = 0.5;
  for (int k = 0; k < 200; ++k) metrics.add(moving(0.7, 0.5 - 0.03, 0.04), user, kPeriod_s);
  EXPECT_NEAR(metrics.summary().lin_vel_mae_m_s, 0.05, kExact);
  EXPECT_NEAR(metrics.summary().lin_vel_raw_mae_m_s, 0.05, kExact);
}

TEST(Metrics, SwayWithinAGaitPeriodIsAveragedAway) {
  Metrics metrics(kHeight_m, kDt_s);
  constexpr double kSway = 0.1;
  constexpr int kTicks = 2000;
  for (int k = 0; k < kTicks; ++k) {
    const double sway = kSway * std::sin(2.0 * std::numbers::pi * kDt_s * k / kPeriod_s);
    metrics.add(moving(0.0, 0.0, sway, sway), Command{}, kPeriod_s);
  }
  // The remainder comes from the first period, whose average covers less than one: at most kSway for 1 s of 20 s.
  EXPECT_LT(metrics.summary().lin_vel_mae_m_s, kSway / 20.0);
  EXPECT_LT(metrics.summary().yaw_vel_mae_rad_s, kSway / 20.0);
  EXPECT_NEAR(metrics.summary().lin_vel_raw_mae_m_s, kSway * 2.0 / std::numbers::pi, 1e-3) << "mean of |sin|";
  EXPECT_NEAR(metrics.summary().yaw_vel_raw_mae_rad_s, kSway * 2.0 / std::numbers::pi, 1e-3);
}

/// Stands with the torso rolled and pitched and the pelvis raised by this much.
model::GroundTruth swaying(double sway) {
  model::GroundTruth truth = moving(0.0, 0.0, 0.0);
  truth.q_WT = attitude(0.0, sway, sway);
  truth.p_WB.z() += sway;
  return truth;
}

TEST(Metrics, SwayOfAttitudeAndHeightWithinAGaitPeriodIsAveragedAway) {
  Metrics metrics(kHeight_m, kDt_s);
  constexpr double kSway = 0.1;
  constexpr int kTicks = 2000;
  for (int k = 0; k < kTicks; ++k) {
    metrics.add(swaying(kSway * std::sin(2.0 * std::numbers::pi * kDt_s * k / kPeriod_s)), Command{}, kPeriod_s);
  }
  const TrackingSummary summary = metrics.summary();
  for (const double mean : {summary.roll_mae_rad, summary.pitch_mae_rad, summary.height_mae_m}) {
    EXPECT_LT(mean, kSway / 20.0);
  }
  for (const double raw : {summary.roll_raw_mae_rad, summary.pitch_raw_mae_rad, summary.height_raw_mae_m}) {
    EXPECT_NEAR(raw, kSway * 2.0 / std::numbers::pi, 1e-3) << "mean of |sin|";
  }
}

TEST(Metrics, EveryErrorIsAveragedOverExactlyTheGaitPeriodThatEndsThere) {
  // One tick is off; each of the 110 ticks whose period holds it shows 1 / 110 of that, so their sum is the tick's own.
  constexpr double kOff = 0.1, kGait_s = 1.1;
  constexpr int kWindow = 110, kTicks = 600;
  Metrics metrics(kHeight_m, kDt_s);
  TrackingSummary before, short_of, within, after;
  for (int k = 0; k < kTicks; ++k) {
    model::GroundTruth truth = moving(0.0, 0.0, 0.0);
    if (k == 300) {
      truth = moving(0.0, kOff, 0.0, kOff);
      truth.q_WT = attitude(0.0, kOff, kOff);
      truth.p_WB.z() += kOff;
    }
    metrics.add(truth, {}, kGait_s);
    if (k == 299) before = metrics.summary();
    if (k == 300 + kWindow - 2) short_of = metrics.summary();
    if (k == 300 + kWindow - 1) within = metrics.summary();
    if (k == kTicks - 1) after = metrics.summary();
  }
  using Errors = double TrackingSummary::*;
  for (const Errors error :
       {&TrackingSummary::lin_vel_mae_m_s, &TrackingSummary::yaw_vel_mae_rad_s, &TrackingSummary::roll_mae_rad,
        &TrackingSummary::pitch_mae_rad, &TrackingSummary::height_mae_m}) {
    EXPECT_NEAR(before.*error, 0.0, kExact);
    EXPECT_NEAR(short_of.*error * (300 + kWindow - 1), kOff * (kWindow - 1) / kWindow, kExact);
    EXPECT_NEAR(within.*error * (300 + kWindow), kOff, kExact) << "all of it is in the window's ticks";
    EXPECT_NEAR(after.*error * kTicks, kOff, kExact) << "and nothing later";
  }
  for (const Errors raw :
       {&TrackingSummary::lin_vel_raw_mae_m_s, &TrackingSummary::yaw_vel_raw_mae_rad_s,
        &TrackingSummary::roll_raw_mae_rad, &TrackingSummary::pitch_raw_mae_rad, &TrackingSummary::height_raw_mae_m}) {
    EXPECT_NEAR(after.*raw * kTicks, kOff, kExact);
  }
}

TEST(Metrics, HeadingIsThePelvisYawAveragedOverAGaitPeriod) {
  // The pelvis swings its yaw about 0 while the robot moves along x: in H the velocity is steady along x.
  Metrics metrics(kHeight_m, kDt_s);
  Command user;
  user[kVx] = 0.5;
  for (int k = 0; k < 2000; ++k) {
    const double yaw_rad = 0.2 * std::sin(2.0 * std::numbers::pi * kDt_s * k / kPeriod_s);
    model::GroundTruth truth = moving(yaw_rad, 0.0, 0.0);
    truth.v_WB_W = {0.5, 0.0, 0.0};
    metrics.add(truth, user, kPeriod_s);
  }
  // Relative to the momentary yaw the raw error would be 0.5 times the mean of |yaw|, 0.064; here only the first second
  // of 20 has it.
  EXPECT_LT(metrics.summary().lin_vel_raw_mae_m_s, 0.01);
}

TEST(Metrics, TurningThroughPlusMinusPiIsNoJump) {
  Metrics metrics(kHeight_m, kDt_s);
  Command user;
  user[kVx] = 0.4;
  user[kOmega] = 0.5;
  for (int k = 0; k < 2000; ++k) metrics.add(moving(0.5 * kDt_s * k, 0.4, 0.0, 0.5), user, kPeriod_s);
  // H lags a steady turn by half a period: 0.25 rad, which turns 0.4 m/s by 0.1 m/s. A jump would show ten times that.
  // The first two of 20 s, in which both averages fill, reduce it by up to a tenth.
  EXPECT_NEAR(metrics.summary().lin_vel_mae_m_s, 2.0 * 0.4 * std::sin(0.125), 0.01);
  EXPECT_NEAR(metrics.summary().yaw_vel_mae_rad_s, 0.0, kExact);
}

TEST(Metrics, AttitudeIsTheTorsosPitchForwardAndRollToTheRight) {
  for (const double yaw_rad : {0.0, 2.0}) {
    const RollPitch torso = roll_pitch(attitude(yaw_rad, 0.3, -0.2));
    EXPECT_NEAR(torso.pitch_rad, 0.3, kExact);
    EXPECT_NEAR(torso.roll_rad, -0.2, kExact);
  }
  // Forward: the torso's z axis leans along x. Right: along -y.
  EXPECT_GT((attitude(0.0, 0.3, 0.0) * Eigen::Vector3d::UnitZ()).x(), 0.0);
  EXPECT_LT((attitude(0.0, 0.0, 0.3) * Eigen::Vector3d::UnitZ()).y(), 0.0);

  Metrics metrics(kHeight_m, kDt_s);
  Command user;
  user[kPitch] = 0.25;
  user[kRoll] = 0.1;
  user[kHeight] = -0.1;
  model::GroundTruth truth = moving(1.0, 0.0, 0.0);
  truth.q_WT = attitude(1.0, 0.30, 0.08);
  truth.p_WB.z() = kHeight_m - 0.07;
  metrics.add(truth, user, kPeriod_s);
  EXPECT_NEAR(metrics.summary().pitch_mae_rad, 0.05, kExact);
  EXPECT_NEAR(metrics.summary().roll_mae_rad, 0.02, kExact);
  EXPECT_NEAR(metrics.summary().height_mae_m, 0.03, kExact);
}

TEST(Metrics, AFallIsALowPelvisOrATiltedTorso) {
  Metrics low(kHeight_m, kDt_s), tilted(kHeight_m, kDt_s), neither(kHeight_m, kDt_s);
  model::GroundTruth truth = moving(0.0, 0.0, 0.0);
  truth.p_WB.z() = 0.61 * kHeight_m;
  truth.q_WT = attitude(0.0, 0.99, 0.0);
  neither.add(truth, {}, kPeriod_s);
  EXPECT_FALSE(neither.fell());
  truth.q_WT = attitude(0.0, 0.0, 0.0);
  truth.p_WB.z() = 0.59 * kHeight_m;
  low.add(truth, {}, kPeriod_s);
  EXPECT_TRUE(low.fell());
  truth.p_WB.z() = kHeight_m;
  truth.q_WT = attitude(0.5, 0.0, -1.01);
  tilted.add(truth, {}, kPeriod_s);
  EXPECT_TRUE(tilted.fell());
}

TEST(Metrics, AfterAFallVelocityAndHeightCountAsZeroToTheEnd) {
  Metrics metrics(kHeight_m, kDt_s);
  Command user;
  user[kVx] = 0.5;
  user[kOmega] = 0.3;
  model::GroundTruth truth = moving(0.0, 0.5, 0.0, 0.3);
  truth.p_WB.z() = 0.1;
  metrics.add(truth, user, kPeriod_s);
  // The body seems to stand up and go on, but stays fallen.
  for (int k = 1; k < 100; ++k) metrics.add(moving(0.0, 0.5, 0.0, 0.3), user, kPeriod_s);
  EXPECT_NEAR(metrics.summary().lin_vel_mae_m_s, 0.5, kExact);
  EXPECT_NEAR(metrics.summary().yaw_vel_mae_rad_s, 0.3, kExact);
  EXPECT_NEAR(metrics.summary().height_mae_m, kHeight_m, kExact);
  EXPECT_NEAR(metrics.summary().pitch_mae_rad, 0.0, kExact) << "attitude as measured";
  EXPECT_NEAR(metrics.fell_at_s(), 0.0, kExact);
}

TEST(Metrics, SkippedTicksAreNotJudgedAndDoNotReachIntoLaterAverages) {
  Metrics metrics(kHeight_m, kDt_s);
  for (int k = 0; k < 50; ++k) metrics.add(moving(0.0, 0.0, 0.0), {}, kPeriod_s);
  for (int k = 0; k < 50; ++k) metrics.skip(moving(0.0, 3.0, 0.0));
  for (int k = 0; k < 50; ++k) metrics.add(moving(2.0, 0.0, 0.0), {}, kPeriod_s);
  EXPECT_NEAR(metrics.summary().lin_vel_mae_m_s, 0.0, kExact);
  EXPECT_NEAR(metrics.summary().followed_s, 1.0, kExact);
}

TEST(Metrics, SlipCountsLoadedFeetOnly) {
  Metrics metrics(kHeight_m, kDt_s);
  model::GroundTruth truth = moving(0.0, 0.0, 0.0);
  truth.foot_force_N = {300.0, 1.0};
  truth.foot_slip_m_s = {0.02, 5.0};
  metrics.add(truth, {}, kPeriod_s);
  EXPECT_NEAR(metrics.summary().foot_slip_mean_m_s, 0.02, kExact);
}

}  // namespace
}  // namespace pmg::sil
