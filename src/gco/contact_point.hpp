// Where a foot touches flat ground, and which foot carries the body's height: smooth in q and in the contact weights.
#pragma once

#include <Eigen/Core>
#include <array>

#include "pmg/types.hpp"

namespace pmg::gco {

/// The lowest point of a sole.
struct ContactPoint {
  Eigen::Vector3d p_BC = Eigen::Vector3d::Zero();  ///< [m] in the base frame B
  double height_m = 0.0;                           ///< of that point above the base origin, along H's z; negative
  double lowest_corner_m = 0.0;                    ///< of the lowest corner, not smoothed; at most height_m
};

/// Sole corners weighted by the softmin of their height, scale 0.3 mm: the centre of a flat sole, the middle of an
/// edge, or a corner, continuous in between. The point lies less than 0.2 mm above the lowest corner. sole_B: corners
/// in B [m]; R_HB: attitude of the base in the heading frame H.
ContactPoint contact_point(const std::array<Eigen::Vector3d, 4>& sole_B, const Eigen::Matrix3d& R_HB) noexcept;

/// How much each foot says about the base height; sums to 1. Of two feet in contact the lower one carries (softmin,
/// scale 0.5 mm; never the average of two heights), however little its contact weight: no reference puts a loaded foot
/// into the ground, at the price of a step in height, as large as the feet disagree, when the lower one lifts off.
/// height_m: of the contact points above the base origin; weight: contact weights in [0, 1].
PerFoot<double> height_shares(const PerFoot<double>& height_m, const PerFoot<double>& weight) noexcept;

}  // namespace pmg::gco
