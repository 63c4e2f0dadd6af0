// The core of fitting, on problems whose answers are known.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "fitting/covariance.hpp"

namespace pmg::fitting {
namespace {

constexpr double kRate_Hz = 100.0;

/// Runs of y = a t + b, sampled at 100 Hz, with noise; coordinates are a and b.
struct Lines {
  std::vector<Eigen::VectorXd> t_s, y;
  Blocks blocks;

  Lines(int runs, int samples, double a, double b, double noise, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0.0, 1.0);
    for (int r = 0; r < runs; ++r) {
      std::vector<double> times_s;
      t_s.emplace_back(samples);
      y.emplace_back(samples);
      for (int k = 0; k < samples; ++k) {
        times_s.push_back(k / kRate_Hz);
        t_s.back()[k] = times_s.back();
        y.back()[k] = a * times_s.back() + b + noise * normal(random);
      }
      blocks.add_run(times_s, std::vector<bool>(times_s.size(), true));
    }
  }
  Problem problem(Coordinates coordinates) const {
    return {.residuals =
                [this](const Eigen::VectorXd& x) {
                  Residuals found;
                  for (std::size_t r = 0; r < y.size(); ++r)
                    found.push_back((x[0] * t_s[r].array() + x[1]).matrix() - y[r]);
                  return found;
                },
            .coordinates = std::move(coordinates)};
  }
  LinearisedFit fitted(const Problem& problem) const {
    LinearisedFit fit{.ranges = problem.coordinates};
    fit.coordinates = gauss_newton(problem, Eigen::Vector2d::Zero()).x;
    const Residuals at = problem.residuals(fit.coordinates);
    fit.blocks = blocks.normal_equations(at, jacobian(problem, fit.coordinates, at));
    return fit;
  }
};

const Coordinates kWide(2, {.lower = -10.0, .upper = 10.0});

/// r(x) = x^2, whose slope at x is 2 x.
Problem squared(Differences differences, double lower) {
  return {.residuals = [](const Eigen::VectorXd& x) { return Residuals{Eigen::VectorXd::Constant(1, x[0] * x[0])}; },
          .coordinates = {{.lower = lower, .upper = 10.0, .step = 0.1}},
          .differences = differences};
}

double slope(const Problem& problem, double x) {
  const Eigen::VectorXd place = Eigen::VectorXd::Constant(1, x);
  return jacobian(problem, place, problem.residuals(place)).front()(0, 0);
}

TEST(Jacobian, CentralDifferencesAreRightToSecondOrderAndStayWithinTheRange) {
  constexpr double kRounding = 1e-12;
  EXPECT_NEAR(slope(squared(Differences::kCentral, 0.0), 2.0), 4.0, kRounding);
  EXPECT_NEAR(slope(squared(Differences::kForward, 0.0), 2.0), 4.1, kRounding) << "2 x + step";
  EXPECT_NEAR(slope(squared(Differences::kCentral, 2.0), 2.0), 4.1, kRounding) << "at its bound, one side is left";
}

TEST(GaussNewton, FindsTheLeastSquaresOfALine) {
  const Lines lines(2, 200, 1.5, -0.4, 0.0, 1);
  const Minimum found = gauss_newton(lines.problem(kWide), Eigen::Vector2d(8.0, 8.0));
  EXPECT_NEAR(found.x[0], 1.5, 1e-4);  // damping leaves a rest that the relative tolerance ends
  EXPECT_NEAR(found.x[1], -0.4, 1e-4);
}

TEST(GaussNewton, StaysWithinTheRangesAndTheOthersMakeUpForIt) {
  const Lines lines(2, 200, 1.5, -0.4, 0.0, 1);
  Coordinates narrow = kWide;
  narrow[0].upper = 1.0;
  const Minimum found = gauss_newton(lines.problem(narrow), Eigen::Vector2d::Zero());
  EXPECT_DOUBLE_EQ(found.x[0], 1.0);
  EXPECT_NEAR(found.x[1], -0.4 + 0.5 * 0.995, 1e-3);  // the mean time is 0.995 s
}

TEST(GaussNewton, TakesNoStepLongerThanItMay) {
  const Lines lines(1, 200, 1.5, -0.4, 0.0, 1);
  const Minimum found =
      gauss_newton(lines.problem(kWide), Eigen::Vector2d::Zero(), {.most_iterations = 1, .longest_step = 0.01});
  EXPECT_LE(found.x.cwiseAbs().maxCoeff(), 0.01 * 20.0 + 1e-12);
}

TEST(GaussNewton, APriorPullsAsItsWeightSays) {
  const Lines lines(1, 200, 1.5, 0.0, 0.0, 1);
  Coordinates known = kWide;
  known[0].expected = 1.0;
  known[0].deviation = 0.1;
  known[1].upper = known[1].lower + 1e-9;  // held
  Problem problem = lines.problem(known);
  problem.residuals = [](const Eigen::VectorXd& x) { return Residuals{Eigen::VectorXd::Constant(1, x[0] - 1.5)}; };
  problem.prior_weight = 0.01;  // (x - 1.5)^2 + (x - 1)^2
  EXPECT_NEAR(gauss_newton(problem, Eigen::Vector2d(0.0, -10.0)).x[0], 1.25, 1e-3);
}

TEST(GaussNewton, EndsWhenItIsToldTo) {
  const Lines lines(1, 200, 1.5, -0.4, 0.0, 1);
  const Minimum found =
      gauss_newton(lines.problem(kWide), Eigen::Vector2d(8.0, 8.0), {}, {.interrupted = [] { return true; }});
  EXPECT_EQ(found.x, Eigen::Vector2d(8.0, 8.0));
  EXPECT_EQ(found.evaluations, 1);
}

TEST(Blocks, EverySampleIsInOneBlockTheLastToo) {
  const Lines lines(3, 226, 1.0, 0.0, 0.1, 1);  // 4 blocks of 50 and a rest of 26, which is long enough for one
  EXPECT_EQ(lines.blocks.count(), 15U);
  const Problem problem = lines.problem(kWide);
  const Residuals at = problem.residuals(Eigen::Vector2d::Zero());
  const Jacobian slopes = jacobian(problem, Eigen::Vector2d::Zero(), at);
  NormalEquations sum = NormalEquations::zero(2);
  for (const NormalEquations& block : lines.blocks.normal_equations(at, slopes)) sum += block;
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(2);
  for (std::size_t r = 0; r < at.size(); ++r) gradient += slopes[r].transpose() * at[r];
  EXPECT_EQ(sum.samples, 3.0 * 226.0);
  EXPECT_NEAR((sum.gradient - gradient).norm(), 0.0, 1e-9 * gradient.norm());  // rounding
  EXPECT_NEAR(sum.squares, sum_of_squares(at), 1e-9 * sum.squares);
}

// Of 200 campaigns the slope is off by at most 1.96 deviations in 95 %, +- 5 % for three deviations of that count.
TEST(Covariance, CoversTheTruthAsOftenAsItSays) {
  int covered = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    const Lines lines(6, 250, 1.5, -0.4, 0.05, seed);
    const LinearisedFit fit = lines.fitted(lines.problem(kWide));
    const Covariance found = cluster_robust_covariance(fit, {0, 1});
    covered += std::abs(fit.coordinates[0] - 1.5) < 1.96 * std::sqrt(found.robust(0, 0)) ? 1 : 0;
  }
  EXPECT_NEAR(covered / 200.0, 0.95, 0.05);
}

