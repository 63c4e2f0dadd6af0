// Equations of motion as data: rows of the linear regression for a robot's parameter errors.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace pmg::robot_diagnosis {

/// The robot's support. It decides which equations hold.
enum class Support {
  kHanging,   ///< by the torso, feet in the air: the torso's wrench is eliminated, a row for every joint
  kStanding,  ///< on both soles, at rest: the legs' torques give their wrenches, 6 rows for the whole robot
  kLoose,     ///< anything else: rows of arms and head only
};
inline constexpr std::size_t kSupports = 3;

/// One equation: residual + sum of coefficient * parameter = noise. Units: joint rows and the whole robot's moments Nm,
/// its forces N, the soles' tilts rad, the difference of their heights m.
struct RobotRow {
  int kind = 0;  ///< rows of a kind share a noise level: RobotEquations::kind_name
  Support support = Support::kLoose;
  double residual = 0.0;
  double friction_variance = 0.0;                    ///< of dry friction near standstill, of unknown direction
  double standstill = 0.0;                           ///< friction_variance over its value with all joints at rest
  std::vector<std::pair<int, double>> coefficients;  ///< index into the list, d residual / d parameter
  int own_gain = -1;                                 ///< index of the coefficient of the own joint's gain; -1: none
  double spring_Nm = 0.0;                            ///< spring torque by the encoder: the negative of that coefficient
};

/// Rows of one stretch of a recording. A fold leaves out one block.
struct RobotBlock {
  std::string name;
  std::vector<RobotRow> rows;
};

}  // namespace pmg::robot_diagnosis
