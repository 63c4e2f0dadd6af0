// The promises of the ground-aware command on several robots.
#include "gco/ground_aware_command.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "gco/contact_problem.hpp"
#include "generator_core/allocation_count.hpp"
#include "robot_states.hpp"

namespace pmg::gco {
namespace {

using test::RandomReferences;
using test::standing;
using test::TermsOf;
using test::unknowns_of;

class GroundAwareCommandOf : public testing::TestWithParam<const char*> {
 protected:
  model::RobotModel robot = test::load(GetParam());

  /// Adds to the pitch joints of a leg, from the hip down: rotations about +y of the standing robot, whatever the
  /// joint's own axis is.
  void add_to_pitch_joints(JointVector& values, Foot foot, const std::array<double, 3>& added) const {
    model::LegKinematics legs(robot);
    const JointVector stand = robot.q_stand();
    const auto& J = legs.compute(stand, JointVector::Zero(stand.size()))[foot].J;
    std::size_t next = 0;
    for (std::size_t i = 0; i < robot.leg_joints[foot].size() && next < added.size(); ++i) {
      const double about_y = J(4, static_cast<Eigen::Index>(i));
      if (std::abs(about_y) > 0.99) values[robot.leg_joints[foot][i]] += about_y * added[next++];
    }
    ASSERT_EQ(next, added.size());
  }
};
INSTANTIATE_TEST_SUITE_P(Robots, GroundAwareCommandOf, testing::ValuesIn(test::kRobots), test::robot_name);

TEST_P(GroundAwareCommandOf, SingleSupportStandsStillOnTheGround) {
  constexpr unsigned kSeed = 21;
  SCOPED_TRACE(kSeed);
  RandomReferences references(robot, kSeed);
  GroundAwareCommand gco(robot);
  double before_max = 0.0;
  for (int i = 0; i < 500; ++i) {
    Reference reference = references.next();
    const Foot stance = i % 2 == 0 ? kLeft : kRight;
    test::set_contact(reference, stance == kLeft ? 1.0 : 0.0, stance == kRight ? 1.0 : 0.0);
    const Result& result = gco.solve(reference);
    ASSERT_EQ(result.status, Status::kConverged);
    before_max = std::max(before_max, result.foot[stance].before_m_s);
    // The prior pulls with weight 1e-6 in the cost against 1 m/s. The guarantee is 1e-3 m/s and 1 mm.
    EXPECT_LT(result.foot[stance].after_m_s, 1e-5);
    EXPECT_LT(result.foot[stance].yaw_rate_after_rad_s, 1e-5);
    EXPECT_LT(std::abs(result.foot[stance].height_m), 2e-4);  // softmin of the corners: at most 0.17 mm
    EXPECT_EQ(result.foot[1 - stance].after_m_s, 0.0);
    EXPECT_EQ(result.command[kPitch], reference.command[kPitch]);
    EXPECT_EQ(result.command[kRoll], reference.command[kRoll]);
    EXPECT_DOUBLE_EQ(result.height_deficit_m, reference.command[kHeight] - result.command[kHeight]);
  }
  EXPECT_GT(before_max, 0.5);  // there was slip to repair
}

TEST_P(GroundAwareCommandOf, PriorBiasGrowsWithTheSquareOfItsWeightAndIsBounded) {
  constexpr unsigned kSeed = 22;
  SCOPED_TRACE(kSeed);
  RandomReferences references(robot, kSeed);
  GroundAwareCommand exact(robot, {.prior_weight = 1e-6});
  for (const double weight : {1e-3, 1e-2}) {
    GroundAwareCommand pulled(robot, {.prior_weight = weight});
    double bias_max = 0.0;
    for (int i = 0; i < 100; ++i) {
      Reference reference = references.next();
      test::set_contact(reference, 0.0, 1.0);
      exact.reset();
      pulled.reset();
      const auto x = unknowns_of(exact.solve(reference));
      const auto y = unknowns_of(pulled.solve(reference));
      const Command& u = reference.command;
      const std::array<double, 5> target = {u[kVx], u[kVy], 0.0, u[kOmega], u[kHeight]};
      double distance = 0.0, bias = 0.0;
      for (std::size_t k = 0; k < target.size(); ++k) {
        distance = std::hypot(distance, x[k] - target[k]);
        bias = std::hypot(bias, x[k] - y[k]);
      }
      // (J'J + w^2)^-1 w^2 (u - x): J'J's smallest eigenvalue is above 1/4 for a lever below 1.5 m.
      EXPECT_LT(bias, 4.0 * weight * weight * distance + 1e-10);
      bias_max = std::max(bias_max, bias / distance);
    }
    EXPECT_GT(bias_max, 0.3 * weight * weight);
  }
}

TEST_P(GroundAwareCommandOf, DoubleSupportIsTheLeastSquaresOptimum) {
  constexpr unsigned kSeed = 23;
  SCOPED_TRACE(kSeed);
  RandomReferences references(robot, kSeed);
  TermsOf terms_of(robot);
  GroundAwareCommand gco(robot);
  for (int i = 0; i < 200; ++i) {
    Reference reference = references.next();
    test::set_contact(reference, references.uniform(0.5, 1.0), references.uniform(0.5, 1.0));
    gco.reset();
    const auto best = unknowns_of(gco.solve(reference));
    const ContactTerms terms = terms_of(reference);
    const double lowest = test::cost<5>(terms, best);
    for (int k = 0; k < 20; ++k) {
      auto x = best;
      // An offset of 1e-4 raises the cost by about 1e-8 / 2 times J'J, far above the rounding of costs of order 1.
      for (std::size_t n = 0; n < 5; ++n) x[n] += references.uniform(-1e-4, 1e-4);
      EXPECT_GT(test::cost<5>(terms, x), lowest);
    }
  }
}

TEST_P(GroundAwareCommandOf, FeetThatDisagreeSymmetricallyShareTheSlip) {
  Reference reference = standing(robot);
  add_to_pitch_joints(reference.dq, kLeft, {0.5, 0.0, -0.5});
  add_to_pitch_joints(reference.dq, kRight, {-0.5, 0.0, 0.5});
  GroundAwareCommand gco(robot);
  const Result& result = gco.solve(reference);
  EXPECT_GT(result.foot[kLeft].after_m_s, 0.05);
  EXPECT_NEAR(result.foot[kLeft].after_m_s, result.foot[kRight].after_m_s, 1e-9);
  EXPECT_NEAR(result.command[kVx], 0.0, 1e-9);
  // The base turns about its own origin; soles a few centimetres ahead of it need some vy.
  EXPECT_LT(std::abs(result.command[kVy]), 0.1 * std::abs(result.command[kOmega]));
  // Together they never slip more than with the user's command, whose cost is higher.
  EXPECT_LT(std::hypot(result.foot[kLeft].after_m_s, result.foot[kRight].after_m_s),
            std::hypot(result.foot[kLeft].before_m_s, result.foot[kRight].before_m_s));
}

TEST_P(GroundAwareCommandOf, StandingStillHasNoVelocityAndTheHeightOfItsLegs) {
  model::LegKinematics legs(robot);
  GroundAwareCommand gco(robot);
  for (const double bend : {0.0, 0.1, 0.3, 0.5}) {
    Reference reference = standing(robot);
    for (const Foot foot : {kLeft, kRight}) add_to_pitch_joints(reference.q, foot, {-bend / 2, bend, -bend / 2});
    reference.command[kHeight] = -0.10;
    const Result& result = gco.solve(reference);
    // Feet stay level (the sum of the pitch joints is unchanged), so any corner gives the sole's height.
    const double expected = -legs.compute(reference.q, reference.dq)[kLeft].sole_B[0].z() - robot.standing_height_m;
    // The prior of weight 1e-6 pulls towards -0.10 m.
    EXPECT_NEAR(result.command[kHeight], expected, 1e-6);
    EXPECT_NEAR(result.height_deficit_m, -0.10 - expected, 1e-6);
    EXPECT_EQ(result.command[kVx], 0.0);
    EXPECT_EQ(result.command[kVy], 0.0);
    EXPECT_EQ(result.command[kOmega], 0.0);
    EXPECT_EQ(result.vz_m_s, 0.0);
    for (const Foot foot : {kLeft, kRight}) EXPECT_EQ(result.foot[foot].after_m_s, 0.0);
    if (bend == 0.0) {
      EXPECT_NEAR(expected, 0.0, 1e-3);  // the definition of the robot's standing height
    }
  }
}

TEST_P(GroundAwareCommandOf, SquattingLowersTheBaseAsFastAsItsHeightFalls) {
  GroundAwareCommand gco(robot);
  constexpr double kStep_s = 1e-4;
  const auto at = [&](double bend) {
    Reference reference = standing(robot);
    for (const Foot foot : {kLeft, kRight}) {
      add_to_pitch_joints(reference.q, foot, {-bend / 2, bend, -bend / 2});
      add_to_pitch_joints(reference.dq, foot, {-0.5, 1.0, -0.5});
    }
    return reference;
  };
  const double before = gco.solve(at(0.3 - kStep_s)).command[kHeight];
  const double after = gco.solve(at(0.3 + kStep_s)).command[kHeight];
  const Result& result = gco.solve(at(0.3));
  EXPECT_LT(result.vz_m_s, -0.01);
  EXPECT_NEAR(result.vz_m_s, (after - before) / (2.0 * kStep_s), 1e-5);  // prior 1e-6, differences 1e-8
}

TEST_P(GroundAwareCommandOf, LowerFootStandsOnTheGroundNeverTheAverage) {
  constexpr unsigned kSeed = 24;
  SCOPED_TRACE(kSeed);
  RandomReferences references(robot, kSeed);
  GroundAwareCommand gco(robot);
  double apart_max = 0.0;
  for (int i = 0; i < 500; ++i) {
    Reference reference = references.next();
    test::set_contact(reference, references.uniform(0.5, 1.0), references.uniform(0.5, 1.0));
    const Result& result = gco.solve(reference);
    const double left = result.foot[kLeft].height_m, right = result.foot[kRight].height_m;
    EXPECT_LT(std::abs(std::min(left, right)), 1e-3);
    apart_max = std::max(apart_max, std::abs(left - right));
  }
  EXPECT_GT(apart_max, 0.05);
}

double distance(const Result& a, const Result& b) {
  const auto x = unknowns_of(a), y = unknowns_of(b);
  double largest = 0.0;
  for (std::size_t i = 0; i < 5; ++i) largest = std::max(largest, std::abs(x[i] - y[i]));
  return largest;
}

TEST_P(GroundAwareCommandOf, CommandIsContinuousAsContactWeightsFade) {
  // Postures and velocities with a large disagreement are frozen while the weights run along their cosine edges: from
  // both feet to the right one, into the air, and down on the left.
  constexpr unsigned kSeed = 25;
  SCOPED_TRACE(kSeed);
  constexpr int kSteps = 2000;
  RandomReferences references(robot, kSeed);
  const auto cosine = [](double t) { return 0.5 - 0.5 * std::cos(std::numbers::pi * t); };
  for (int i = 0; i < 10; ++i) {
    Reference reference = references.next();
    GroundAwareCommand gco(robot);
    for (const int phase : {0, 1, 2}) {
      double range = 0.0, jump = 0.0;
      Result first, last;
      for (int k = 0; k <= kSteps; ++k) {
        const double rising = cosine(static_cast<double>(k) / kSteps);
        if (phase == 0) test::set_contact(reference, 1.0 - rising, 1.0);
        if (phase == 1) test::set_contact(reference, 0.0, 1.0 - rising);
        if (phase == 2) test::set_contact(reference, rising, 0.0);
        const Result& result = gco.solve(reference);
        ASSERT_NE(result.status, Status::kNotConverged);
        if (k == 0) first = result;
        // At the end of a foot's contact the height jumps to the other foot, because the lower of two loaded feet
        // carries it.
        if (phase == 0 && k == kSteps) break;
        if (k > 0) jump = std::max(jump, distance(result, last));
        range = std::max(range, distance(result, first));
        last = result;
      }
      // One step along the edge may move u' by a few times the mean slope; a switch would move it by the whole range.
      EXPECT_GT(range, 0.01);
      EXPECT_LT(jump, 30.0 * range / kSteps) << "phase " << phase;
    }
  }
}

TEST_P(GroundAwareCommandOf, WithoutContactTheCommandIsKeptAndTheHeightHeld) {
  Reference reference = standing(robot);
  for (const Foot foot : {kLeft, kRight}) add_to_pitch_joints(reference.q, foot, {-0.2, 0.4, -0.2});
  GroundAwareCommand gco(robot);
  const double grounded = gco.solve(reference).command[kHeight];
  EXPECT_LT(grounded, -0.01);
  test::set_contact(reference, 0.0, 0.0);
  reference.command[kVx] = 0.3;
  for (int i = 0; i < 20; ++i) {
    const Result& result = gco.solve(reference);
    EXPECT_EQ(result.status, Status::kNoContact);
    EXPECT_EQ(result.command[kVx], 0.3);
    EXPECT_EQ(result.vz_m_s, 0.0);
    EXPECT_NEAR(result.command[kHeight], grounded, 1e-5);  // the prior's 1e-6 per tick
    EXPECT_EQ(result.foot[kLeft].after_m_s, 0.0);
  }
  gco.reset();
  EXPECT_NEAR(gco.solve(reference).command[kHeight], 0.0, 1e-12);  // nothing is held: the command's height
}

TEST_P(GroundAwareCommandOf, NonsenseInKeepsTheLastGoodResult) {
  GroundAwareCommand gco(robot);
  Reference reference = standing(robot);
  reference.command[kVx] = 0.2;
  add_to_pitch_joints(reference.dq, kLeft, {0.3, 0.0, 0.0});
  const Result good = gco.solve(reference);
  ASSERT_EQ(good.status, Status::kConverged);
  const auto expect_kept = [&](const Reference& bad) {
    const Result& result = gco.solve(bad);
    EXPECT_EQ(result.status, Status::kNotConverged);
    EXPECT_EQ(result.command, good.command);
    EXPECT_EQ(result.foot[kLeft].after_m_s, good.foot[kLeft].after_m_s);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double value : {nan, std::numeric_limits<double>::infinity(), 1e300}) {
    Reference bad = reference;
    bad.dq[robot.leg_joints[kRight][0]] = value;
    expect_kept(bad);
    bad = reference;
    bad.command[kVy] = value;
    if (value != 1e300) expect_kept(bad);
  }
  Reference bad = reference;
  bad.q[robot.leg_joints[kLeft][1]] = nan;
  expect_kept(bad);
  bad = reference;
  bad.contact_weight[kLeft] = nan;
  expect_kept(bad);
  bad = reference;
  bad.command[kPitch] = nan;
  expect_kept(bad);
  bad = reference;
  bad.q.conservativeResize(bad.q.size() - 1);
  expect_kept(bad);
  EXPECT_EQ(gco.solve(reference).status, Status::kConverged);
}

TEST_P(GroundAwareCommandOf, RollAndPitchTakePartOnlyOnRequest) {
  constexpr unsigned kSeed = 26;
  SCOPED_TRACE(kSeed);
  RandomReferences references(robot, kSeed);
  TermsOf terms_of(robot);
  GroundAwareCommand five(robot);
  GroundAwareCommand seven(robot, {.optimise_roll_pitch = true});
  int converged = 0;
  for (int i = 0; i < 200; ++i) {
    const Reference reference = test::mild(references.next(), robot);
    five.reset();
    seven.reset();
    const Result& fixed = five.solve(reference);
    const Result& free = seven.solve(reference);
    if (free.status != Status::kConverged) continue;
    ++converged;
    EXPECT_EQ(fixed.command[kPitch], reference.command[kPitch]);
    EXPECT_EQ(fixed.command[kRoll], reference.command[kRoll]);
    EXPECT_NE(free.command[kPitch], reference.command[kPitch]);
    const ContactTerms terms = terms_of.with_attitude(reference, Options{}.attitude_prior_weight);
    EXPECT_LT(test::cost<7>(terms, unknowns_of(free)), test::cost<7>(terms, unknowns_of(fixed)));
  }
  // The nonlinear option may fail where the feet disagree most, and reports it.
  EXPECT_GE(converged, 190);
}

TEST_P(GroundAwareCommandOf, RollLevelsFeetOfDifferentHeight) {
  Reference reference = standing(robot);
  add_to_pitch_joints(reference.q, kLeft, {-0.1, 0.2, -0.1});
  GroundAwareCommand five(robot), seven(robot, {.optimise_roll_pitch = true});
  const auto apart = [](const Result& result) {
    return std::abs(result.foot[kLeft].height_m - result.foot[kRight].height_m);
  };
  const double before = apart(five.solve(reference));
  const Result& result = seven.solve(reference);
  EXPECT_GT(before, 3e-3);
  EXPECT_LT(apart(result), 0.9 * before);  // for a stride of w, the prior leaves 0.3^2 / (w^2 + 0.3^2), 0.7 for 0.19 m
  EXPECT_LT(result.command[kRoll], 0.0) << "a roll to the left lowers the bent left leg";
}

TEST_P(GroundAwareCommandOf, SolveTakesNothingFromTheHeap) {
  RandomReferences references(robot, 27);
  GroundAwareCommand five(robot), seven(robot, {.optimise_roll_pitch = true});
  for (int i = 0; i < 50; ++i) {
    Reference reference = references.next();
    test::set_contact(reference, i % 3 == 0 ? 0.0 : 1.0, i % 5 == 0 ? 0.0 : 0.7);
    const long before = test::allocation_count();
    five.solve(reference);
    seven.solve(reference);
    ASSERT_EQ(test::allocation_count(), before);
  }
  const long before = test::allocation_count();
  GroundAwareCommand another(robot);
  if (before >= 0) {
    EXPECT_GT(test::allocation_count(), before);  // the counter works
  }
}

TEST_P(GroundAwareCommandOf, SlipBeforeIsThatOfTheCommand) {
  // A command that already fits needs no repair: the optimised command, fed back, slips as little as before.
  constexpr unsigned kSeed = 28;
  SCOPED_TRACE(kSeed);
  RandomReferences references(robot, kSeed);
  GroundAwareCommand gco(robot);
  for (int i = 0; i < 100; ++i) {
    Reference reference = references.next();
    test::set_contact(reference, 1.0, 0.0);
    const Result first = gco.solve(reference);
    reference.command = first.command;
    const Result& second = gco.solve(reference);
    EXPECT_GT(first.foot[kLeft].before_m_s, 1e-3);
    EXPECT_NEAR(second.foot[kLeft].before_m_s, first.foot[kLeft].after_m_s, 1e-12);
    EXPECT_LT(second.foot[kLeft].after_m_s, 1e-8);
  }
}

TEST_P(GroundAwareCommandOf, RefusesPriorsThatAreNotPositive) {
  EXPECT_THROW(GroundAwareCommand(robot, {.prior_weight = 0.0}), std::invalid_argument);
  EXPECT_THROW(GroundAwareCommand(robot, {.attitude_prior_weight = -1.0}), std::invalid_argument);
}

}  // namespace
}  // namespace pmg::gco
