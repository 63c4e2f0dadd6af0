// Z1 with its arms, random postures, and an oracle for clearance that shares no code with src/arms but the shapes.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "arms/arms.hpp"
#include "arms/collision_bodies.hpp"
#include "model/link_chain.hpp"
#include "model/robots.hpp"

namespace pmg::test {

inline constexpr double kTick_s = 0.01;

inline const arms::ArmSetup& z1_arms() {
  static const arms::ArmSetup setup = *arms::read_arm_setup(z1());
  return setup;
}

/// Where a palm is for the robot's joint angles, by KDL's chain through model::ChainKinematics.
inline arms::PalmPose palm_pose(const JointVector& q, Foot side) {
  static PerFoot<model::ChainKinematics> chains{
      model::chain_between(z1(), z1().torso_link, z1_arms().palm[kLeft].link),
      model::chain_between(z1(), z1().torso_link, z1_arms().palm[kRight].link)};
  chains[side].compute(q);
  const Eigen::Isometry3d& T_LP = z1_arms().palm[side].T_LP;
  arms::PalmPose pose;
  pose.p_m = chains[side].p() + chains[side].R() * T_LP.translation();
  pose.R = Eigen::Quaterniond(Eigen::Matrix3d(chains[side].R() * T_LP.linear()));
  return pose;
}

/// Clearance of the arms by points on the axes of their links, 5 mm apart, against every other link.
class SampledClearance {
 public:
  SampledClearance() : shapes_(arms::link_shapes(z1())) {
    for (const arms::LinkShape& shape : shapes_) {
      chains_.push_back(shape.link == z1().torso_link ? model::ChainKinematics(KDL::Chain(), {})
                                                      : model::chain_between(z1(), z1().torso_link, shape.link));
    }
    const std::vector<arms::Shape> stand = place(z1().q_stand());
    for (std::size_t i = 0; i < shapes_.size(); ++i) {
      for (std::size_t k = 0; k < shapes_.size(); ++k) {
        const bool twice = of_arm(i) && of_arm(k) && k < i;
        if (!of_arm(i) || i == k || twice) continue;
        if (distance(stand[i], stand[k]) > 0.025) pairs_.emplace_back(i, k);
      }
    }
  }

  /// The least distance of all pairs that don't touch as the robot stands [m].
  double least_m(const JointVector& q) {
    const std::vector<arms::Shape> placed = place(q);
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [i, k] : pairs_) least = std::min(least, distance(placed[i], placed[k]));
    return least;
  }
  std::size_t pairs() const { return pairs_.size(); }

 private:
  bool of_arm(std::size_t i) const {
    const std::string& link = shapes_[i].link;
    return link.find("shoulder") != std::string::npos || link.find("elbow") != std::string::npos ||
           link.find("wrist") != std::string::npos;
  }
  std::vector<arms::Shape> place(const JointVector& q) {
    std::vector<arms::Shape> placed;
    for (std::size_t i = 0; i < shapes_.size(); ++i) {
      chains_[i].compute(q);
      Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
      T.linear() = chains_[i].R();
      T.translation() = chains_[i].p();
      placed.push_back(arms::moved(shapes_[i].shape, T));
    }
    return placed;
  }
  static double to_shape(const Eigen::Vector3d& p, const arms::Shape& shape) {
    if (const auto* capsule = std::get_if<arms::Capsule>(&shape)) {
      const Eigen::Vector3d d = capsule->b - capsule->a;
      const double t = d.squaredNorm() > 0.0 ? std::clamp((p - capsule->a).dot(d) / d.squaredNorm(), 0.0, 1.0) : 0.0;
      return (p - capsule->a - t * d).norm() - capsule->radius_m;
    }
    const auto& box = std::get<arms::Box>(shape);
    const Eigen::Vector3d inside = box.pose.inverse() * p;
    return (inside - inside.cwiseMax(-box.half_m).cwiseMin(box.half_m)).norm();
  }
  static double distance(const arms::Shape& arm, const arms::Shape& other) {
    const auto& capsule = std::get<arms::Capsule>(arm);
    const int points = 1 + static_cast<int>((capsule.b - capsule.a).norm() / 0.005);
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= points; ++i)
      least = std::min(least, to_shape(capsule.a + (capsule.b - capsule.a) * i / points, other));
    return least - capsule.radius_m;
  }

  std::vector<arms::LinkShape> shapes_;
  std::vector<model::ChainKinematics> chains_;
  std::vector<std::pair<std::size_t, std::size_t>> pairs_;
};

/// Standing, arms anywhere within their ranges, clear of everything by the given distance.
inline JointVector random_posture(const arms::Arms& solved, SampledClearance& clearance, std::mt19937& random,
                                  double clear_m) {
  for (;;) {
    JointVector q = z1().q_stand();
    for (const Foot side : {kLeft, kRight}) {
      const std::vector<int>& joints = solved.joints(side);
      for (std::size_t i = 0; i < joints.size(); ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        q[joints[i]] = std::uniform_real_distribution<double>(solved.solver(side).lower_rad()[k],
                                                              solved.solver(side).upper_rad()[k])(random);
      }
    }
    if (clearance.least_m(q) > clear_m) return q;
  }
}

}  // namespace pmg::test