TEST(Covariance, OfResidualsThatHangTogetherIsTheBlocks) {
  // One offset a block instead of one a sample: 50 samples say no more than one.
  Lines lines(4, 500, 0.0, 0.0, 0.0, 1);
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0.0, 0.05);
  for (Eigen::VectorXd& run : lines.y) {
    for (Eigen::Index k = 0; k < run.size(); k += 50) run.segment(k, 50).setConstant(normal(random));
  }
  const LinearisedFit fit = lines.fitted(lines.problem(kWide));
  const double deviation = std::sqrt(cluster_robust_covariance(fit, {1}).robust(0, 0));
  EXPECT_NEAR(deviation / (0.05 / std::sqrt(40.0)), 1.0, 0.35);  // of 40 blocks: 11 % each deviation of a deviation
}

TEST(Folds, AStepWithoutAFoldGoesToTheFitOfTheOthers) {
  Lines lines(2, 200, 1.0, 0.0, 0.0, 1);
  lines.y[1].array() += 1.0;  // the second run is off
  const LinearisedFit fit = lines.fitted(lines.problem(kWide));
  EXPECT_NEAR(fit.coordinates[1], 0.5, 1e-3);
  const std::vector<Eigen::VectorXd> steps = steps_without(fit, {{"run", {4, 5, 6, 7}}});
  EXPECT_NEAR(fit.coordinates[1] + steps[0][1], 0.05 / 1.05, 1e-3);  // a twentieth of its weight stays
}

TEST(BlockComparison, PrefersTheModelThatIsBetterInMostBlocks) {
  const Lines lines(4, 200, 1.0, 0.0, 0.0, 1);
  Eigen::VectorXd first = Eigen::VectorXd::Constant(16, 2.0), second = Eigen::VectorXd::Constant(16, 1.0);
  second[3] = 20.0;  // a single block that went another way
  const Comparison found =
      BlockComparison(lines.blocks, {{"half", {0, 1, 2, 3}}, {"half", {8, 9}}}, 0.0)(first, second);
  EXPECT_LT(found.gain, 0.0);
  EXPECT_GT(found.log_gain, 0.0);
  EXPECT_EQ(found.folds_won, 0.5);
}

}  // namespace
}  // namespace pmg::fitting
