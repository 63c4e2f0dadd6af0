// The promises of imitated arms: like the person's, and clear of the robot's legs.
#include "retargeting/arm_imitation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "generator/gait_task.hpp"
#include "model/leg_kinematics.hpp"
#include "pmg/half_gain.hpp"
#include "retargeting/arm_points.hpp"
#include "retargeting/link_capsules.hpp"

namespace pmg::retargeting {
namespace {

struct RobotWithArms {
  model::RobotModel robot = model::load_robot(model::find_robot("z1"));
  generator::JointRoles roles = generator::find_joint_roles(robot);
};
const RobotWithArms& with_arms() {
  static const RobotWithArms it;
  return it;
}

/// Standing legs; arms that swing by this angle forward and back, elbows bent, `inward` to the middle.
HumanCycle swinging_arms(double swing_rad, double inward_rad) {
  HumanCycle human;
  for (std::size_t k = 0; k < generator::kClipSamples; ++k) {
    const double phase = 2.0 * M_PI * static_cast<double>(k) / static_cast<double>(generator::kClipSamples);
    HumanPose pose;
    pose.arms_known = true;
    for (std::size_t side = 0; side < 2; ++side) {
      const double outward = side == 0 ? 1.0 : -1.0, pitch = outward * swing_rad * std::sin(phase);
      const auto down = [&](double forward_rad) {
        return Eigen::Vector3d(std::sin(forward_rad), -outward * std::tan(inward_rad), -std::cos(forward_rad))
            .normalized();
      };
      pose.side[side].upper_arm = down(pitch);
      pose.side[side].forearm = down(pitch + 0.4);
    }
    human.pose.push_back(pose);
  }
  return human;
}

DynamicClip standing_clip() {
  DynamicClip clip;
  clip.period_s = 1.0;
  clip.q.assign(generator::kClipSamples, with_arms().robot.q_stand());
  clip.dq_dphi.assign(generator::kClipSamples, JointVector::Zero(with_arms().robot.q_stand().size()));
  return clip;
}

TEST(ImitatedArms, PutTheHandsWhereThePersonsAre) {
  const HumanCycle human = swinging_arms(0.5, -0.15);
  DynamicClip clip = standing_clip();
  imitate_arms(with_arms().robot, with_arms().roles, human, 0.07, clip);
  model::BaseAttitude attitude(with_arms().robot);
  for (const Foot side : {kLeft, kRight}) {
    ArmChain arm = *ArmChain::of(with_arms().robot, with_arms().roles, side);
    for (std::size_t k = 0; k < clip.q.size(); ++k) {
      const Eigen::Matrix3d R_HB =
          attitude.compute(clip.q[k], JointVector::Zero(clip.q[k].size()), 0.0, 0.0, 0.0, 0.0).R_HB;
      const ArmPoints at = arm.compute(clip.q[k]);
      const SidePose& pose = human.pose[k].side[side];
      const Eigen::Vector3d wanted =
          (at.elbow - at.shoulder).norm() * pose.upper_arm + (at.wrist - at.elbow).norm() * pose.forearm;
      EXPECT_LE((R_HB * (at.wrist - at.shoulder) - wanted).norm(), 0.01) << k;
    }
  }
  // Ends that meet: the last step is no larger than those within the cycle.
  const auto& q = clip.q;
  double within = 0.0;
  for (std::size_t k = 1; k < q.size(); ++k) within = std::max(within, (q[k] - q[k - 1]).cwiseAbs().maxCoeff());
  EXPECT_LE((q.front() - q.back()).cwiseAbs().maxCoeff(), 1.1 * within);
}

/// A person's hand passes where the robot, with its other proportions, has its thigh.
TEST(ImitatedArms, KeepClearOfTheLegsWhereThePersonsWouldEnterThem) {
  const HumanCycle human = swinging_arms(0.2, 0.25);
  DynamicClip clip = standing_clip();
  imitate_arms(with_arms().robot, with_arms().roles, human, 0.07, clip);
  EXPECT_GE(arm_clearance_m(with_arms().robot, with_arms().roles, clip), 0.5 * kArmClearance_m);
  for (const double gain : {0.25, 0.5, 0.75}) {
    EXPECT_GE(arm_clearance_m(with_arms().robot, with_arms().roles, at_gain(clip, with_arms().robot.q_stand(), gain)),
              0.0)
        << gain;
  }
  for (const JointVector& q : clip.q) {
    for (std::size_t j = 0; j < with_arms().robot.joints.size(); ++j) {
      EXPECT_GE(q[static_cast<Eigen::Index>(j)], with_arms().robot.joints[j].lower_rad);
      EXPECT_LE(q[static_cast<Eigen::Index>(j)], with_arms().robot.joints[j].upper_rad);
    }
  }
}

TEST(ImitatedArms, StayWhereARecordingHasNone) {
  HumanCycle human = swinging_arms(0.5, 0.0);
  for (HumanPose& pose : human.pose) pose.arms_known = false;
  DynamicClip clip = standing_clip();
  const std::vector<JointVector> before = clip.q;
  imitate_arms(with_arms().robot, with_arms().roles, human, 0.07, clip);
  EXPECT_EQ(clip.q, before);
}

/// Against the nearest of many points on both lines.
TEST(Capsules, AreAsFarApartAsTheirNearestPoints) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-0.5, 0.5);
  const auto point = [&] { return Eigen::Vector3d(any(random), any(random), any(random)); };
  for (int i = 0; i < 200; ++i) {
    Capsule one{point(), point(), 0.03}, other{point(), point(), 0.04};
    if (i % 5 == 0) one.b = one.a;  // spheres
    if (i % 7 == 0) other.b = other.a;
    if (i % 11 == 0) other.b = other.a + 0.7 * (one.b - one.a);  // parallel
    double nearest = 1e9;
    constexpr int kSteps = 400;
    for (int s = 0; s <= kSteps; ++s) {
      const Eigen::Vector3d on_one = one.a + (one.b - one.a) * s / kSteps;
      const Eigen::Vector3d d = other.b - other.a;
      const double length2 = d.squaredNorm();
      const double t = length2 > 0.0 ? std::clamp((on_one - other.a).dot(d) / length2, 0.0, 1.0) : 0.0;
      nearest = std::min(nearest, (on_one - other.a - t * d).norm());
    }
    // A step of the search is 1 / 400 of a line of at most 1.8 m: 5 mm along it, less across.
    EXPECT_NEAR(distance_m(one, other), nearest - 0.07, 0.003) << i;
    EXPECT_LE(distance_m(one, other), nearest - 0.07 + 1e-12) << i;
  }
}

/// The simulation's capsule of Z1's thigh: 0.054 m thick, its axis 0.126 m long, 0.207 m below the hip.
TEST(Capsules, OfALinkAreThoseOfItsCollisionShape) {
  const std::string thigh =
      with_arms()
          .robot.urdf->getJoint(with_arms().robot.joint_index.name(with_arms().roles.leg[kLeft][generator::kHipYaw]))
          ->child_link_name;
  LinkCapsules capsules(with_arms().robot, {thigh});
  const Capsule& capsule = capsules.compute(JointVector::Zero(with_arms().robot.q_stand().size())).at(0);
  EXPECT_NEAR(capsule.radius_m, 0.054, 1e-9);
  EXPECT_NEAR((capsule.b - capsule.a).norm(), 0.233756462 - 0.108, 1e-9);
  EXPECT_NEAR(0.5 * (capsule.a.y() + capsule.b.y()), 0.095, 1e-9);
}

}  // namespace
}  // namespace pmg::retargeting
