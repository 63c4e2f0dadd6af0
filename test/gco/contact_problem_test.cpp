#include "gco/contact_problem.hpp"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "robot_states.hpp"

namespace pmg::gco {
namespace {

using test::RandomReferences;
using test::TermsOf;

class ContactProblemOf : public testing::TestWithParam<const char*> {
 protected:
  model::RobotModel robot = test::load(GetParam());
};
INSTANTIATE_TEST_SUITE_P(Robots, ContactProblemOf, testing::ValuesIn(test::kRobots), test::robot_name);

template <int kUnknowns>
void expect_jacobian_matches_automatic(const ContactTerms& terms, const std::array<double, kMaxUnknowns>& at) {
  using Problem = ContactProblem<kUnknowns>;
  using Jet = ceres::Jet<double, kUnknowns>;
  const Problem problem{terms};
  Eigen::Matrix<double, Problem::NUM_RESIDUALS, 1> r;
  Eigen::Matrix<double, Problem::NUM_RESIDUALS, kUnknowns> J;
  ASSERT_TRUE(problem(at.data(), r.data(), J.data()));
  std::array<Jet, kUnknowns> x;
  for (int i = 0; i < kUnknowns; ++i) x[static_cast<std::size_t>(i)] = Jet(at[static_cast<std::size_t>(i)], i);
  std::array<Jet, Problem::NUM_RESIDUALS> automatic;
  problem.residuals(x.data(), automatic.data());
  for (int row = 0; row < Problem::NUM_RESIDUALS; ++row) {
    const Jet& expected = automatic[static_cast<std::size_t>(row)];
    EXPECT_NEAR(r[row], expected.a, 1e-12) << row;
    // Both derivatives are exact: rounding only.
    for (int i = 0; i < kUnknowns; ++i) {
      EXPECT_NEAR(J(row, i), expected.v[i], 1e-9 * (1.0 + std::abs(expected.v[i])))
          << "row " << row << ", unknown " << i;
    }
  }
}

TEST_P(ContactProblemOf, JacobianIsTheAutomaticOne) {
  constexpr unsigned kSeed = 11;
  SCOPED_TRACE(kSeed);
  RandomReferences references(robot, kSeed);
  TermsOf terms_of(robot);
  for (int i = 0; i < 200; ++i) {
    Reference reference = references.next();
    test::set_contact(reference, references.uniform(0.0, 1.0), references.uniform(0.0, 1.0));
    const ContactTerms terms = terms_of.with_attitude(reference, 0.1);
    std::array<double, kMaxUnknowns> x = terms.prior;
    for (double& value : x) value += references.uniform(-0.3, 0.3);
    expect_jacobian_matches_automatic<5>(terms, x);
    expect_jacobian_matches_automatic<7>(terms, x);
  }
}

TEST_P(ContactProblemOf, FootMotionIsTheDerivativeOfWhereTheSolePointIs) {
  // Follows a material point of the sole half a step back and forth, while the base moves rigidly by (v, omega').
  constexpr unsigned kSeed = 12;
  SCOPED_TRACE(kSeed);
  constexpr double kStep_s = 1e-5;
  RandomReferences references(robot, kSeed);
  TermsOf terms_of(robot);
  model::BaseAttitude base_attitude(robot);
  model::LegKinematics legs(robot);
  for (int i = 0; i < 50; ++i) {
    const Reference reference = references.next();
    const Command& u = reference.command;
    const ContactTerms terms = terms_of(reference);
    const Eigen::Matrix3d R_HB = base_attitude
                                     .compute(reference.q, reference.dq, u[kPitch], u[kRoll],
                                              reference.command_rate[kPitch], reference.command_rate[kRoll])
                                     .R_HB;
    std::array<double, kMaxUnknowns> x = terms.prior;
    for (double& value : x) value += references.uniform(-0.3, 0.3);
    const Eigen::Vector3d v(x[kXVx], x[kXVy], x[kXVz]);
    const Eigen::Vector3d omega = terms.omega_HB_H + x[kXOmega] * Eigen::Vector3d::UnitZ();
    for (const Foot foot : {kLeft, kRight}) {
      const model::FootKinematics now = legs.compute(reference.q, reference.dq)[foot];
      const Eigen::Vector3d p_FC = now.R_BF.transpose() * (R_HB.transpose() * terms.foot[foot].lever_H - now.p_BF);
      const auto pose_at = [&](double t) {
        const model::FootKinematics then = legs.compute(reference.q + t * reference.dq, reference.dq)[foot];
        const Eigen::Matrix3d R = Eigen::AngleAxisd(omega.norm() * t, omega.normalized()).toRotationMatrix() * R_HB;
        return std::pair<Eigen::Vector3d, Eigen::Matrix3d>(v * t + R * (then.p_BF + then.R_BF * p_FC), R * then.R_BF);
      };
      const auto [p_before, R_before] = pose_at(-kStep_s);
      const auto [p_after, R_after] = pose_at(kStep_s);
      const ContactProblem<5> problem{terms};
      const FootMotion<double> motion = problem.foot_motion(foot, x.data());
      // Central differences: truncation 1e-10 times third derivatives, rounding 1e-16 / 1e-5.
      EXPECT_LT(((p_after - p_before) / (2.0 * kStep_s) - motion.velocity_H).norm(), 1e-7);
      const Eigen::Matrix3d spin = (R_after - R_before) / (2.0 * kStep_s) * (R_HB * now.R_BF).transpose();
      EXPECT_NEAR(spin(1, 0), motion.yaw_rate, 1e-7);
    }
  }
}

TEST_P(ContactProblemOf, AttitudeChangeIsThatOfTheTorso) {
  // Levers for changed pitch' and roll' equal those of a command with that pitch and roll, except for the base's
  // heading: the heading frame stays the command's. Heights don't depend on it.
  constexpr unsigned kSeed = 13;
  SCOPED_TRACE(kSeed);
  RandomReferences references(robot, kSeed);
  TermsOf terms_of(robot);
  model::BaseAttitude base_attitude(robot);
  for (int i = 0; i < 50; ++i) {
    const Reference reference = references.next();
    const ContactTerms terms = terms_of.with_attitude(reference, 0.1);
    std::array<double, kMaxUnknowns> x = terms.prior;
    x[kXPitch] += references.uniform(-0.2, 0.2);
    x[kXRoll] += references.uniform(-0.2, 0.2);
    const JointVector still = JointVector::Zero(reference.q.size());
    const auto attitude = [&](double pitch, double roll) {
      return base_attitude.compute(reference.q, still, pitch, roll, 0.0, 0.0).R_HB;
    };
    const Eigen::Matrix3d changed =
        attitude(x[kXPitch], x[kXRoll]) * attitude(reference.command[kPitch], reference.command[kRoll]).transpose();
    const ContactProblem<7> problem{terms};
    for (const Foot foot : {kLeft, kRight}) {
      const Eigen::Vector3d expected = changed * terms.foot[foot].lever_H;
      const Eigen::Vector3d lever = problem.foot_motion(foot, x.data()).lever_H;
      EXPECT_NEAR(lever.z(), expected.z(), 1e-9);
      EXPECT_NEAR(lever.head<2>().norm(), expected.head<2>().norm(), 1e-9);
    }
  }
}

/// Two feet under the base's origin disagree: the left one moves at 0.4 m/s and turns at 0.2 rad/s with the weight
/// 0.25, the right one at -0.2 m/s and 0.1 rad/s with the weight 1. The prior wants 0.6 m/s and -0.5 rad/s with the
/// weight 0.5 on its residual. By hand, each unknown is the mean of its three wishes with the weights 0.25, 1 and
/// 0.5^2:
///   v' = (0.25 (-0.4) + 1 (0.2) + 0.25 (0.6)) / 1.5, omega' = (0.25 (-0.2) + 1 (-0.1) + 0.25 (-0.5)) / 1.5,
///   h' = (1 (0.02) + 0.25 (-0.06)) / 1.25 for a lowest sole point 0.02 m further down than at stand.
TEST(ContactProblem, WeighsFeetHeightAndPriorAsWorkedOutByHand) {
  ContactTerms terms;
  terms.standing_height_m = 0.8;
  terms.foot[kLeft].velocity_H = {0.4, 0.0, 0.0};
  terms.foot[kLeft].omega_H = {0.0, 0.0, 0.2};
  terms.foot[kRight].velocity_H = {-0.2, 0.0, 0.0};
  terms.foot[kRight].omega_H = {0.0, 0.0, 0.1};
  for (const Foot foot : {kLeft, kRight}) terms.foot[foot].lever_H = {0.0, 0.0, -0.82};
  terms.foot[kLeft].weight = 0.25;
  terms.foot[kRight].weight = 1.0;
  for (const Foot foot : {kLeft, kRight}) terms.foot[foot].sqrt_weight = std::sqrt(terms.foot[foot].weight);
  terms.height_share = {0.0, 1.0};
  terms.sqrt_height_weight = 1.0;
  terms.prior = {0.6, 0.0, 0.0, -0.5, -0.06, 0.0, 0.0};
  terms.prior_weight.fill(0.5);

  using Problem = ContactProblem<5>;
  Eigen::Matrix<double, Problem::NUM_RESIDUALS, 1> r;
  Eigen::Matrix<double, Problem::NUM_RESIDUALS, 5> J;
  const Eigen::Matrix<double, 5, 1> zero = Eigen::Matrix<double, 5, 1>::Zero();
  Problem{terms}(zero.data(), r.data(), J.data());  // linear in the unknowns: one step is the solution
  const Eigen::Matrix<double, 5, 1> x = -(J.transpose() * J).ldlt().solve(J.transpose() * r);
  EXPECT_NEAR(x[kXVx], (0.25 * -0.4 + 0.2 + 0.25 * 0.6) / 1.5, 1e-12);
  EXPECT_NEAR(x[kXOmega], (0.25 * -0.2 - 0.1 + 0.25 * -0.5) / 1.5, 1e-12);
  EXPECT_NEAR(x[kXHeight], (0.02 + 0.25 * -0.06) / 1.25, 1e-12);
  EXPECT_NEAR(x[kXVy], 0.0, 1e-12);
  EXPECT_NEAR(x[kXVz], 0.0, 1e-12);
}

TEST_P(ContactProblemOf, TakesTheReferencesContactWeightsAndTheGivenPrior) {
  RandomReferences references(robot, 12);
  TermsOf terms_of(robot);
  Reference reference = references.next();
  test::set_contact(reference, 0.25, 0.81);
  const ContactTerms terms = terms_of(reference, 0.3);
  EXPECT_NEAR(terms.foot[kLeft].sqrt_weight, 0.5, 1e-12);
  EXPECT_NEAR(terms.foot[kRight].sqrt_weight, 0.9, 1e-12);
  EXPECT_NEAR(terms.sqrt_height_weight, 1.0, 1e-12) << "min(1, 0.25 + 0.81)";
  EXPECT_NEAR(terms.sqrt_level_weight, 0.45, 1e-12) << "sqrt(0.25 * 0.81)";
  for (const double weight : terms.prior_weight) EXPECT_NEAR(weight, 0.3, 1e-12);
}

}  // namespace
}  // namespace pmg::gco
