#include "drives/rod_linkage.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>
#include <stdexcept>

#include "drives/uniform.hpp"
#include "refusal.hpp"

namespace pmg::drives {
namespace {

using test::uniform;

using Ankle = RodLinkage<2>;
using FourBar = RodLinkage<1>;
using Angles = Ankle::Angles;

Angles angles(double first, double second) { return {first, second}; }

/// An ankle as humanoids have it: two motors in the shank, 0.20 m and 0.28 m above the joint, cranks to the rear, rods
/// down to the heel's corners. Pitch about y, then roll about x.
Ankle ankle() {
  const auto motor = [](double y, double z) {
    return CrankAndRod{.crank_centre_m = {0.0, y, z},
                       .axis = {0.0, 1.0, 0.0},
                       .crank_end_m = {-0.04, y, z},
                       .rod_end_m = {-0.045, y, -0.01}};
  };
  return Ankle({Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitX()}, {motor(0.035, 0.20), motor(-0.035, 0.28)});
}

FourBar four_bar() {
  return FourBar({Eigen::Vector3d::UnitY()}, {CrankAndRod{.crank_centre_m = {0.0, 0.0, 0.3},
                                                          .axis = {0.0, 1.0, 0.0},
                                                          .crank_end_m = {0.05, 0.0, 0.3},
                                                          .rod_end_m = {0.06, 0.0, 0.0}}});
}

Angles some_posture(std::mt19937_64& random) { return angles(uniform(random, -0.6, 0.5), uniform(random, -0.3, 0.3)); }

TEST(RodLinkage, ZeroIsZero) {
  EXPECT_NEAR(ankle().motor_angles(angles(0.0, 0.0))->norm(), 0.0, 1e-12);
  EXPECT_NEAR((*four_bar().motor_angles(FourBar::Angles(0.0)))[0], 0.0, 1e-12);
}

TEST(RodLinkage, AParallelogramTurnsOneToOne) {
  const FourBar parallelogram({Eigen::Vector3d::UnitY()}, {CrankAndRod{.crank_centre_m = {0.0, 0.0, 0.3},
                                                                       .axis = {0.0, 1.0, 0.0},
                                                                       .crank_end_m = {0.05, 0.0, 0.3},
                                                                       .rod_end_m = {0.05, 0.0, 0.0}}});
  for (const double q : {-0.8, -0.2, 0.3, 0.9}) {
    const FourBar::Angles joint(q);
    const auto theta = parallelogram.motor_angles(joint);
    ASSERT_TRUE(theta);
    EXPECT_NEAR((*theta)[0], q, 1e-12);
    EXPECT_NEAR(parallelogram.jacobian(*theta, joint)(0, 0), 1.0, 1e-12);
  }
}

TEST(RodLinkage, JointToMotorAndBackIsTheSameAngle) {
  const Ankle linkage = ankle();
  std::mt19937_64 random(1);
  for (int i = 0; i < 2000; ++i) {
    const Angles q = some_posture(random),
                 guess = q + angles(uniform(random, -0.05, 0.05), uniform(random, -0.05, 0.05));
    const auto theta = linkage.motor_angles(q);
    ASSERT_TRUE(theta);
    const auto back = linkage.joint_angles(*theta, guess);
    ASSERT_TRUE(back);
    EXPECT_LT((*back - q).norm(), 1e-9) << "Newton ends within 1e-14 m^2 of levers of some 0.04 m times 0.2 m";
  }
}

TEST(RodLinkage, TheJacobianIsTheSlopeOfTheMotorAngles) {
  const Ankle linkage = ankle();
  std::mt19937_64 random(2);
  constexpr double kStep_rad = 1e-6;
  for (int i = 0; i < 500; ++i) {
    const Angles q = some_posture(random);
    const Ankle::Jacobian J = linkage.jacobian(*linkage.motor_angles(q), q);
    for (int j = 0; j < 2; ++j) {
      Angles ahead = q, behind = q;
      ahead[j] += kStep_rad;
      behind[j] -= kStep_rad;
      const Angles slope = (*linkage.motor_angles(ahead) - *linkage.motor_angles(behind)) / (2.0 * kStep_rad);
      EXPECT_LT((slope - J.col(j)).norm(), 1e-7)
          << "rounding of a central difference: 1e-16 / 1e-6, times ten for acos";
    }
  }
}

TEST(RodLinkage, MotorsGiveExactlyTheJointsTorqueAtTheMeasuredAngles) {
  const Ankle linkage = ankle();
  std::mt19937_64 random(3);
  for (int i = 0; i < 500; ++i) {
    const Angles q = some_posture(random), dq = angles(uniform(random, -3.0, 3.0), uniform(random, -3.0, 3.0));
    const Angles theta = *linkage.motor_angles(q);
    const Ankle::Jacobian J = linkage.jacobian(theta, q);
    const Angles dtheta = J * dq;
    std::array<MotorCommand, 2> joints;
    Angles wanted;
    for (int j = 0; j < 2; ++j) {
      MotorCommand& joint = joints[static_cast<std::size_t>(j)];
      joint = {.q_rad = q[j] + uniform(random, -0.1, 0.1),
               .dq_rad_s = uniform(random, -2.0, 2.0),
               .kp_Nm_per_rad = uniform(random, 0.0, 300.0),
               .kd_Nm_s_per_rad = uniform(random, 0.0, 8.0),
               .torque_Nm = uniform(random, -10.0, 10.0)};
      wanted[j] = joint.kp_Nm_per_rad * (joint.q_rad - q[j]) + joint.kd_Nm_s_per_rad * (joint.dq_rad_s - dq[j]) +
                  joint.torque_Nm;
    }
    const auto motors = linkage.to_motors(joints, q, dq, theta);
    Angles given;
    for (int m = 0; m < 2; ++m) {
      const MotorCommand& motor = motors[static_cast<std::size_t>(m)];
      EXPECT_GE(motor.kp_Nm_per_rad, 0.0);
      EXPECT_GE(motor.kd_Nm_s_per_rad, 0.0);
      given[m] = motor.kp_Nm_per_rad * (motor.q_rad - theta[m]) + motor.kd_Nm_s_per_rad * (motor.dq_rad_s - dtheta[m]) +
                 motor.torque_Nm;
    }
    EXPECT_LT((J.transpose() * given - wanted).norm(), 1e-9 * (1.0 + wanted.norm()));
    EXPECT_NEAR(given.dot(dtheta), wanted.dot(dq), 1e-9 * (1.0 + wanted.norm() * dq.norm())) << "power";
  }
}

TEST(RodLinkage, RangesWithASingularityAreRefused) {
  EXPECT_NO_THROW(ankle().check_ranges(angles(-0.6, -0.3), angles(0.5, 0.3)));
  const auto refusal = [](const auto& linkage, const auto& lower, const auto& upper) -> std::string {
    return test::refusal_by<std::invalid_argument>([&] { linkage.check_ranges(lower, upper); });
  };
  EXPECT_THAT(refusal(four_bar(), FourBar::Angles(-1.8), FourBar::Angles(0.5)),
              testing::AnyOf(testing::HasSubstr("nearly"), testing::HasSubstr("doesn't reach")));
  EXPECT_EQ(refusal(four_bar(), FourBar::Angles(-0.8), FourBar::Angles(0.8)), "taken");
  // Both rods on one line through the ankle: they turn pitch alike and roll not at all.
  const auto motor = [](double z) {
    return CrankAndRod{.crank_centre_m = {0.0, 0.0, z},
                       .axis = {0.0, 1.0, 0.0},
                       .crank_end_m = {-0.04, 0.0, z},
                       .rod_end_m = {-0.045, 0.0, 0.0}};
  };
  const Ankle flat({Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitX()}, {motor(0.2), motor(0.28)});
  EXPECT_THAT(refusal(flat, angles(-0.3, -0.1), angles(0.3, 0.1)), testing::HasSubstr("nearly singular"));
  EXPECT_THROW(FourBar({Eigen::Vector3d::UnitY()}, {CrankAndRod{}}), std::invalid_argument) << "a crank without length";
}

}  // namespace
}  // namespace pmg::drives
