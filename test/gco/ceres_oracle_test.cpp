// ceres::Solver on the same functor that TinySolver solves in the loop.
#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include "gco/ground_aware_command.hpp"
#include "robot_states.hpp"

namespace pmg::gco {
namespace {

template <int kUnknowns>
class CeresCost : public ceres::SizedCostFunction<ContactProblem<kUnknowns>::NUM_RESIDUALS, kUnknowns> {
 public:
  explicit CeresCost(const ContactTerms& terms) : problem_{terms} {}
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    constexpr int kRows = ContactProblem<kUnknowns>::NUM_RESIDUALS;
    Eigen::Matrix<double, kRows, kUnknowns> J;
    if (!problem_(parameters[0], residuals, J.data())) return false;
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, kRows, kUnknowns, Eigen::RowMajor>> row_major(jacobians[0]);
      row_major = J;
    }
    return true;
  }

 private:
  ContactProblem<kUnknowns> problem_;
};

template <int kUnknowns>
std::array<double, kMaxUnknowns> solve_with_ceres(const ContactTerms& terms) {
  std::array<double, kMaxUnknowns> x = terms.prior;
  ceres::Problem problem;
  problem.AddResidualBlock(new CeresCost<kUnknowns>(terms), nullptr, x.data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  options.max_num_iterations = 100;
  options.function_tolerance = 1e-18;
  options.gradient_tolerance = 1e-13;
  options.parameter_tolerance = 1e-13;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  EXPECT_TRUE(summary.IsSolutionUsable()) << summary.BriefReport();
  return x;
}

class CeresOracleOf : public testing::TestWithParam<const char*> {
 protected:
  model::RobotModel robot = test::load(GetParam());
};
INSTANTIATE_TEST_SUITE_P(Robots, CeresOracleOf, testing::ValuesIn(test::kRobots), test::robot_name);

/// Single support, double support, all fades between them, and flight.
Reference next_state(test::RandomReferences& references, int i) {
  Reference reference = references.next();
  const double part = references.uniform(0.0, 1.0);
  const std::array<PerFoot<double>, 4> weights = {{{1.0, 0.0}, {part, 1.0}, {1.0, 1.0}, {0.3 * part, 0.0}}};
  const PerFoot<double>& weight = weights[static_cast<std::size_t>(i) % weights.size()];
  test::set_contact(reference, weight[kLeft], weight[kRight]);
  return reference;
}

TEST_P(CeresOracleOf, AgreesOnFiveUnknownsInAThousandStates) {
  constexpr unsigned kSeed = 31;
  SCOPED_TRACE(kSeed);
  test::RandomReferences references(robot, kSeed);
  test::TermsOf terms_of(robot);
  GroundAwareCommand gco(robot);
  for (int i = 0; i < 1000; ++i) {
    const Reference reference = next_state(references, i);
    gco.reset();
    const Result& result = gco.solve(reference);
    ASSERT_EQ(result.status, Status::kConverged);
    const auto tiny = test::unknowns_of(result);
    const auto oracle = solve_with_ceres<5>(terms_of(reference));
    for (std::size_t n = 0; n < 5; ++n) ASSERT_NEAR(tiny[n], oracle[n], 1e-6) << "state " << i << ", unknown " << n;
  }
}

TEST_P(CeresOracleOf, AgreesOnSevenUnknownsInTwoHundredStates) {
  constexpr unsigned kSeed = 32;
  SCOPED_TRACE(kSeed);
  const Options options{.optimise_roll_pitch = true};
  test::RandomReferences references(robot, kSeed);
  test::TermsOf terms_of(robot);
  GroundAwareCommand gco(robot, options);
  for (int i = 0; i < 200; ++i) {
    const Reference reference = test::mild(next_state(references, i), robot);
    gco.reset();
    const Result& result = gco.solve(reference);
    ASSERT_EQ(result.status, Status::kConverged) << i;
    const auto tiny = test::unknowns_of(result);
    const auto oracle = solve_with_ceres<7>(terms_of.with_attitude(reference, options.attitude_prior_weight));
    // TinySolver stops at cost changes of 1e-15. The stiffness of pitch and roll is as small as 0.1^2, so a step may be
    // sqrt(1e-15 / 0.01).
    for (std::size_t n = 0; n < kMaxUnknowns; ++n) {
      ASSERT_NEAR(tiny[n], oracle[n], 1e-5) << "state " << i << ", unknown " << n;
    }
  }
}

}  // namespace
}  // namespace pmg::gco
