// Equations of motion as data: what a search for causes weighs.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace pmg::robot_diagnosis {

/// What carries the robot, and with it which equations hold.
enum class Support {
  kHanging,   ///< by the torso, feet in the air: the torso's wrench is eliminated, a row for every joint
  kStanding,  ///< on both soles, at rest: their wrenches follow from the legs' torques, 6 rows for the whole robot
  kLoose,     ///< anything else: rows of arms and head only
};
inline constexpr std::size_t kSupports = 3;

/// One equation: residual + sum of coefficient * parameter is 0 but for noise. Joint rows and the last three of the
/// whole robot's in Nm, its first three in N, soles' tilt in rad, difference of the soles' heights in m.
struct RobotRow {
  int kind = 0;  ///< rows of a kind share a noise level: RobotEquations::kind_name
  Support support = Support::kLoose;
  double residual = 0.0;
  double friction_variance = 0.0;                    ///< of dry friction near standstill, whose direction isn't known
  double standstill = 0.0;                           ///< that, as a share of what it is when nothing moves
  std::vector<std::pair<int, double>> coefficients;  ///< parameter of the list, d residual / d parameter
  int own_gain = -1;       ///< which of the coefficients is that of the gain of the row's own joint,
  double spring_Nm = 0.0;  ///< of which this is the negative, by the encoder
};

/// Rows of one stretch of a recording; blocks are what folds leave out.
struct RobotBlock {
  std::string name;
  std::vector<RobotRow> rows;
};

}  // namespace pmg::robot_diagnosis
