// What a file leaves to guess: its unit, and which axis points up.
#pragma once

#include <Eigen/Dense>
#include <string>

#include "mocap_files/recording.hpp"

namespace pmg::mocap {

/// Hip to knee to ankle, median over frames, mean of the sides that are known, in the unit of the positions; 0 if no
/// leg is known.
double median_leg_length(const Recording& recording);

/// 0.25 to 1.2 m: from a child of two years to the tallest (leg length is about 0.49 of the height: D. Winter,
/// "Biomechanics and Motor Control of Human Movement", 4th ed., figure 4.1).
bool plausible_leg(double length_m);

struct UnitGuess {
  double unit_m = 1.0;
  std::string reason;
};

/// From the length of the legs in the unknown unit: the least surprising unit. Legs of people, children included, lie
/// around 0.85 m with a standard deviation of 0.35 in their logarithm (0.42 m at five years). Inches, feet, decimetres
/// and CMU's unit (inch / 0.45) are rare in motion files: they count as 1.5 standard deviations. So legs of 33 are an
/// adult's in inches and legs of 45 a child's in cm. The reason names every other unit within one standard deviation.
UnitGuess guess_unit(double leg_length);

/// Turns file axes into axes with z up. up: "+x" ... "-z", or empty: the axis along which neck, head and pelvis are
/// above ankles and toes in the mean. Sets recording.up. The result is a proper rotation.
Eigen::Matrix3d rotation_to_z_up(Recording& recording, const std::string& up);

}  // namespace pmg::mocap
