// The ground's friction coefficient, from slipping soles.
#pragma once

#include <span>

#include "robot_diagnosis/robot_equations.hpp"

namespace pmg::robot_diagnosis {

struct GroundFriction {
  bool observable = false;                    ///< a sole slipped under load
  double value = 0.0, low = 0.0, high = 0.0;  ///< estimate and 95 % interval, if observable
  double at_least = 0.0;                      ///< largest tangential over normal force without slip
  int slipping_samples = 0;
};

/// (equations, samples, weight) => (friction): the ratio of tangential to normal force, from the legs' torques, while
/// the distance of the loaded feet changes.
GroundFriction ground_friction(RobotEquations& equations, std::span<const RobotSample> samples, double weight_N,
                               const GroundOptions& options = {});

}  // namespace pmg::robot_diagnosis
