// The contact point of a foot on flat ground and the foot that carries the height; smooth in q and in contact weights.
#pragma once

#include <Eigen/Core>
#include <array>

#include "pmg/types.hpp"

namespace pmg::gco {

/// The lowest point of a sole.
struct ContactPoint {
  Eigen::Vector3d p_BC = Eigen::Vector3d::Zero();  ///< [m] in the base frame B
  double height_m = 0.0;                           ///< of that point relative to the base origin, along H's z; negative
  double lowest_corner_m = 0.0;                    ///< height of the lowest corner, not smoothed; at most height_m
};

/// Softmin of the sole corners: the centre of a flat sole, the middle of an edge, or a corner, and continuous between
/// them. The point lies less than 0.2 mm above the lowest corner.
///   p = sum e_i p_i / sum e_i, e_i = exp((min z - z_i) / 0.3 mm).
/// sole_B: corners in B [m]; R_HB: attitude of the base in the heading frame H.
ContactPoint contact_point(const std::array<Eigen::Vector3d, 4>& sole_B, const Eigen::Matrix3d& R_HB) noexcept;

/// Shares of the feet in the base height; they sum to 1. With one foot in contact its share is 1. With two, the lower
/// foot carries, however small its contact weight:
///   s_left = 1 / (1 + exp((z_left - z_right) / 0.5 mm)).
/// So no reference puts a loaded foot into the ground. The cost is a step in height when the lower foot lifts off, as
/// large as the difference of the feet. height_m: of the contact points relative to the base origin. weight: contact
/// weights, 0 to 1.
PerFoot<double> height_shares(const PerFoot<double>& height_m, const PerFoot<double>& weight) noexcept;

}  // namespace pmg::gco
