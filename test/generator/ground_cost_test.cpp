// The optimisation's Jacobians in closed form are those of automatic differentiation.
#include "generator/ground_cost.hpp"

#include <ceres/autodiff_cost_function.h>
#include <gtest/gtest.h>

#include <random>

#include "generator/gait_parts.hpp"
#include "generator/static_clips.hpp"

namespace pmg::generator {
namespace {

using Automatic = ceres::AutoDiffCostFunction<GroundResiduals, kGroundResiduals, kLegJoints, kLegJoints, kLegJoints,
                                              kLegJoints, kLegJoints, kLegJoints, kLegJoints, kLegJoints>;

struct Evaluated {
  Eigen::Matrix<double, kGroundResiduals, 1> residual, residual_alone;
  std::array<Eigen::Matrix<double, kGroundResiduals, kLegJoints, Eigen::RowMajor>, 8> J;
};

Evaluated evaluated(const ceres::CostFunction& cost, const std::array<LegVector<double>, 8>& knots) {
  Evaluated out;
  std::array<const double*, 8> parameters{};
  std::array<double*, 8> jacobian{};
  for (std::size_t k = 0; k < 8; ++k) {
    parameters[k] = knots[k].data();
    jacobian[k] = out.J[k].data();
  }
  EXPECT_TRUE(cost.Evaluate(parameters.data(), out.residual.data(), jacobian.data()));
  EXPECT_TRUE(cost.Evaluate(parameters.data(), out.residual_alone.data(), nullptr));
  return out;
}

TEST(GroundCost, HasTheResidualsAndJacobiansOfAutomaticDifferentiation) {
  const model::RobotModel robot = model::load_robot(model::find_robot("z1"));
  const JointRoles roles = find_joint_roles(robot);
  const RobotLegs legs = robot_legs(robot, roles);
  constexpr unsigned kSeed = 19;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> angle(-0.6, 0.6), unit(0.0, 1.0);
  double largest = 0.0;
  for (int i = 0; i < 200; ++i) {
    GaitTask task;
    task.period_s = 0.8 + unit(random);
    task.duty_factor = 0.55 + 0.1 * unit(random);
    task.velocity = {angle(random), angle(random), angle(random)};
    task.symmetric = i % 2 == 0;
    task.sway_m = 0.02;
    task.hike_rad = 0.3 * angle(random);
    Scenario scenario{0.2 + 0.8 * unit(random), 1.0, {}};
    LegPose added = legs.stand;
    for (const Foot foot : {kLeft, kRight})
      added[foot] = added[foot].unaryExpr([&](double) { return 0.2 * angle(random); });
    scenario.addition.q = scenario.addition.dq_dphi = {added};
    const std::size_t sample = static_cast<std::size_t>(i) % kClipSamples;
    const GroundResiduals residuals(legs, task, scenario, static_cast<double>(sample) / kClipSamples, sample, 24,
                                    Eigen::Vector3d::Constant(0.1));
    std::array<LegVector<double>, 8> knots;
    for (LegVector<double>& knot : knots) knot = knot.unaryExpr([&](double) { return angle(random); });
    const Evaluated ours = evaluated(GroundCost(residuals), knots);
    const Evaluated expected = evaluated(Automatic(new GroundResiduals(residuals)), knots);
    // The same derivative in another order of operations: rounding, of weights up to 600 and soles of 1 mm softness.
    const double scale = 1.0 + expected.residual.norm();
    EXPECT_LT((ours.residual - expected.residual).norm(), 1e-9 * scale);
    EXPECT_LT((ours.residual_alone - expected.residual).norm(), 1e-9 * scale);
    for (std::size_t k = 0; k < 8; ++k) {
      EXPECT_LT((ours.J[k] - expected.J[k]).norm(), 1e-9 * (1.0 + expected.J[k].norm())) << "knot " << k;
      largest = std::max(largest, expected.J[k].norm());
    }
  }
  EXPECT_GT(largest, 10.0) << "derivatives that vanish agree with any";
}

}  // namespace
}  // namespace pmg::generator
