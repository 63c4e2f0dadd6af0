// What an arm must keep clear of: the robot's other links, in the torso's frame.
#pragma once

#include <string>
#include <vector>

#include "arms/collision_bodies.hpp"
#include "model/chain_kinematics.hpp"
#include "model/robot_model.hpp"

namespace pmg::arms {

class Obstacles {
 public:
  /// All shapes but those of the links that an arm moves.
  Obstacles(const model::RobotModel& robot, const std::vector<LinkShape>& shapes,
            const std::vector<std::string>& arm_links);

  void compute(const JointVector& q) noexcept;  ///< all joints of the robot [rad]; no heap

  const std::vector<Shape>& shapes() const noexcept { return placed_; }  ///< in T
  const std::vector<Ball>& balls() const noexcept { return balls_; }     ///< around them, in T

 private:
  struct Carrier {
    model::ChainKinematics chain;  ///< torso -> link
    std::size_t first = 0, count = 0;
  };
  std::vector<Carrier> carriers_;
  std::vector<Shape> shapes_, placed_;  ///< in their links' frames; in T
  std::vector<Ball> balls_;
};

}  // namespace pmg::arms
