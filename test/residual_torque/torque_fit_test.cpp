// Fits of candidates to the torque that a model lacks: rows made by hand, without a simulation.
#include "residual_torque/torque_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <random>
#include <span>

#include "residual_torque/left_out_gain.hpp"
#include "residual_torque/repeat.hpp"

namespace pmg::residual_torque {
namespace {

constexpr std::size_t kRuns = 6;
constexpr int kRows = 150;  // of a run: 1.5 s

/// Rows at random angles and speeds where the torque is `torque_Nm(q, direction)` with noise.
MissingTorque rows(double noise_Nm, const std::function<double(double q_rad, double direction)>& torque_Nm) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  std::normal_distribution<double> noise(0.0, noise_Nm);
  MissingTorque missing;
  missing.widths_rad = {1.0, 0.4, 0.2};
  std::vector<double> t_s;
  for (int k = 0; k < kRows; ++k) t_s.push_back(0.01 * k);
  for (std::size_t i = 0; i < kRuns; ++i) {
    MissingRun run;
    run.missing_Nm = run.direction = Eigen::VectorXd::Zero(kRows);
    for (Eigen::VectorXd& one : std::span(run.quantities).first(9))  // the command's changes are zero, as its bends
      one = Eigen::VectorXd::NullaryExpr(kRows, [&] { return share(random); });
    for (Eigen::VectorXd& one : run.bends_rad) one = Eigen::VectorXd::Zero(kRows);
    run.changes_Nm.fill(Eigen::VectorXd::Zero(kRows));
    run.quantities[1] = run.quantities[1].cwiseAbs();
    run.tolerances_Nm = Eigen::MatrixXd::Zero(kRows, kTolerances);
    for (int k = 0; k < kRows; ++k) {
      run.direction[k] = std::copysign(1.0, share(random));
      run.missing_Nm[k] = torque_Nm(run.quantities[0][k], run.direction[k]) + noise(random);
    }
    missing.blocks.add_run(t_s, std::vector<bool>(t_s.size(), true));
    missing.runs.push_back(std::move(run));
  }
  return missing;
}

/// Each run is left out once.
std::vector<fitting::Fold> folds(const MissingTorque& missing) {
  std::vector<fitting::Fold> found(kRuns, {"run", {}});
  for (std::size_t b = 0; b < missing.blocks.count(); ++b)
    found[missing.blocks.run_of_block()[b]].blocks.push_back(static_cast<Eigen::Index>(b));
  return found;
}

TorqueFit best(const MissingTorque& missing) { return torque_fits(missing, folds(missing), 1.0, {}).front(); }

/// rms error of the fitted curve over its range.
double error_Nm(const TorqueFit& fit, const std::function<double(double)>& truth_Nm) {
  const model::ResidualTerm term = term_of(fit.candidate, fit.amplitudes, 1e9);
  double squares = 0.0;
  for (int i = 0; i <= 100; ++i) {
    const double q_rad = -0.95 + 0.019 * i;
    squares += std::pow(term.at(q_rad, 0.0).value_Nm - truth_Nm(q_rad), 2);
  }
  return std::sqrt(squares / 101.0);
}

TEST(TorqueFit, FindsTheQuantityAndItsCurve) {
  const auto bump_Nm = [](double q_rad) { return std::exp(-std::pow((q_rad - 0.3) / 0.25, 2)); };
  const TorqueFit fit = best(rows(0.1, [&](double q_rad, double) { return bump_Nm(q_rad); }));
  EXPECT_EQ(text(fit.candidate.term), "torque over position_rad");
  EXPECT_LT(error_Nm(fit, bump_Nm), 0.05);  // 0.1 Nm over 900 rows and 20 knots leave 0.015; knots 0.1 rad apart 0.02
}

TEST(TorqueFit, TellsFrictionFromTorque) {
  const TorqueFit fit = best(rows(0.1, [](double q_rad, double direction) { return -direction * (1.0 + q_rad); }));
  EXPECT_EQ(text(fit.candidate.term), "friction over position_rad");
  EXPECT_LT(error_Nm(fit, [](double q_rad) { return 1.0 + q_rad; }), 0.1);  // a prior pulls 2 Nm a little to zero
}

TEST(TorqueFit, FindsAMapWhereBothQuantitiesMatter) {
  MissingTorque missing = rows(0.1, [](double, double) { return 0.0; });
  for (MissingRun& run : missing.runs) run.missing_Nm += run.quantities[0].cwiseProduct(run.quantities[8]);
  EXPECT_EQ(text(best(missing).candidate.term), "torque over position_rad and time_s");
}

TEST(TorqueFit, IsAsSmoothAsLeftOutRowsWantIt) {
  const auto slow_Nm = [](double q_rad) { return 0.5 * q_rad; };
  const MissingTorque missing = rows(3.0, [&](double q_rad, double) { return slow_Nm(q_rad); });
  for (const TorqueFit& fit : torque_fits(missing, folds(missing), 1.0, {})) {
    if (text(fit.candidate.term) != "torque over position_rad") continue;
    // Free knots have sqrt(20 / 900) of the noise, 0.45 Nm; a line has sqrt(2 / 900) of it.
    EXPECT_LT(error_Nm(fit, slow_Nm), 0.2);
    return;
  }
  FAIL() << "no curve over position";
}

/// Rows whose missing torque follows the command's change in the first third of each 0.4 s.
MissingTorque late_in_thirds(double share) {
  MissingTorque missing = rows(0.1, [](double, double) { return 0.0; });
  std::mt19937 random(4);
  std::normal_distribution<double> change(0.0, 1.0);
  for (MissingRun& run : missing.runs) {
    for (int k = 0; k < kRows; ++k) {
      const double t_s = run.quantities[8][k] = 0.01 * k;
      for (Eigen::VectorXd& one : run.changes_Nm) one[k] = change(random);
      if (std::fmod(t_s, 0.4) < 0.4 / 3.0) run.missing_Nm[k] -= share * run.changes_Nm[kLags - 1][k];
    }
  }
  return missing;
}

TEST(Repeat, IsFoundWithItsPeriod) {
  const std::optional<double> period_s = repeats_each_s(late_in_thirds(1.0), {});
  ASSERT_TRUE(period_s);
  EXPECT_NEAR(*period_s, 0.4, 0.015);  // of 1.5 s: a tenth of a turn at the end is 0.011 s
}

TEST(Repeat, IsNotSeenInNoise) {
  Options options;
  options.least_repeating = 0.1;
  EXPECT_FALSE(repeats_each_s(late_in_thirds(0.0), options));
}

TEST(TorqueFit, FindsWhatRepeatsAndComesLate) {
  const TorqueFit fit = best(late_in_thirds(1.0));
  EXPECT_EQ(text(fit.candidate.term), "torque over time_s and command_change_Nm");
  EXPECT_TRUE(fit.candidate.term.axes[0].periodic);
}

/// Two blocks a run of two runs; squares are those of four samples each.
TEST(Candidates, FrictionGrowsTheLongerAJointRests) {
  Candidate candidate;
  candidate.term.acts_as = model::ResidualActs::kFriction;
  candidate.term.axes[0] = {model::ResidualQuantity::kRest, 0.0, 1.0, 4, false};
  candidate.modes = Eigen::MatrixXd::Identity(4, 4);
  const model::ResidualTerm term = term_of(candidate, Eigen::Vector4d(0.0, 0.6, 0.2, 0.5), 1e9);
  const auto values = std::span(term.values_Nm).first(4);
  EXPECT_TRUE(std::is_sorted(values.begin(), values.end()));
  EXPECT_GT(values.back(), values.front());
}

TEST(LeftOutGain, CountsErrorsAsTheyAreAndByFolds) {
  fitting::Blocks blocks;
  for (int run = 0; run < 2; ++run) blocks.add_run({0.0, 0.25, 0.5, 0.75}, {true, true, true, true});
  ASSERT_EQ(blocks.count(), 4U);
  const std::vector<fitting::Fold> folds = {{"run", {0, 1}}, {"run", {2, 3}}};
  fitting::HeldOut without, with;
  without.of_kind = Eigen::Vector4d(8.0, 8.0, 8.0, 8.0);  // rms 2 of two samples each
  with.of_kind = Eigen::Vector4d(2.0, 2.0, 18.0, 2.0);    // rms 1, 1, 3, 1
  const LeftOutGain gain = left_out_gain(blocks, folds, without, with);
  EXPECT_DOUBLE_EQ(gain.error_rad, 0.5);
  EXPECT_DOUBLE_EQ(gain.folds_won, 0.5);
  EXPECT_NEAR(gain.deviations, 1.0, 1e-12);  // gains 1, 1, -1, 1: deviation 1, standard error 0.5
}

TEST(TorqueFit, GainsNothingFromNoise) {
  // A look at fifty candidates finds one that gains a little; a real torque of the noise's size gains 0.5.
  EXPECT_LT(best(rows(1.0, [](double, double) { return 0.0; })).gain, 0.05);
}

TEST(Candidates, HaveTheOrderOfTheirPhysicsAndStayWithinTheirBound) {
  const MissingTorque missing = rows(1.0, [](double, double) { return 0.0; });
  std::mt19937 random(2);
  std::normal_distribution<double> any(0.0, 5.0);
  for (const Candidate& candidate : candidates(missing, {})) {
    const Eigen::VectorXd amplitudes =
        Eigen::VectorXd::NullaryExpr(candidate.modes.cols(), [&] { return any(random); });
    const model::ResidualTerm term = term_of(candidate, amplitudes, 0.7);
    EXPECT_FALSE(term.acts_as == model::ResidualActs::kTorque &&
                 term.axes[0].quantity == model::ResidualQuantity::kSpeed)
        << "a torque over speed could drive the joint";
    const auto values = std::span(term.values_Nm).first(static_cast<std::size_t>(term.count()));
    for (const double value_Nm : values) EXPECT_LE(std::abs(value_Nm), 0.7) << text(term);
    EXPECT_NO_THROW(model::check({.count = 1, .terms = {term}})) << text(term);
    if (candidate.is_map()) continue;
    if (term.axes[0].quantity == model::ResidualQuantity::kCommandChange) {
      EXPECT_TRUE(std::is_sorted(values.rbegin(), values.rend())) << "commands act late, never early";
    }
    if (term.axes[0].quantity == model::ResidualQuantity::kBend) {
      EXPECT_TRUE(std::is_sorted(values.rbegin(), values.rend())) << "the more it is bent, the more it pulls back";
      EXPECT_GE(values.front(), -1e-12);
      EXPECT_LE(values.back(), 1e-12);
    }
    if (term.axes[0].quantity == model::ResidualQuantity::kIntegral) {
      EXPECT_TRUE(std::is_sorted(values.begin(), values.end()));
    }
  }
}

}  // namespace
}  // namespace pmg::residual_torque
