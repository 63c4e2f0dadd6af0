// The ground's friction, where a sole has slipped.
#pragma once

#include <span>

#include "robot_diagnosis/robot_equations.hpp"

namespace pmg::robot_diagnosis {

struct GroundFriction {
  bool observable = false;                    ///< a sole has slipped under load
  double value = 0.0, low = 0.0, high = 0.0;  ///< 95 %; if observable
  double at_least = 0.0;                      ///< the largest share of tangential in normal force that held
  int slipping_samples = 0;
};

/// Tangential over normal force of the feet, by their legs' torques, while their distance changes under load.
GroundFriction ground_friction(RobotEquations& equations, std::span<const RobotSample> samples, double weight_N,
                               const GroundOptions& options = {});

}  // namespace pmg::robot_diagnosis
