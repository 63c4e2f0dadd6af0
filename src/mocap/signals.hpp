// Positions over time: finer sampling, smoothing, velocity.
#pragma once

#include <Eigen/Dense>
#include <vector>

namespace pmg::mocap {

using Positions = std::vector<Eigen::Vector3d>;

/// How many times finer samples have to be for the wanted rate: 1 to 20. More would show nothing new, and a file that
/// states 0.1 Hz would take all memory.
int finer_factor(double rate_hz, double wanted_hz);

/// factor - 1 new samples between each two, on the cubic through the four around them (Catmull-Rom). The first and the
/// last sample stay: n samples become (n - 1) factor + 1.
Positions finer(const Positions& samples, int factor);

/// Convolution with a Gaussian of this standard deviation. Beyond its ends the signal goes on as its own point
/// reflection, so that a straight line stays one.
Positions smoothed(const Positions& samples, double rate_hz, double sigma_s);
std::vector<double> smoothed(const std::vector<double>& samples, double rate_hz, double sigma_s);

/// Central differences, one-sided at the ends [1/s].
Positions velocity(const Positions& samples, double rate_hz);

/// Adds multiples of 2 pi so that no step is above pi.
void unwrap(std::vector<double>& angles_rad);

}  // namespace pmg::mocap
