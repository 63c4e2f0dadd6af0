#include "calib/step_choice.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "calib/synthetic_bench.hpp"

namespace pmg::calib {
namespace {

JointModel damped_joint() { return test::plain_joint(0.05); }

class StepChoice : public testing::Test {
 protected:
  const bench::Bench bench_ = test::pd_bench(true);
  const JointModel model_ = damped_joint();
  const std::vector<SingleJoint> runs_ = test::record(bench_, model_, 4);

  /// The residual falls with the step, as on a joint that has none.
  ChosenStep chosen(double noise_rms_rad, const StepOptions& options = {}) const {
    JointModel model = model_;
    const FitAtStep refit = [](const std::vector<SingleJoint>& runs, const JointModel& start) {
      return FittedAtStep{start, 1e-15 * runs.front().step_s()};
    };
    return chosen_step(bench_, runs_, model, noise_rms_rad, refit, options, 1);
  }
};

TEST_F(StepChoice, MeasuresTheErrorAgainstAFineStepWithoutOne) {
  const IntegrationError found = integration_error(bench_, runs_, model_, 1);
  std::vector<double> errors_rad;
  for (const SingleJoint& joint : runs_) {
    const std::vector<double> here = joint.rollout(model_);
    const std::vector<double> exact = SingleJoint(bench_, joint.run(), joint.step_s() / 64.0).rollout(model_);
    double squares = 0.0;
    for (std::size_t k = 0; k < here.size(); ++k) squares += std::pow(here[k] - exact[k], 2);
    errors_rad.push_back(std::sqrt(squares / static_cast<double>(here.size())));
  }
  ASSERT_EQ(found.of_run_rad.size(), errors_rad.size());
  // The second-order part of the error, and dry friction at rest: up to a quarter here.
  for (std::size_t i = 0; i < errors_rad.size(); ++i)
    EXPECT_NEAR(found.of_run_rad[i], errors_rad[i], 0.3 * errors_rad[i]);
}

TEST_F(StepChoice, KeepsAStepWhoseErrorIsSmallBesideTheNoise) {
  const double error_rad = integration_error(bench_, runs_, model_, 1).rms_rad;
  const ChosenStep found = chosen(5.0 * error_rad);
  EXPECT_EQ(found.error.step_s, runs_.front().step_s());
  EXPECT_EQ(found.limit, StepLimit::kError);
}

TEST_F(StepChoice, HalvesTheStepUntilItsErrorIsSmallBesideTheNoise) {
  const double error_rad = integration_error(bench_, runs_, model_, 1).rms_rad;
  const StepOptions options;
  const ChosenStep found = chosen(0.65 * error_rad, options);  // 1.54 times the noise
  EXPECT_DOUBLE_EQ(found.error.step_s, 0.25 * runs_.front().step_s());
  EXPECT_LE(found.error.rms_rad, options.share_of_noise * 0.65 * error_rad);
  EXPECT_EQ(found.limit, StepLimit::kError);
  EXPECT_EQ(found.first.step_s, runs_.front().step_s());
}

TEST_F(StepChoice, StopsWhereAFinerStepCostsTooMuch) {
  const ChosenStep fine = chosen(1e-9);
  EXPECT_DOUBLE_EQ(fine.error.step_s, runs_.front().step_s() / 8.0);
  EXPECT_EQ(fine.limit, StepLimit::kCost);
  StepOptions cheap;
  cheap.most_steps = 3 * 4 * static_cast<int>(runs_.front().steps());  // of 4 runs; a halving takes twice as many
  EXPECT_DOUBLE_EQ(chosen(1e-9, cheap).error.step_s, runs_.front().step_s() / 2.0);
}

TEST_F(StepChoice, KeepsAStepWhoseErrorIsSmallBesideTheResidual) {
  const double error_rad = integration_error(bench_, runs_, model_, 1).rms_rad;
  JointModel model = model_;
  const FitAtStep refit = [&](const std::vector<SingleJoint>&, const JointModel& start) {
    return FittedAtStep{start, 9.0 * error_rad * error_rad};
  };
  const ChosenStep found = chosen_step(bench_, runs_, model, 1e-9, refit, {}, 1);
  EXPECT_EQ(found.error.step_s, runs_.front().step_s());
  EXPECT_EQ(found.limit, StepLimit::kError);
}

TEST_F(StepChoice, KeepsAStepWhereAFinerOneLeavesNoLowerResidual) {
  JointModel model = model_;
  const FitAtStep refit = [](const std::vector<SingleJoint>&, const JointModel& start) {
    return FittedAtStep{start, 1e-20};
  };
  const ChosenStep found = chosen_step(bench_, runs_, model, 1e-9, refit, {}, 1);
  EXPECT_EQ(found.error.step_s, runs_.front().step_s());
  EXPECT_EQ(found.limit, StepLimit::kResidual);
}

}  // namespace
}  // namespace pmg::calib
